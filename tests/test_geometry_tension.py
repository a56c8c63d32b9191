#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The deformed plate of facets beside "tension": the pair is one scene, the measures know their own errors, and a plate agrees."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

from command import BUILD, ROOT

sys.path.insert(0, str(ROOT / "scripts"))
from geometry import deformed, deformed_run, errors, highlight  # noqa: E402
from reporting import claims  # noqa: E402

M = np.array(((1.2, 0.5), (-0.3, 0.9)))


class Pair(unittest.TestCase):
    def test_periods_are_the_plate(self):
        """Their corners span the deformed square; as many as its area holds."""
        plate = deformed.Deformed("", M, 32, 5 * 32)
        starts, whole = plate.periods()
        corners = np.concatenate([starts + corner @ (32 * M.T) for corner in np.array([(0, 0), (1, 0), (0, 1), (1, 1)])]) @ np.linalg.inv(M).T
        np.testing.assert_allclose([corners.min(0), corners.max(0)], [(-80, -80), (80, 80)], atol=1e-9)
        self.assertEqual((len(np.unique(np.round(starts, 6), axis=0)), whole.all()), (25, True))

    def test_lamp_faces_the_middle_and_mirrors_the_camera(self):
        square, eye = deformed.lamp(100.0), deformed.camera(100.0, 8, 8)
        x, y, z, place = square.T
        np.testing.assert_allclose(np.cross(x, y) / np.linalg.norm(np.cross(x, y)), z / np.linalg.norm(z), atol=1e-12)
        np.testing.assert_allclose(z / np.linalg.norm(z), -place / np.linalg.norm(place), atol=1e-12)
        np.testing.assert_allclose(place * (1, -1, 1), eye.eye, atol=1e-9)

    def test_pixels_lie_where_rays_meet_the_plate(self):
        eye = deformed.camera(100.0, 31, 31)
        place = highlight.places(eye, 100.0)
        np.testing.assert_allclose(place[15, 15], (0, 0), atol=1e-12)
        ray = np.append(100 * place[3, 7], 0) - eye.eye
        ray /= ray @ eye.ahead
        np.testing.assert_allclose(((ray @ eye.right / eye.wide + 0.5) * 31, (0.5 - ray @ eye.up / eye.tall) * 31), (7.5, 3.5))


class Measures(unittest.TestCase):
    def setUp(self):
        x, y = np.meshgrid(np.linspace(-1, 1, 201), np.linspace(-1, 1, 201))
        self.place, self.whole = np.stack([x, y], -1), np.ones(x.shape, bool)
        turned = self.place @ ((0.8, -0.6), (0.6, 0.8))  # the longer axis at 36.87 degrees
        self.picture = np.exp(-(turned ** 2 / (2 * np.array((0.2, 0.1)) ** 2)).sum(-1))[..., None] * np.ones(3)

    def rows(self, factor, spread=0.0):
        geometry = np.array([self.picture * factor[..., None] * (1 + k * spread) for k in (-1, 0, 1)])
        return {row["measure"]: row for row in highlight.rows(geometry, np.array([self.picture] * 2), self.whole, self.place, 0.05)}

    def test_ellipse_of_a_gaussian(self):
        np.testing.assert_allclose(highlight.ellipse(self.picture, self.whole, self.place), (0.2, 0.1, np.degrees(np.arctan2(0.6, 0.8))), rtol=1e-4)

    def test_worst_errors_reach_the_tolerance(self):
        """An error of rms 0.05 in the shape of a measure moves it by 0.05, to first order; no such error moves any by more."""
        p = self.picture @ errors.LUMINANCE
        p = p / p.sum()
        for name, weights, over in highlight.measures(self.place[self.whole], p.ravel()):
            if name == "peak":
                continue
            shape = np.ones_like(p) if over is None else weights.reshape(p.shape)
            e = 0.05 * shape / np.sqrt((p * shape ** 2).sum())
            found = self.rows(1 + e)
            self.assertAlmostEqual(found[name]["deviation"], 0.05, delta=0.05 ** 2)
            for other, row in found.items():
                if other != "peak":
                    self.assertLessEqual(abs(row["deviation"]), 0.05 + 0.05 ** 2)

    def test_verdicts(self):
        """t of 2 degrees of freedom at 1 % is 9.925; a spread of k makes a standard error of k / sqrt 3."""
        one = np.ones(self.whole.shape)
        for factor, spread, verdict in ((1.04, 0.0, "agrees"), (1.06, 0.0, "FAILS"), (1.0, 0.008, "agrees"), (1.0, 0.01, "undecided"), (1.2, 0.01, "FAILS"),
                                        (1.06, 0.01, "undecided")):
            self.assertEqual(self.rows(factor * one, spread)["light"]["verdict"], verdict, (factor, spread))
            self.assertEqual(self.rows(factor * one, spread)["moment xx"]["verdict"], "agrees")

    def test_tolerance_is_that_of_the_steepest_slopes(self):
        self.assertEqual(highlight.tolerance({"ndf": "beckmann", "alpha": 0.15}, np.diag((1, 0.6))), 0.05)
        self.assertEqual(highlight.tolerance({"ndf": "beckmann", "alpha": 0.15}, np.diag((1, 0.4))), 0.10)
        self.assertEqual(highlight.tolerance({"ndf": "ggx", "alpha": 0.15}, np.eye(2)), 0.10)


class Plate(unittest.TestCase):
    def test_a_plate_stretched_sheared_and_turned(self):
        """Small: 4 realisations. Nothing may fail; the material as it was must."""
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, str(ROOT / "scripts" / "geometry-tension"), "--quick", "--deformation", deformed_run.DEFORMATIONS[2][0], "-o", folder],
                                  capture_output=True, text=True, env=dict(os.environ, BUILD=str(BUILD)))
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            told = json.loads((pathlib.Path(folder) / "deformed.json").read_text())
            text = (pathlib.Path(folder) / "fragment.html").read_text()
        self.assertEqual((text.count("data:image/png"), text.count("<td>moment xy</td>")), (1, 1))
        self.assertIn("the material as at rest fails, as it must", claims.deformed({"deformed": told})[0])
        plate, = told["plates"]
        self.assertEqual([row["measure"] for row in plate["rows"]], ["light", "peak", "place x", "place y", "moment xx", "moment yy", "moment xy"])
        for row in plate["rows"]:
            self.assertLess(abs(row["deviation"]), plate["tolerance"] + 6 * row["error"], row)  # t of 3 degrees of freedom at 1 % is 5.8
            self.assertLess(row["error"], 0.05, row)
        self.assertIn("FAILS", [row["verdict"] for row in plate["as_at_rest"]])
        self.assertNotEqual(claims.deformed({"deformed": told})[1], "FAILS")
        right = plate["as_at_rest"]
        plate["as_at_rest"] = [dict(row, verdict="agrees") for row in right]
        self.assertEqual(claims.deformed({"deformed": told})[1], "FAILS")
        plate["as_at_rest"], plate["rows"][3]["verdict"] = right, "FAILS"
        self.assertEqual(claims.deformed({"deformed": told})[1], "FAILS")


if __name__ == "__main__":
    sys.exit(unittest.main())
