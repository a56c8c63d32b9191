# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A direction map: a curling wave under a sky, each in brush strokes of its own, as an angle in [0, pi) at every texel.

Strokes follow the level lines of a phase: circles about the curl and about the sun, lines along the crests of a swell; where two regions meet, so do
two directions, which is what a plate is to show. Red and green are the stroke's direction, [-1, 1] as [0, 255]; the top row is v = 1.
"""
import os
import struct
import zlib

import numpy as np

SIDE = 512


def angle(u, v):
    """Radians from +u, counter-clockwise, of the stroke at (u, v) in [0, 1]."""
    around = lambda a, b: np.arctan2(v - b, u - a) + np.pi / 2  # noqa: E731
    swell = 0.2 + 0.06 * np.sin(9 * u + 0.6) + 0.25 * np.exp(-(((u - 0.28) / 0.16) ** 2))  # height of the water
    slope = 0.54 * np.cos(9 * u + 0.6) - 0.25 * 2 * (u - 0.28) / 0.16**2 * np.exp(-(((u - 0.28) / 0.16) ** 2))
    curl = np.hypot(u - 0.45, v - 0.5) < 0.2
    sun = np.hypot(u - 0.77, v - 0.76) < 0.13
    sky = 0.35 * np.sin(2 * np.pi * v)
    out = np.where(v < swell, np.arctan(slope) * v / swell, sky)
    out = np.where(curl, around(0.45, 0.5) + 0.5, out)  # a spiral
    return np.where(sun, around(0.77, 0.76), out) % np.pi


def picture(side=SIDE):
    """[side, side, 3] of uint8."""
    u, v = np.meshgrid((np.arange(side) + 0.5) / side, 1 - (np.arange(side) + 0.5) / side)
    a = angle(u, v)
    return np.round(np.stack([127.5 + 127.5 * np.cos(a), 127.5 + 127.5 * np.sin(a), np.zeros_like(a)], -1)).astype(np.uint8)


def write(path, pixels):
    """PNG of [rows, columns, 3] of uint8; beside, then renamed."""
    height, width = pixels.shape[:2]
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], 1)
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", width, height, 8, 2, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 9)) + chunk(b"IEND", b"")
    fresh = path.with_name(f"{path.name}.{os.getpid()}.new")
    fresh.write_bytes(data)
    fresh.replace(path)
