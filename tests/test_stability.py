#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""scripts/stability: a small run passes and leaves its files; its judge notices every kind of wrong answer."""
import copy
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / os.environ.get("BUILD", "build")
sys.path[:0] = [str(ROOT / folder) for folder in ("scripts", "tests", "tests/reference")]
from precision import exact, grid, measure, more, sampled  # noqa: E402

COUNT = 12


class Stability(unittest.TestCase):
    def test_a_small_run(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, ROOT / "scripts/stability", "--points", str(COUNT), "-o", folder],
                                  text=True, capture_output=True, env=dict(os.environ, BUILD=str(BUILD)))
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            names = {path.name for path in pathlib.Path(folder).iterdir()}
            self.assertLessEqual({"stability.json", "stability.md", "stability.html", "alpha.png", "cos.png", "cond.png", "gamma.png", "quantity.png"}, names)
            found = json.loads((pathlib.Path(folder) / "stability.json").read_text())
            self.assertEqual(found["points"], COUNT + COUNT // more.SHARE)
            self.assertEqual(set(found["checks"]["float"]["numbers"]), {"draws of `sample`", "compensated", "random_walk", "flakes"})
            self.assertTrue(found["drawn"] > 0 and found["coverage"])
            self.assertEqual({r["precision"] for r in found["records"]}, {"float", "double"})

    def test_the_judge(self):
        pairs = [pair for pair in grid.points(400)
                 if pair[0]["material"]["ndf"] == "ggx" and pair[0]["material"]["alpha"] == 0.1][:3]
        questions, axes = zip(*pairs)
        known = [exact.answer(question) for question in questions]
        right = measure.ask(BUILD / "musurf", questions, "double")
        self.assertEqual(measure.judge(known, axes, right, "double")[1], [])

        def failures(change):
            wrong = copy.deepcopy(right)
            change(wrong[0])
            return measure.judge(known, axes, wrong, "double")[1]

        self.assertIn("off by", failures(lambda a: a.update(sigma=a["sigma"] * (1 + 1e-4)))[0])
        self.assertIn("is not finite", failures(lambda a: a.update(pdf=float("nan")))[0])
        self.assertIn("is negative", failures(lambda a: a.update(D=-a["D"]))[0])
        self.assertIn("above 1", failures(lambda a: a.update(G2=1.0000001))[0])
        self.assertIn("refused", failures(lambda a: a.update(error="refused"))[0])

    def test_every_kind_has_values_and_a_judge(self):
        """Of each kind beyond the families, one wrong value is told from the right ones."""
        pairs = list(more.points(1, len(more.KINDS)))
        for kind, key in (("samplers", "pdf"), ("tabulated", "sigma"), ("spline", "sigma"), ("discrete", "sigma"), ("flat", "sigma")):
            questions, axes = zip(*[pair for pair in pairs if pair[1]["kind"] == kind])
            known = [exact.answer(question) for question in questions]
            right = measure.ask(BUILD / "musurf", questions, "double")
            records, failures = measure.judge(known, axes, right, "double")
            self.assertEqual(failures, [])
            number = next(k for k, a in enumerate(right) for r in records if r["id"] == a["id"] and r["quantity"].endswith(key)
                          and r["allowed"] < 1e-4)
            right[number][key] *= 1 + 1e-3
            self.assertIn("off by", measure.judge(known, axes, right, "double")[1][0], kind)

    def test_the_judge_of_draws(self):
        material = {"material": "musurf.microfacet", "ndf": "ggx", "alpha": 0.1}
        wo = [0.6, 0, 0.8]
        drawn = sampled.draw(BUILD / "musurf", material, wo, 1, "double")
        self.assertEqual([what for s in drawn for what in sampled.problems(material, wo, s, "double")], [])
        good = next(s for s in drawn if s["wi"])
        for change, what in (({"f": [float("inf"), 1, 1]}, "not finite"), ({"pdf": -1.0}, "negative"), ({"wi": [0.6, 0, 0.9]}, "|wi|"),
                             ({"weight": [1.001, 1, 1]}, "above 1")):
            self.assertIn(what, sampled.problems(material, wo, {**good, **change}, "double")[0])


if __name__ == "__main__":
    sys.exit(unittest.main())
