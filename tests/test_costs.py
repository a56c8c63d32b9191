#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What the study of costs concludes: its fits and corrections on made-up data whose answer is known, memory of the very process,
images against the geometry that they show, and the whole of it once, tiny."""
import contextlib
import dataclasses
import io
import json
import os
import pathlib
import shutil
import sys
import tempfile
import unittest

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / os.environ.get("BUILD", "build")
sys.path.insert(0, str(ROOT / "scripts"))
from costing import choose, draw, effort, image, laboratory, laws, process, run, studies  # noqa: E402

TINY = dataclasses.replace(effort.QUICK, sizes={64: 4, 128: 3}, points=(9, 16), points_of={"own": 2, "embree": 2, "povray": 1}, points_size=64, pool=8,
                           pixels=(61, 91, 121), aligned=(64,), scales={"own": (64, 96), "embree": (64, 96), "povray": (64,)}, check=0.0)
COST = {"seconds": 1.0, "cpu_seconds": 1.0, "megabytes": 10.0}


class MadeUp:
    """A laboratory whose G1 is 1/2 (1 + 8 z / N), z normal, apart for every surface."""

    def __init__(self):
        self.random, self.musurf, self.folder = np.random.default_rng(2026), None, None

    def make(self, size, seed):
        return size, COST

    def forget(self, size, seed):
        pass

    def measure(self, size, *_, **__):
        return 0.5 * (1 + 8 / size * self.random.standard_normal((3, 4))), COST, "none"

    def albedo(self, size):
        return self.measure(size)[0][:, 0], COST


class Laws(unittest.TestCase):
    def test_power_law_and_its_standard_error(self):
        x = np.array([1.0, 2, 4, 8, 16])
        exact = laws.power(x, 3 * x ** -0.5)
        self.assertAlmostEqual(exact["slope"], -0.5, 12)
        self.assertAlmostEqual(exact["factor"], 3, 12)
        self.assertAlmostEqual(exact["error"], 0, 7)  # the root of rounding
        y = 3 * x ** -0.5 * np.exp([0.1, -0.2, 0.05, 0.1, -0.1])
        (slope, _), covariance = np.polyfit(np.log(x), np.log(y), 1, cov=True)  # numpy's own least squares, scaled by the scatter
        found = laws.power(x, y)
        self.assertAlmostEqual(found["slope"], slope, 10)
        self.assertAlmostEqual(found["error"], covariance[0, 0] ** 0.5, 10)
        self.assertEqual((laws.power([1, 2], [1, 2])["error"], laws.power([1], [1])), (None, None))

    def test_sums_have_no_negative_term(self):
        terms = np.array([[1.0, n * n, n] for n in (10, 20, 40, 80)])
        np.testing.assert_allclose(laws.sums(terms, terms @ [5, 0.1, 0]), [5, 0.1, 0], rtol=1e-9, atol=1e-9)
        self.assertTrue((laws.sums(terms, terms @ [-3, 0.1, 0]) >= 0).all())


    def test_memory_of_the_program_itself_is_no_part_of_its_law(self):
        points = [dict(COST, label=str(n), facets=n, megabytes=10 + 0.01 * n) for n in (1, 10)]
        points += [dict(COST, label=str(n), facets=n, megabytes=n) for n in (100, 1000, 10000)]
        law = draw.series("s", points, "facets", "megabytes")["fit"]
        self.assertEqual((round(law["slope"], 9), law["points"]), (1.0, 3))
        self.assertEqual(draw.series("s", points, "facets", "seconds")["fit"]["points"], 5)


class Process(unittest.TestCase):
    def test_memory_is_the_child_s_own(self):
        held = np.ones(40_000_000)  # 320 MB: a child of this process starts with them
        grow = "x = bytearray(100 << 20); print(len(x))"
        said, used = process.call(sys.executable, "-I", "-S", "-c", grow)
        self.assertEqual(said, f"{100 << 20}\n")
        self.assertTrue(100 <= used["megabytes"] < 130, used)  # and Python's own, some 10
        small = process.call(sys.executable, "-I", "-S", "-c", "")[1]
        self.assertLess(small["megabytes"], 30)
        self.assertEqual(held[-1], 1)

    def test_processor_time_counts_grandchildren(self):
        spin = "import time\nwhile time.process_time() < 0.3: pass"
        nested = f"import subprocess, sys; subprocess.run([sys.executable, '-I', '-S', '-c', {spin!r}])"
        self.assertGreaterEqual(process.call(sys.executable, "-I", "-S", "-c", nested)[1]["cpu_seconds"], 0.3)

    def test_failures_are_told(self):
        with self.assertRaisesRegex(process.ProgramError, "broken: error"):
            process.call(sys.executable, "-c", "import sys; print('broken: error', file=sys.stderr); sys.exit(3)")
        with self.assertRaisesRegex(process.ProgramError, "nosuchprogram"):
            process.call("nosuchprogram")


class Studies(unittest.TestCase):
    """The scatter that a study finds is the one that was put in: 8/N for one surface, 8/N/sqrt(R) for R, within four standard errors.

    A mean of n squares of 12 (albedo: 3) independent normal deviations is known to sqrt(2 / 12 n), its root to half of that.
    """

    def near(self, point, true, count, values=12):
        self.assertLess(abs(point["y"] / true - 1), 4 * 0.5 * (2 / (values * count)) ** 0.5, (point, true))

    def test_sizes(self):
        plan = dataclasses.replace(TINY, sizes={64: 200, 128: 200, 256: 50})
        found = studies.sizes(MadeUp(), plan)
        for point, (size, count) in zip(found["points"], plan.sizes.items()):
            self.near(point, 8 / size, count)
            self.assertLess(point["bias"], 8 / size)  # nothing is shared but noise
        self.assertLess(abs(found["reference_error"] / (8 / 256 / 50 ** 0.5) - 1), 0.2)

    def test_realisations(self):
        found = studies.realisations(MadeUp(), dataclasses.replace(TINY, pool=512, pool_size=64))
        for name, values in (("G1 per slope bin", 12), ("albedo of mirrors", 3)):
            for point in found["series"][name]:
                self.near(point, 8 / 64 / point["realisations"] ** 0.5, 512 // point["realisations"], values)
                self.assertEqual(point["seconds"], 2 * point["realisations"])
        self.assertEqual([p["label"] for p in found["series"]["albedo of mirrors"]][-1], "R 128")


class Choice(unittest.TestCase):
    def setUp(self):
        sizes = {"points": [{"size": n, "y": 8 / n, "bias": 0.0, "unknown": 0.02 / n} for n in (64, 128, 256)]}
        samples = {"size": 64, "laws": {9: {"bias": 2e-3, "scatter": 0.01}, 36: {"bias": 5e-4, "scatter": 0.005}}}
        self.errors = choose.Errors(sizes, samples)
        cost = lambda n, k: {u: 0.1 + 1e-6 * n * n * (10 + k) for u in choose.UNITS}  # noqa: E731
        self.costs = choose.Costs({n: cost(n, 0) for n in (64, 128, 256)}, [(n, k, cost(n, k)) for n in (64, 128, 256) for k in (9, 36)])

    def test_enough_and_no_more(self):
        for wanted in choose.TARGETS:
            choice = choose.best(self.errors, self.costs, wanted, "seconds")
            self.assertLessEqual(choice["predicted"], wanted)
            varying, shared = self.errors.of_one(choice["size"], choice["points"])
            if choice["realisations"] > 1:
                self.assertGreater(varying ** 2 / (choice["realisations"] - 1) + shared ** 2, wanted ** 2)

    def test_pixels_by_the_law(self):
        points = [dict(COST, pixels=r, y=100 / r ** 1.5, seconds=r * r * 1e-6) for r in (100, 200, 400)]
        found = choose.pixels(points, "seconds")
        self.assertEqual([(c["pixels"], c["measured"]) for c in found[:2]], [(465, False), (1036, False)])  # (100 / 0.01)^(2/3) = 464.2, (100 / 0.003)^(2/3) = 1035.7
        self.assertAlmostEqual(found[0]["seconds"], 465 ** 2 * 1e-6, 9)
        self.assertIsNone(choose.pixels([dict(COST, pixels=r, y=r) for r in (1, 2, 3)], "seconds"))

    def test_bias_is_not_averaged_away(self):
        self.assertIsNone(self.errors.realisations(256, 9, 1e-3))  # b(9) is 2e-3
        self.assertAlmostEqual(self.errors.parts[225][0], 5e-4 * (225 / 36) ** -1, 9)  # its law through 9 and 36: 1/K
        self.assertIsNone(choose.best(self.errors, self.costs, 5e-5, "seconds"))  # less than b(225)

    def test_grids_that_are_not_known_well_enough_are_left_out(self):
        self.errors.shared[64] = (0.0, 0.02)
        self.assertIsNone(self.errors.realisations(64, 36, 0.01))
        self.assertIsNotNone(self.errors.realisations(128, 36, 0.01))


@unittest.skipUnless(shutil.which(os.environ.get("POVRAY", "povray")), "needs POV-Ray")
class Image(unittest.TestCase):
    def test_pixels_agree_with_the_exact_caster(self):
        """Lattice points in a facet's shadow miss its area by less than the pixels that its border crosses. Bins add these up as independent
        errors of half that: four of their standard deviations, and 1/500 for the 225 points."""
        with tempfile.TemporaryDirectory() as folder:
            lab = laboratory.Laboratory(BUILD / "musurf", pathlib.Path(folder).resolve())
            file, pixels = lab.make(64, 1)[0], 181
            exact, (found, cost) = lab.measure(file, "own", 225)[0], image.measure(lab, file, pixels)
            h = image.heights(file)
        self.assertGreater(cost["megabytes"], 10)
        n, s = len(h), image.slopes(h)
        edges = np.stack([np.stack([np.ones(s.shape[:3]), np.zeros(s.shape[:3]), s[..., 0]], -1), np.stack([np.zeros(s.shape[:3]), np.ones(s.shape[:3]), s[..., 1]], -1)])
        for k, v in enumerate(laboratory.VIEWS):
            shadows = edges[..., :2] - edges[..., 2:] * (v[:2] / v[2])
            border = np.linalg.norm(np.stack([shadows[0], shadows[1], shadows[0] - shadows[1]]), axis=-1).sum(0) * pixels / n
            shade = 0.5 * (1 - (s @ v[:2]) / v[2])
            bins = np.digitize((s @ v[:2]) / np.hypot(*v[:2]), laboratory.EDGES) - 1
            for b in range(len(laboratory.EDGES) - 1):
                here = (bins == b) & (shade > 0)
                spread = np.sqrt(((border[here] / 2 * (n / pixels) ** 2 / shade[here]) ** 2).sum()) / here.sum()
                self.assertLess(abs(found[k, b] - exact[k, b]), 4 * spread + 1 / 500, (k, b))

    def test_whole_study_tiny(self):
        with tempfile.TemporaryDirectory() as folder:
            usual, effort.QUICK = effort.QUICK, TINY
            self.addCleanup(setattr, effort, "QUICK", usual)
            out = io.StringIO()
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()) as complaint:
                code = run.main(["--quick", "--clock", "cpu", "-o", folder], BUILD)
            self.assertEqual(code, 0, complaint.getvalue())
            found, text = json.loads((pathlib.Path(folder) / "costs.json").read_text()), (pathlib.Path(folder) / "fragment.html").read_text()
            curves = sorted(path.name for path in (pathlib.Path(folder) / "curves").iterdir())
        self.assertEqual(curves, ["1-grid.json", "2-grid-memory.json", "3-points.json", "4-images.json", "5-time.json", "6-memory.json"])
        self.assertEqual(text.count("<img"), len(curves))
        self.assertEqual(len(found["choices"]["rows"]), len(choose.TARGETS) * len(found["tracers"]))
        self.assertTrue(all(row["different"] <= 1e-3 * row["bits"] for row in found["scales"]), found["scales"])  # rays in float may pass an edge on its other side: 3.4e-4 has been seen
        self.assertIn("What to choose", text)
        self.assertIn("for an error of G1", out.getvalue())


if __name__ == "__main__":
    unittest.main()
