# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The surfaces looked at: made by `musurf surface make` for a distribution, or somebody's own heightfield.

A surface is heights h[i, j] over i along x and j along y, periodic, cell size 1, and the material whose microsurface it is.
"""
import json
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

import numpy as np

from . import heightfield, store

CLIP = 0.9999  # quantile above which no slope is made: what is above would be spires of one cell
CORRELATION = 8.0  # cells


class SurfaceError(Exception):
    """No surface: the words of whoever refused it."""


class Spec:
    """A distribution to make surfaces of: name, the material's parameters {"ndf", "alpha", ...}; its roughness as a scale."""

    def __init__(self, name, size, seed, **parameters):
        self.name, self.size, self.seed, self.parameters, self.file, self.folds = name, size, seed, parameters, None, False
        self.base, self.whole = np.eye(2), None  # the material's own map; the material, if a scene gave one
        phong = parameters.get("exponent")
        self.alpha = float(np.sqrt(2 / (phong + 2)) if phong is not None else parameters["alpha"])

    def plain(self):
        return {"material": "musurf.microfacet", **self.parameters}

    def material(self):
        return self.whole or self.plain()

    def heights(self, core, number):
        """Realisation `number`: heights as the file holds them."""
        options = [f"--{k}={v:.17g}" if isinstance(v, float) else f"--{k}={v}" for k, v in self.parameters.items()]
        command = ["surface", "make", *options, f"--size={self.size}", f"--seed={self.seed + number}",
                   f"--clip={CLIP}", f"--correlation={CORRELATION:g}"]
        key = store.digest(core.version, command)

        def make():
            with tempfile.TemporaryDirectory() as folder:
                path = pathlib.Path(folder) / "h.exr"
                done = subprocess.run([str(core.program), *command, "-o", str(path)], capture_output=True, text=True,
                                      stdin=subprocess.DEVNULL)
                if done.returncode:
                    raise SurfaceError(done.stderr.strip() or f"musurf surface make ended with {done.returncode}")
                return {"h": read_exr(path), "limit": json.loads(done.stdout)["limit"]}

        made = core.store.get("surface", key, make)
        if not np.isfinite(made["h"]).all():
            raise SurfaceError(f"{self.name}: musurf surface make wrote heights that are not finite")
        return made["h"].astype(float), float(made["limit"])


class Given:
    """A heightfield of the user's, as `musurf surface read` reads it: any kind of file, made periodic, in cells.

    Its material is the distribution of its own slopes, tabulated by the core. `folds`: it holds each piece in four mirror
    images, whose scatter is not independent.
    """

    CELLS = 64  # a side, of the table

    def __init__(self, core, file, reading=()):
        self.file = pathlib.Path(file)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "h.exr"
            done = subprocess.run([str(core.program), "surface", "read", str(file), *reading, "-o", str(path)],
                                  capture_output=True, text=True, stdin=subprocess.DEVNULL, env=core.environment)
            said = done.stderr.strip().splitlines() or [f"{file}: musurf surface read ended with {done.returncode}"]
            if done.returncode:
                raise SurfaceError(said[-1].removeprefix("musurf surface read: "))
            if done.stderr:
                print(done.stderr, end="", file=sys.stderr)
            self.h, data, self.read = read_exr(path).astype(float), path.read_bytes(), json.loads(done.stdout)
        del self.read["file"]
        if not 16 <= min(self.h.shape) <= max(self.h.shape) <= 2048:
            raise SurfaceError(f"{file}: has {' x '.join(map(str, self.h.shape))} cells; 16 to 2048 a side can be looked at")
        # named after its heights, not after the file's bytes, so that no answer of the core outlives it
        self.copy = core.store.folder.resolve() / f"heightfield-{store.digest(self.h)[:40]}.exr"
        if not self.copy.exists():
            store.write(self.copy, data)
        self.folds = self.read["border"] == "mirror"
        self.name, self.size, self.base, self.parameters = self.file.name, len(self.h), np.eye(2), None
        self.alpha = float(np.median(np.hypot(*heightfield.slopes(self.h))))  # as of ggx
        if not self.alpha > 0:
            raise SurfaceError(f"{file}: is flat; there is nothing to mask")

    def material(self):
        return {"material": "musurf.microfacet", "ndf": "tabulated", "histogram": {"heightfield": str(self.copy), "bins": self.CELLS}}

    def heights(self, core, number):
        """The one realisation."""
        if number:
            raise SurfaceError("a given heightfield is one realisation")
        return self.h, float(np.hypot(*heightfield.slopes(self.h)).max())


def read_exr(path):
    """The one float channel of a scanline OpenEXR file (uncompressed, ZIPS or ZIP), scanline i as row i."""
    data = pathlib.Path(path).read_bytes()
    if data[:8] != struct.pack("<II", 20000630, 2):
        raise ValueError("is no single-part scanline OpenEXR file")
    header, at = {}, 8
    while data[at]:
        end = data.index(b"\0", at)
        kind = data.index(b"\0", end + 1)
        size, = struct.unpack_from("<i", data, kind + 1)
        header[data[at:end]] = data[kind + 5:kind + 5 + size]
        at = kind + 5 + size
    name = header[b"channels"].index(b"\0")
    kind, = struct.unpack_from("<i", header[b"channels"], name + 1)
    x0, y0, x1, y1 = struct.unpack("<4i", header[b"dataWindow"])
    lines = {0: 1, 2: 1, 3: 16}.get(header[b"compression"][0])
    if kind != 2 or header[b"channels"][name + 17:] != b"\0" or lines is None:
        raise ValueError("has not one float channel, uncompressed or ZIP; convert it with oiiotool")
    width, height = x1 - x0 + 1, y1 - y0 + 1
    h = np.empty((height, width), "<f4")
    for offset in struct.unpack_from(f"<{-(-height // lines)}Q", data, at + 1):
        y, size = struct.unpack_from("<ii", data, offset)
        rows = min(lines, y1 + 1 - y)
        block, whole = data[offset + 8:offset + 8 + size], rows * width * 4
        if size < whole:
            parts = np.frombuffer(zlib.decompress(block), np.uint8).astype(np.int64)
            parts[1:] -= 128
            parts = (np.cumsum(parts) & 255).astype(np.uint8)
            half, plain = (whole + 1) // 2, np.empty(whole, np.uint8)
            plain[0::2], plain[1::2] = parts[:half], parts[half:]
            block = plain.tobytes()
        h[y - y0:y - y0 + rows] = np.frombuffer(block, "<f4", rows * width).reshape(rows, width)
    return h
