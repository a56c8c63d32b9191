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
from precision import exact, grid, measure  # noqa: E402

COUNT = 24


class Stability(unittest.TestCase):
    def test_a_small_run(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, ROOT / "scripts/stability", "--points", str(COUNT), "-o", folder],
                                  text=True, capture_output=True, env=dict(os.environ, BUILD=str(BUILD)))
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            names = {path.name for path in pathlib.Path(folder).iterdir()}
            self.assertLessEqual({"stability.json", "stability.md", "stability.html", "alpha.png", "cos.png", "cond.png"}, names)
            found = json.loads((pathlib.Path(folder) / "stability.json").read_text())
            self.assertEqual(found["points"], COUNT)
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


if __name__ == "__main__":
    sys.exit(unittest.main())
