# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The header of an EXR file as a dictionary: how an image was made. Pixels are left alone.

Format: magic, version, then attributes as name, type, size, value, little-endian (OpenEXR file layout).
"""
import struct


class HeaderError(ValueError):
    pass


def decode(kind, value):
    simple = {"int": "<i", "float": "<f", "double": "<d"}
    if kind in simple:
        return struct.unpack(simple[kind], value)[0]
    if kind == "string":
        return value.decode(errors="replace")
    if kind == "box2i":
        x0, y0, x1, y1 = struct.unpack("<4i", value)
        return x1 - x0 + 1, y1 - y0 + 1
    return None


def read(path):
    """{name: value} of the attributes of type int, float, double, string and box2i (as width and height)."""
    data = path.read_bytes()
    if data[:4] != b"v/1\x01":
        raise HeaderError(f"{path}: not an EXR file")
    try:
        at, found = 8, {}
        while data[at]:
            name_end = data.index(0, at)
            kind_end = data.index(0, name_end + 1)
            size = struct.unpack_from("<i", data, kind_end + 1)[0]
            start = kind_end + 5
            if size < 0 or start + size > len(data):
                raise HeaderError(f"{path}: the header ends too early")
            value = decode(data[name_end + 1 : kind_end].decode(), data[start : start + size])
            if value is not None:
                found[data[at:name_end].decode()] = value
            at = start + size
        return found
    except (IndexError, ValueError, struct.error):
        raise HeaderError(f"{path}: the header ends too early") from None
