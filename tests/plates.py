# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What the tests of parameters with sources share: a plate, its picture, textures for it, and refusals."""
import json
import pathlib
import struct
import tempfile
import unittest
import zlib

import numpy as np

import exr
from command import microfacet, musurf

M = [[1, 2], [-0.5, 1.5]]
FLAT = {"u": "u", "v": "v"}  # the Jacobian of the identity: M goes through slots


def write_png(file, codes):
    """8-bit, grey or RGB."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    rows, columns = codes.shape[:2]
    raw = b"".join(b"\0" + row.tobytes() for row in codes.astype(np.uint8))
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 2 * (codes.ndim == 3), 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


class Pictures(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def texture(self, name, planes):
        exr.write(self.folder / name, {c: np.asarray(p, np.float32) for c, p in planes.items()})
        return {"texture": name}

    def scene(self, material, samples=4, size=(40, 30), file="m.ply", change=lambda scene: None, **item):
        item = item or {"shape": "rectangle", "size": [2, 2]}
        scene = {"camera": {"position": [0.5, -2.5, 2], "target": [0, 0, 0], "fov": 40},
                 "film": {"width": size[0], "height": size[1], "pixels": "float"}, "integrator": {"samples": samples, "depth": 2},
                 "meshes": {"m": {"file": file}} if "mesh" in item else {},
                 "objects": [dict(item, material=material)],
                 "lights": [{"type": "studio"}, {"type": "rectangle", "transform": [{"rotate": [1, 0, 0, 180]}, {"translate": [1, 2, 3]}]}]}
        change(scene)
        (self.folder / "scene.json").write_text(json.dumps(scene))
        return self.folder / "scene.json"

    def picture(self, material, *more, plain=False, **scene):
        """[RGB, rows, columns]; `plain`: it may be of one brightness."""
        done = musurf("render", self.scene(material, **scene), "-o", self.folder / "out.exr", "--progress", "none", *more)
        self.assertEqual(done.returncode, 0, done.err)
        channels = exr.read(self.folder / "out.exr")[1]
        picture = np.stack([channels[c] for c in "RGB"])
        if not plain:
            self.assertGreater(picture.std(), 0.01)
        return picture

    def metal(self, **parameters):
        return microfacet(sampler="visible", fresnel={"conductor": "Ag"}, **parameters)

    def refused(self, material, *words, **scene):
        done = musurf("render", self.scene(material, **scene), "-o", self.folder / "out.exr", "--progress", "none")
        self.assertEqual(done.returncode, 2, done.err)
        line = done.err.strip()
        self.assertEqual(len(line.splitlines()), 1, line)
        for word in words:
            self.assertIn(word, line)
        return line
