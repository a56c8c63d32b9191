#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Is the cross-check with POV-Ray itself right? Surfaces, POV-Ray's bits by pencil and by an exact caster, its verdicts.

The seeds were fixed before the first run. POV-Ray's bits are held to 1e-4 of all, as in scripts/validate.
"""
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests")]
import beckmann_core  # noqa: E402
import exact_caster  # noqa: E402
from crosscheck import experiment, heightfield, maps, masking, mesh, povray, statistics, steps, tables, verdicts  # noqa: E402

SKEW = np.array([[1.0, 2.0], [0.0, 1.0]])
MIRROR = np.array([[0.8, 0.5], [0.3, -1.2]])
VIEWS = [maps.direction(60, 20), maps.direction(75, 140), maps.direction(85, 260)]


def look(h, m, lights, views=VIEWS, fine=1, field=False):
    """POV-Ray's bits of the surface under m, lit from the lights."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        h, quantised = heightfield.quantise(h)
        surface = povray.height_field(h, quantised, folder / "h.pgm") if field else povray.mesh2(h, m)
        image, _ = povray.run(povray.scene(surface, h, m, lights, povray.tiles(h, views)), folder, "look",
                              2 * len(h) * fine, len(h) * fine)
        return povray.visibility(image, len(h), len(lights))


class Heightfields(unittest.TestCase):
    def test_slopes_have_beckmanns_covariance_on_both_kinds_of_facets(self):
        for n, alpha, correlation in ((64, 0.3, 4.0), (256, 0.5, 8.0)):
            sx, sy = heightfield.slopes(heightfield.make(n, alpha, correlation, 11))
            for facet in (0, 1):
                x, y = sx[..., facet], sy[..., facet]
                self.assertAlmostEqual((x * x).mean() / (alpha**2 / 2), 1, places=10)
                self.assertAlmostEqual((y * y).mean() / (alpha**2 / 2), 1, places=10)
                self.assertAlmostEqual((x * y).mean() / (alpha**2 / 2), 0, places=10)

    def test_slopes_are_gaussian(self):
        # <s^4> = 2 alpha^4 for Beckmann; 16 surfaces, their own spread, Student's t at the suite's level 2.45e-6 (15 df: 7.5)
        fourth = [(np.hypot(*heightfield.slopes(heightfield.make(128, 0.4, 8.0, (5, k)))) ** 4).mean() for k in range(16)]
        power = heightfield.isotropic_spectrum(128, 0.4, 8.0)
        modes = np.sum(power) ** 2 / np.sum(power**2)
        allowed = 7.5 * statistics.standard_error(fourth) + 2 * 0.4**4 * 2 * 1.5 / (modes / 2)  # and the modes' finite number
        self.assertLess(abs(np.mean(fourth) - 2 * 0.4**4), allowed)

    def test_periodic_and_seeded(self):
        h = heightfield.make(32, 0.5, 4.0, 3)
        np.testing.assert_array_equal(h, heightfield.make(32, 0.5, 4.0, 3))
        self.assertFalse(np.allclose(h, heightfield.make(32, 0.5, 4.0, 4)))
        corners = mesh.vertices(h, SKEW)
        np.testing.assert_array_equal(corners[0, :, 2], corners[-1, :, 2])
        np.testing.assert_allclose(corners[-1, :, :2] - corners[0, :, :2], np.tile(SKEW @ [32, 0], (33, 1)), atol=1e-12)

    def test_baked_slopes_follow_the_inverse_transpose(self):
        h = heightfield.make(32, 0.5, 4.0, 3)
        for m in (SKEW, MIRROR, np.diag([5.0, 1.0])):
            np.testing.assert_allclose(np.tensordot(m.T, mesh.baked_slopes(h, m), 1), heightfield.slopes(h), atol=1e-12)

    def test_quantised_heights_are_what_the_image_holds(self):
        h, (levels, low, high) = heightfield.quantise(heightfield.make(32, 0.5, 4.0, 3))
        self.assertEqual((levels.min(), levels.max()), (0, 65535))
        np.testing.assert_allclose(h, low + (high - low) * levels / 65535.0, atol=1e-12)


