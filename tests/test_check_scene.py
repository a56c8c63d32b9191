#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf check SCENE` of right materials that its random ones are not (check_scene.py): none is passed over, every law holds at
one family-wise level, and each of what they bring is truly asked. tests/test_mutants.py sees that wrong ones fail.

With --all in the arguments: every sampler, form and kind under every map, which takes minutes.
"""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import check_scene
from command import MUSURF, strict

ALL = "--all" in sys.argv and not sys.argv.remove("--all")


class Scene(unittest.TestCase):
    def check(self, materials, *options):
        with tempfile.TemporaryDirectory(prefix="musurf-check-") as folder:
            path = check_scene.write(pathlib.Path(folder) / "scene.json", materials)
            done = subprocess.run([MUSURF, "check", "--json", "--quick", "--n", "0", "--seed", "20261126", *options, str(path)],
                                  stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=3000)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        out = strict(done.stdout)
        self.assertEqual(out["given_materials"], len(materials), done.stderr)
        for law in out["laws"]:
            with self.subTest(law["title"]):
                self.assertNotEqual(law["verdict"], "FAILED", law)
        self.assertEqual(done.returncode, 0)
        return {law["law"]: law for law in out["laws"]}, done.stderr

    def test_few(self):
        laws, said = self.check(check_scene.FEW, "--samples", "5000")
        asked = {name: law["tests"] for name, law in laws.items()}
        # a view each; tables, tail, flakes and folded have normals, walks have means
        self.assertGreaterEqual(asked["VISIBLE_SAMPLER"], 4)
        self.assertGreaterEqual(asked["OWN_SAMPLER"], 2)  # folded, lobe
        self.assertEqual(asked["WALK_ENERGY"], 2)
        self.assertEqual(asked["WALK_RECIPROCITY"], 1)
        self.assertIn("a random walk: f is an estimate", said)
        # the tail's integrals come to 1 as closely as any other's: the table's jumps alone cost digits
        self.assertLess(abs(laws["NORMALISATION"]["error"]), 1e-2)

    def test_tail_is_integrated_to_its_end(self):
        laws, _ = self.check({"tail": check_scene.FEW["tail"]}, "--samples", "1000")
        for name in ("MASKING", "PROJECTED_AREA", "VISIBLE_NORMALS"):
            self.assertLess(laws[name]["tolerance"], 1e-6, name)

    @unittest.skipUnless(ALL, "--all: minutes")
    def test_every(self):
        self.check(check_scene.every())


if __name__ == "__main__":
    sys.exit(unittest.main())
