#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The report's pictures: the law drawn over the slopes is the right one, lobes are integrated rightly, and all is written."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / os.environ.get("BUILD", "build")
sys.path.insert(0, str(ROOT / "scripts"))
from showing import gallery, lobes, surfaces  # noqa: E402


class Gallery(unittest.TestCase):
    def test_law_is_ggx_s(self):
        """Slopes of GGX are shorter than r with the chance r^2 / (r^2 + alpha^2); Simpson's rule over 200 steps leaves less than 1e-6."""
        r = np.linspace(0, 2, 201)
        density = surfaces.law(gallery.asker(BUILD / "musurf"), "ggx", {"alpha": 0.3}, np.maximum(r, 1e-9))
        weights = np.r_[1, np.tile([4, 2], 99), 4, 1] * (r[1] / 3)
        self.assertAlmostEqual(float(weights @ density), 4 / (4 + 0.09), 5)

    def test_slopes_are_compared_with_the_law(self):
        """n independent slopes in 61 bins of chance p are off by sum sqrt(2 p / pi n) / 2 in total variation on average, at most sqrt(61 / 2 pi n)."""
        n, random = 64, np.random.default_rng(5)
        length = 0.3 / np.sqrt(1 / random.random((n, n)) - 1)  # GGX
        angle = 2 * np.pi * random.random((n, n))
        ask, found = gallery.asker(BUILD / "musurf"), {}
        usual = surfaces.slopes
        self.addCleanup(setattr, surfaces, "slopes", usual)
        surfaces.slopes = lambda h: (length.ravel(), np.hypot(length * np.cos(angle), length * np.sin(angle)).ravel())
        for alpha in (0.3, 0.4):
            found[alpha] = surfaces.compared(None, ask, "ggx", {"alpha": alpha})["total_variation"]
        self.assertLess(found[0.3], (61 / (2 * np.pi * n * n)) ** 0.5)
        # P(r) of 0.3 and 0.4 is furthest apart, by 1/7, at r^2 = 0.12: that is the total variation
        self.assertAlmostEqual(found[0.4], 1 / 7, delta=2 * (61 / (2 * np.pi * n * n)) ** 0.5)

    def test_slopes_of_both_families(self):
        x, y = np.meshgrid(np.arange(8.0), np.arange(8.0), indexing="ij")
        lower, upper = surfaces.slopes(3 * x + 4 * y)
        inside = (np.arange(64).reshape(8, 8)[:7, :7]).ravel()  # away from the border, where a plane does not repeat
        np.testing.assert_allclose(np.r_[lower[inside], upper[inside]], 5)

    def test_albedo_of_a_lambertian_lobe(self):
        (theta, phi), h = lobes.grid(90, 180), np.pi / 180  # midpoints add up sin(2 theta) to 1 / sin(h)
        self.assertAlmostEqual(lobes.albedo(theta, phi, np.cos(theta) / np.pi), h / np.sin(h), 12)

    def test_everything_is_written(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, str(ROOT / "scripts" / "gallery"), "--quick", "-o", folder], capture_output=True, text=True, env=dict(os.environ, BUILD=str(BUILD)))
            self.assertEqual(done.returncode, 0, done.stderr)
            found, text = json.loads((pathlib.Path(folder) / "gallery.json").read_text()), (pathlib.Path(folder) / "fragment.html").read_text()
        self.assertEqual(text.count("data:image/png"), 2)
        self.assertEqual(len(found["surfaces"]), len(surfaces.LAWS))
        for lobe in found["lobes"]:
            self.assertTrue(0.4 < lobe["albedo"] < 1, lobe)


if __name__ == "__main__":
    unittest.main()