class PovrayByPencil(unittest.TestCase):
    """A ridge of height 2 along y over x = 0, faces one cell wide, on a plane of period 16; tan of the views is 3.

    Its shadow reaches 6 cells from x = 0. Seen from +x, the six cells before x = 16 are dark (the last is the ridge's
    far face, slope 2 > cot = 1/3); from -x the six after x = 0; from +y none, the ridge runs along the view.
    """

    def test_ridge(self):
        h = np.zeros((16, 16))
        h[0] = 2.0
        views = [np.array([3.0, 0, 1]) / np.sqrt(10), np.array([-3.0, 0, 1]) / np.sqrt(10), np.array([0, 3.0, 1]) / np.sqrt(10)]
        column = np.arange(16)
        expected = [column < 10, column >= 6, column >= 0]
        for name, m, field in (("height_field", np.eye(2), True), ("mesh", np.eye(2), False), ("skew", SKEW, False),
                               ("mirror", MIRROR, False)):
            bits = look(h, m, [maps.carried(m, v) for v in views], views, 3, field)
            for k in range(3):
                with self.subTest(surface=name, view=k):
                    np.testing.assert_array_equal(bits[k], np.broadcast_to(expected[k][:, None, None, None], bits[k].shape))

    def test_failure_speaks_povrays_words(self):
        with tempfile.TemporaryDirectory() as folder:
            with self.assertRaisesRegex(povray.PovrayError, "bad.pov: .*Parse Error"):
                povray.run("sphere { this is no scene", folder, "bad", 4, 4)


class PovrayAgainstExactCaster(unittest.TestCase):
    N, FINE = 64, 3

    @classmethod
    def setUpClass(cls):
        cls.h, _ = heightfield.quantise(heightfield.make(cls.N, 0.5, 5.0, 7))
        # the points of povray.visibility: [i, j, L|U, point]
        p, q = np.meshgrid((np.arange(2 * cls.FINE) + 0.5) / (2 * cls.FINE), (np.arange(cls.FINE) + 0.5) / cls.FINE,
                           indexing="ij")
        i, j = np.meshgrid(np.arange(cls.N), np.arange(cls.N), indexing="ij")
        lower = p + q < 1
        x = np.stack([i[..., None] + p[lower], i[..., None] + p[~lower][::-1]], 2)
        y = np.stack([j[..., None] + q[lower], j[..., None] + q[~lower][::-1]], 2)
        slopes = heightfield.slopes(cls.h)
        cls.exact = np.array([exact_caster.visible(cls.h, x, y, (masking.facing(slopes, v) > 0)[..., None] & (x == x), v)
                              for v in VIEWS])

    def differing(self, m, lights, field=False):
        different, total = masking.disagreement(look(self.h, m, lights, fine=self.FINE, field=field), self.exact)
        return different / total

    def test_same_bits_under_every_map(self):
        self.assertTrue((self.differing(np.eye(2), VIEWS, True) <= verdicts.MASKING_LIMIT).all())
        for m in (np.eye(2), SKEW, MIRROR):
            share = self.differing(m, [maps.carried(m, v) for v in VIEWS])
            self.assertTrue((share <= verdicts.MASKING_LIMIT).all(), f"{m.tolist()}: {share}")

    def test_wrong_directions_are_noticed(self):
        inverse = np.linalg.inv(SKEW)
        for lights in (VIEWS, [maps.carried(inverse, v) for v in VIEWS], [maps.carried(SKEW.T, v) for v in VIEWS]):
            self.assertTrue((self.differing(SKEW, lights) >= verdicts.CONTROL_LIMIT).all())

    def test_centre_is_the_single_sample(self):
        bits = look(self.h, np.eye(2), VIEWS)
        self.assertLessEqual((bits != masking.centre(self.exact)).mean(), verdicts.MASKING_LIMIT)


