#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf wedge`: each cell of the sheet is, bit for bit, what `musurf render` makes of the scene with those values; captions
can be read; what cannot be meant is refused before anything is rendered."""
import copy
import json
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import numpy as np

import exr
from command import MUSURF, musurf

SCENE = {"musurf": 1, "camera": {"type": "perspective", "position": [0, -4, 1.5], "target": [0, 0, 0.5], "fov": 35},
         "film": {"width": 96, "height": 64, "pixels": "float"}, "integrator": {"samples": 4, "depth": 3},
         "materials": {"ball": {"material": "musurf.microfacet", "ndf": "gtr", "alpha": 0.1, "gamma": 1.5},
                       "floor": {"material": "musurf.microfacet", "ndf": "ggx", "alpha": 0.3}},
         "objects": [{"shape": "sphere", "radius": 0.5, "material": "ball", "transform": [{"translate": [0, 0, 0.5]}]},
                     {"shape": "rectangle", "size": [4, 4], "material": "floor"}],
         "lights": [{"type": "studio"}]}
GAP, LINE = 4, 13


class Wedge(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(self.enterContext(tempfile.TemporaryDirectory()))
        self.scene = self.folder / "scene.json"
        self.scene.write_text(json.dumps(SCENE, indent=1))

    def wedge(self, *arguments):
        return musurf("wedge", self.scene, *arguments)

    def pixels(self, name):
        image = exr.read(self.folder / name)[1]
        return np.stack([image[c] for c in "RGB"], -1)

    def rendered(self, change):
        scene = copy.deepcopy(SCENE)
        change(scene)
        (self.folder / "one.json").write_text(json.dumps(scene))
        done = musurf("render", self.folder / "one.json", "-o", self.folder / "one.exr", "--quiet")
        self.assertEqual(done.returncode, 0, done.err)
        return self.pixels("one.exr")

    def test_cells_are_renders(self):
        done = self.wedge("--vary", "ball.alpha=.1:0.4:.8,gamma=1:3", "-o", self.folder / "sheet.exr", "--cells",
                          self.folder / "cells", "--png", self.folder / "sheet.png")
        self.assertEqual(done.returncode, 0, done.err)
        sheet = self.pixels("sheet.exr")
        self.assertEqual(sheet.shape, (2 * (64 + 2 * LINE + 2 * GAP) + GAP, 3 * (96 + GAP) + GAP, 3))
        self.assertTrue((self.folder / "sheet.png").read_bytes().startswith(b"\x89PNG"))
        for column, alpha in enumerate((0.1, 0.4, 0.8)):
            for row, gamma in enumerate((1, 3)):
                expected = self.rendered(lambda s: s["materials"]["ball"].update(alpha=alpha, gamma=gamma))
                x, y = GAP + column * (96 + GAP), GAP + row * (64 + 2 * LINE + 2 * GAP)
                np.testing.assert_array_equal(sheet[y:y + 64, x:x + 96], expected)
                np.testing.assert_array_equal(self.pixels(f"cells/{row * 3 + column + 1:04}.exr"), expected)
                caption = sheet[y + 64 + GAP:y + 64 + GAP + 2 * LINE, x:x + 96]
                self.assertEqual(set(np.unique(caption)), {0, 1})
        first = [sheet[GAP + 64 + GAP:][:LINE, GAP + k * (96 + GAP):][:, :96] for k in range(3)]
        self.assertFalse((first[0] == first[1]).all() or (first[1] == first[2]).all())

    def test_paths_words_and_ranges(self):
        done = self.wedge("--vary", "floor.ndf=ggx:beckmann", "--vary", "$.lights[0].rotation=0..120/3", "--vary",
                          "floor.transform=[[1,0],[0,1]]:[[3,0],[0,1]]", "--spp", 1, "--cells", self.folder / "c")
        self.assertEqual(done.returncode, 0, done.err)
        self.assertEqual(len(list((self.folder / "c").iterdir())), 12)

        def last(scene):
            scene["materials"]["floor"].update(ndf="beckmann", transform=[[3, 0], [0, 1]])
            scene["lights"][0]["rotation"] = 120
            scene["integrator"]["samples"] = 1
        np.testing.assert_array_equal(self.pixels("c/0012.exr"), self.rendered(last))

    def test_one_name_makes_a_square(self):
        done = self.wedge("--vary", "gamma=1:2:3:4", "--spp", 1, "--size", "8x8", "-o", self.folder / "s.exr")
        self.assertEqual(done.returncode, 0, done.err)
        self.assertEqual(self.pixels("s.exr").shape[1], 2 * (8 + GAP) + GAP)

    def test_refused_before_rendering(self):
        out = ("-o", self.folder / "s.exr")
        for vary, words in (("alpha=.1:.2", ("whose alpha", "materials.ball", "MATERIAL.alpha")),
                            ("gamma=1:-2", ("scene.json", "$.materials.ball.gamma", "-2")),
                            ("gama=1:2", ("gama",)),
                            ("gamma", ("NAME=VALUE",)), ("gamma=", ("gamma", "NAME=VALUE")),
                            ("gamma=1::2", ("gamma",)), ("gamma=1..2/1", ("A..B/N",)),
                            ("gamma=1,gamma=2", ("varies twice",)),
                            ("gamma=1,ball.gamma=2", ("the same", "$.materials.ball.gamma")),
                            ("$.lights[7].rotation=1", ("has no $.lights[7], for $.lights[7].rotation",)), ("ball.alpha.x=1", ("has no $.materials.ball.alpha.x",)), ("$.=1", ("no path",)),
                            ("$.film[=1", ("no path",)), ("ball.alpha=" + ":".join(["1"] * 1025), ("1024",)),
                            ("ball.alpha=0..1/40,gamma=1..2/40", ("1024 cells",)),
                            ("$.film.width=8:16", ("one size",)),
                            ("none.alpha=1", ("materials.none",))):
            with self.subTest(vary=vary[:40]):
                done = self.wedge("--vary", vary, *out)
                self.assertEqual(done.returncode, 2, done.err)
                lines = [line for line in done.err.splitlines() if "warning" not in line]
                self.assertEqual(len(lines), 1, done.err)
                for word in words:
                    self.assertIn(word, lines[0])
                self.assertFalse((self.folder / "s.exr").exists())
        for arguments in ((), ("--vary", "gamma=1"), ("--vary", "gamma=1", "-o", "/nowhere/s.exr"),
                          ("--vary", "gamma=1", "--cells", self.scene), (self.scene, "--vary", "gamma=1")):
            self.assertEqual(self.wedge(*arguments).returncode, 2)
        self.scene.write_text(json.dumps(dict(SCENE, integrator={"by": "lobe"}, lights=[{"type": "directional", "direction": [0, 0, -1]}])))
        done = self.wedge("--vary", "gamma=1:2", *out)
        self.assertEqual((done.returncode, done.err.count("\n")), (2, 1), done.err)
        self.assertIn("only --integrator path renders it", done.err)
        sky = self.folder / "0002.exr"
        for arguments, words in ((("-o", self.folder / "s.png"), "ends in .exr"), (("--png", self.scene), "ends in .png"),
                                 (("-o", sky), "of which the scene is made"), (("--cells", self.folder), "of which the scene is made")):
            self.scene.write_text(json.dumps(dict(SCENE, lights=[{"type": "environment", "image": sky.name}])))
            exr.write(sky, {c: np.ones((2, 4)) for c in "RGB"})
            before = sky.read_bytes(), self.scene.read_text()
            done = self.wedge("--vary", "gamma=1:2", *arguments)
            self.assertEqual((done.returncode, done.err.count("\n")), (2, 1), done.err)
            self.assertIn(words, done.err)
            self.assertEqual((sky.read_bytes(), self.scene.read_text()), before)

    def test_examples_of_the_help(self):
        """They are of a scene that is here, and mean something in it."""
        root = pathlib.Path(__file__).resolve().parent.parent
        examples = [line.split()[1:] for line in musurf("wedge", "--help").out.splitlines() if line.startswith("  musurf wedge ")]
        self.assertEqual(len(examples), 2)
        for _, scene, flag, vary, *_ in examples:
            self.assertEqual(flag, "--vary")
            done = musurf("wedge", root / scene, flag, vary.strip("'"), "-o", self.folder / "s.exr", "--size", "4x4", "--spp", 1, "--quiet")
            self.assertEqual(done.returncode, 0, done.err)

    def test_interrupted(self):
        with subprocess.Popen([MUSURF, "wedge", self.scene, "--vary", "gamma=1..2/9", "--spp", "100000", "--cells",
                               self.folder / "c", "-o", self.folder / "s.exr"], stderr=subprocess.PIPE) as running:
            time.sleep(1)
            running.terminate()
            message = running.communicate(timeout=60)[1].decode()
        self.assertEqual(running.returncode, 130)
        self.assertIn("interrupted after 0 of 9 cells", message)
        self.assertEqual([f.name for f in self.folder.iterdir() if f.name.startswith(("s.", ".musurf"))], [])


if __name__ == "__main__":
    sys.exit(unittest.main())
