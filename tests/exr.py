# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Reads and writes single-part scanline OpenEXR files (no compression, ZIPS, ZIP) with numpy and zlib alone.

Written from the file format's description, so that what the renderer writes through OpenEXR's library is read by
something else. read(file) returns (header, channels): attributes by name, float32 or uint32 arrays by channel.
"""
import pathlib
import struct
import zlib

import numpy

KINDS = {0: numpy.dtype("<u4"), 1: numpy.dtype("<f2"), 2: numpy.dtype("<f4")}
LINES = {0: 1, 2: 1, 3: 16}
PLAIN = {"int": "<i", "float": "<f", "double": "<d", "v2f": "<2f", "v3f": "<3f", "box2i": "<4i",
         "chromaticities": "<8f", "compression": "<B", "lineOrder": "<B"}


def text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def channel_list(value):
    channels, at = [], 0
    while value[at]:
        name, at = text(value, at)
        kind, _, x, y = struct.unpack_from("<iIii", value, at)
        assert x == y == 1, "subsampled channels are not supported"
        channels.append((name, KINDS[kind]))
        at += 16
    return channels


def header_of(data):
    magic, version = struct.unpack_from("<II", data)
    assert magic == 20000630 and version in (2, 0x202), "no single-part EXR file"
    header, at = {}, 8
    while data[at]:
        name, at = text(data, at)
        kind, at = text(data, at)
        size, = struct.unpack_from("<i", data, at)
        value, at = data[at + 4:at + 4 + size], at + 4 + size
        if kind in PLAIN:
            value = struct.unpack(PLAIN[kind], value)
            value = value[0] if len(value) == 1 else value
        elif kind == "string":
            value = value.decode()
        elif kind == "chlist":
            value = channel_list(value)
        header[name] = value
    return header, at + 1


def unzip(block, size):
    """ZIP: deflate, then differences of bytes, then the two halves interleaved. Blocks that do not shrink are plain."""
    if len(block) == size:
        return block
    parts = numpy.frombuffer(zlib.decompress(block), numpy.uint8).astype(numpy.int64)
    parts[1:] -= 128
    parts = (numpy.cumsum(parts) & 255).astype(numpy.uint8)
    half = (size + 1) // 2
    whole = numpy.empty(size, numpy.uint8)
    whole[0::2], whole[1::2] = parts[:half], parts[half:]
    return whole.tobytes()


def read(file):
    data = pathlib.Path(file).read_bytes()
    header, at = header_of(data)
    x0, y0, x1, y1 = header["dataWindow"]
    assert header["displayWindow"] == header["dataWindow"]
    width, height, lines = x1 - x0 + 1, y1 - y0 + 1, LINES[header["compression"]]
    planes = {name: numpy.empty((height, width), kind) for name, kind in header["channels"]}
    bytes_per_line = sum(kind.itemsize for _, kind in header["channels"]) * width
    count = (height + lines - 1) // lines
    for offset in struct.unpack_from(f"<{count}Q", data, at):
        y, size = struct.unpack_from("<ii", data, offset)
        rows = min(lines, y1 + 1 - y)
        block = data[offset + 8:offset + 8 + size]
        assert len(block) == size, "truncated"
        block = unzip(block, rows * bytes_per_line) if header["compression"] else block
        at_block = 0
        for row in range(y - y0, y - y0 + rows):
            for name, kind in header["channels"]:
                planes[name][row] = numpy.frombuffer(block, kind, width, at_block)
                at_block += kind.itemsize * width
    return header, {name: plane if plane.dtype.kind == "u" else plane.astype(numpy.float32)
                    for name, plane in planes.items()}


def read_mip(file):
    """A mip map of float channels in tiles, levels rounded down: (header, [channels of each level])."""
    data = pathlib.Path(file).read_bytes()
    header, at = header_of(data)
    side_x, side_y, mode = struct.unpack("<IIB", header["tiles"])
    assert mode == 1 and data[4:8] == struct.pack("<I", 0x202) and header["compression"] == 3
    width, height = header["dataWindow"][2] + 1, header["dataWindow"][3] + 1
    levels = []
    while not levels or levels[-1][0] * levels[-1][1] > 1:
        levels.append((max(width >> len(levels), 1), max(height >> len(levels), 1)))
    names = [name for name, _ in header["channels"]]
    images = [{name: numpy.full((h, w), numpy.nan, numpy.float32) for name in names} for w, h in levels]
    count = sum(-(-w // side_x) * -(-h // side_y) for w, h in levels)
    for offset in struct.unpack_from(f"<{count}Q", data, at):
        x, y, level, same, size = struct.unpack_from("<5i", data, offset)
        assert level == same
        w, h = (min(side, whole - k * side) for side, whole, k in zip((side_x, side_y), levels[level], (x, y)))
        block = unzip(data[offset + 20:offset + 20 + size], 4 * w * h * len(names))
        values = numpy.frombuffer(block, "<f4").reshape(h, len(names), w)
        for k, name in enumerate(names):
            images[level][name][y * side_y:y * side_y + h, x * side_x:x * side_x + w] = values[:, k]
    return header, images


def write(file, channels):
    """An uncompressed file of float planes, a dict by name, all of one shape."""
    names = sorted(channels)
    rows, columns = channels[names[0]].shape

    def attribute(name, kind, value):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iIii", 2, 0, 1, 1) for name in names) + b"\0"
    window = struct.pack("<4i", 0, 0, columns - 1, rows - 1)
    head = struct.pack("<II", 20000630, 2)
    head += attribute("channels", "chlist", listed) + attribute("compression", "compression", b"\0")
    head += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window)
    head += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    head += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    head += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    size = 4 * columns * len(names)
    offsets = [len(head) + 8 * rows + k * (8 + size) for k in range(rows)]
    lines = [struct.pack("<ii", k, size) + b"".join(channels[n][k].astype("<f4").tobytes() for n in names) for k in range(rows)]
    pathlib.Path(file).write_bytes(head + struct.pack(f"<{rows}Q", *offsets) + b"".join(lines))
