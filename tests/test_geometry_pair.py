#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The plate of explicit facets beside the fitted material: the pair shows the same thing, and a wrong M is seen."""
import os
import pathlib
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
MUSURF = ROOT / os.environ.get("BUILD", "build") / "musurf"
sys.path.insert(0, str(ROOT / "scripts"))
from geometry import errors, pair, render  # noqa: E402

CELLS, FINE, SAMPLES = 128, 8, 64
M = np.array(((1.0, 2.0), (0.0, 1.0)))


def block_means(picture, whole, side=6):
    """Means of luminance over blocks of pixels that show nothing but the plate."""
    shape = (picture.shape[0] // side, side, picture.shape[1] // side, side)
    inside = whole.reshape(shape).all((1, 3))
    return (picture @ errors.LUMINANCE).reshape(shape).mean((1, 3))[inside]


def write_sky(path):
    """A surrounding without any symmetry, as Radiance HDR with plain pixels: a lamp ahead, low and to the right; a gradient."""
    u, theta = np.meshgrid((np.arange(64) + 0.5) / 64, (np.arange(32) + 0.5) / 32 * np.pi)
    away = np.sin(theta) * np.sin(1.1) * np.cos(2 * np.pi * (u - 0.29)) + np.cos(theta) * np.cos(1.1)  # cosine of the angle to the lamp
    level = 15 + 10 * np.sin(2 * np.pi * u) * np.sin(theta) + 220 * np.exp((away - 1) / 0.04)
    mantissa, exponent = np.frexp(level / 128)  # mantissas from a half: that readers add a half of a step or not is below 1/256
    pixels = np.stack([256 * mantissa, 256 * mantissa, 128 * mantissa, exponent + 128], -1).astype(np.uint8)
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n" + pixels.tobytes())
    return path


class Pair(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        cls.folder = pathlib.Path(scratch.name)
        cls.plate, cls.camera = pair.Plate("skew", M, CELLS, 24 * CELLS), pair.Camera(24 * CELLS, 48, 36)
        cls.surface = cls.folder / "surface.exr"
        render.make_surface(MUSURF, {"ndf": "ggx", "alpha": 0.2}, CELLS, 3, 1, cls.surface)
        cls.material, _ = render.fit(MUSURF, cls.surface)
        render.write_mesh(MUSURF, cls.surface, M, cls.folder / "period.inc")
        (cls.folder / "plate.obj").write_text(pair.plate_obj(cls.plate))
        cls.whole, cls.beyond, cls.angle = cls.camera.sees(cls.plate, render.rise([cls.surface]))

    def facets(self, sky, bounces):
        text = pair.povray_scene(self.plate, self.camera, "period.inc", pair.povray_sky(sky), bounces)
        return render.render_geometry(text, self.folder, "facets", self.camera, FINE)[0]

    def shaded(self, sky, m=M, scattering="none"):
        plate = pair.Plate("skew", np.array(m, float), CELLS, self.plate.length)
        material = dict(self.material, multiple_scattering=scattering)
        text = pair.musurf_scene(plate, self.camera, "plate.obj", sky, material)
        return render.render_material(MUSURF, text, self.folder, "shaded", SAMPLES, 1)[0]

    def test_light_is_kept(self):
        """In white every reflection leads out in the end: facets and random walk return 1. POV-Ray drops what 19
        reflections leave, below 1e-3 by the geometric fall measured; its half floats round 1e-3 at most."""
        self.assertLess(np.abs(self.facets(None, 19)[self.whole].mean() - 1), 2e-3)
        self.assertLess(np.abs(self.shaded(None, scattering="random_walk")[self.whole].mean() - 1), 1e-3)
        self.assertLess(self.facets(None, 1)[self.whole].mean(), 0.97)

    def test_pair_agrees_and_a_wrong_map_is_seen(self):
        """The camera, the surrounding's orientation and the frame of M: were one of them wrong, blocks of pixels would
        differ as they do for the inverse of M, by several times as much."""
        sky = write_sky(self.folder / "sky.hdr")
        facets = self.facets(sky, 1)
        right, wrong = self.shaded(sky), self.shaded(sky, np.linalg.inv(M))
        self.assertTrue(self.beyond.any())
        # readers' halves of a step of 256, blue 128; half a pixel's turn of the sky would be 5 %
        self.assertLess(np.abs(facets[self.beyond] - right[self.beyond]).mean(), right[self.beyond].mean() / 100)
        seen = block_means(facets, self.whole)
        apart = [np.sqrt(np.mean((block_means(p, self.whole) - seen) ** 2)) for p in (right, wrong)]
        self.assertLess(2 * apart[0], apart[1], f"rms difference of blocks with M and with its inverse: {apart}")


if __name__ == "__main__":
    unittest.main()