class Verdicts(unittest.TestCase):
    """The judge, with Beckmann's closed forms as the core: it accepts the right one and rejects wrong ones."""

    @classmethod
    def setUpClass(cls):
        cls.setup = experiment.Setup(alpha=0.5, size=128, correlation=8.0, seed=2022, realisations=1, threads=2,
                                     views=[maps.direction(60, 20), maps.direction(75, 140)],
                                     maps={"stretch": np.diag([3.0, 1.0]), "mirror": MIRROR})
        with tempfile.TemporaryDirectory() as folder:
            cls.measured = experiment.run(cls.setup, pathlib.Path(folder), steps.Steps(experiment.work(cls.setup), True))

    def failing(self, mutant=None):
        core = beckmann_core.Core(mutant)
        rows = [*verdicts.projected(self.setup, self.measured, core), *verdicts.bins(self.setup, self.measured, core),
                *verdicts.joint(self.setup, self.measured, core), *verdicts.distribution(self.setup, self.measured, core)[0]]
        return {r["check"] for r in rows if r["verdict"] == verdicts.FAILS}

    def test_right_core_passes(self):
        self.assertEqual(self.failing(), set())
        rows = verdicts.masking(self.setup, self.measured) + verdicts.control(self.setup, self.measured)
        self.assertEqual({r["verdict"] for r in rows}, {verdicts.AGREES})

    def test_wrong_cores_fail(self):
        for mutant, found in (("no determinant", "D of normals"), ("M inverse", "D of normals"), ("M inverse", "sigma"),
                              ("M inverse", "G1 projected mean"), ("G1 for G2", "G2 / (G1 G1)"),
                              ("G1 for G2 in f", "G2 / (G1 G1)"), ("alpha 5 % large", "sigma"),
                              ("cube for fourth power", "D of normals")):
            with self.subTest(mutant=mutant, found=found):
                self.assertIn(found, self.failing(mutant))

    def test_changed_bits_fail(self):
        broken = {name: [dict(s, different=s["different"] + s["total"] // 1000) for s in surfaces]
                  for name, surfaces in self.measured["maps"].items()}
        rows = verdicts.masking(self.setup, dict(self.measured, maps=broken))
        self.assertEqual({r["verdict"] for r in rows}, {verdicts.FAILS})
        self.assertTrue(all(line.startswith("FAILS") for line in tables.lines(rows)))


class Statistics(unittest.TestCase):
    def test_student(self):  # printed tables: two-sided 1 %
        self.assertAlmostEqual(statistics.student(10, 1), 3.1693, places=4)
        self.assertAlmostEqual(statistics.student(3, 1), 5.8409, places=4)

    def test_ratio_of_blocks(self):
        random = np.random.default_rng(1)
        bottom = random.uniform(1, 2, (4000, 50))
        top = 0.7 * bottom + random.normal(0, 0.1, bottom.shape)
        value, error = statistics.ratio(top, bottom)
        self.assertAlmostEqual(value.std() / error.mean(), 1, delta=0.05)  # 4000 values: 1.1 % standard deviation


class CommandLine(unittest.TestCase):
    def run_validate(self, *arguments, **environment):
        return subprocess.run([sys.executable, str(ROOT / "scripts" / "validate"), *arguments], capture_output=True, text=True,
                              env=dict(os.environ, **environment), stdin=subprocess.DEVNULL)

    def test_usage(self):
        for arguments in (["--full"], ["--transform", "1,2,2,4"], ["--transform", "1,2"], ["--view", "1,0,0"],
                          ["--view", "nan,0,1"], ["--alpha", "0"], ["--size", "7"], ["--what"],
                          ["--view=0,1,1"] * 4):
            with self.subTest(arguments=arguments):
                done = self.run_validate(*arguments)
                self.assertEqual((done.returncode, done.stdout), (2, ""))

    def test_missing_parts_are_named_and_nothing_is_written(self):
        with tempfile.TemporaryDirectory() as folder:
            output = pathlib.Path(folder) / "out"
            for environment, word in (({"POVRAY": "/nonexistent"}, "POV-Ray not found"), ({"BUILD": folder}, "is not built")):
                done = self.run_validate("-o", str(output), **environment)
                self.assertEqual((done.returncode, done.stdout), (1, ""))
                self.assertRegex(done.stderr, f"^validate: [^\n]*{word}[^\n]*\n$")
                self.assertFalse(output.exists())


if __name__ == "__main__":
    unittest.main()
