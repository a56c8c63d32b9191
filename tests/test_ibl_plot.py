#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf ibl plot`: an SVG whose points stand where `musurf ibl axis` says, seen by the projections the file's charter names."""
import json
import math
import pathlib
import tempfile
import unittest
import xml.etree.ElementTree

from command import answers, musurf

SVG = "{http://www.w3.org/2000/svg}"
SIDE, OUTSIDE = 360, 1.15  # pixels of a panel; how far the sphere's panels reach
ASK = {"sigma": [0.3, 0.1], "angle": 0.5, "wo": [0.8, 0, 0.3], "N": 6}


def slopes(m, ask):
    reach = 1.6 * max(ask["sigma"])
    return [-m[0] / m[2] / reach, -m[1] / m[2] / reach]


def equal_area(w):
    r, flat = math.sqrt(1 - w[2]) / OUTSIDE, math.hypot(w[0], w[1])
    return [r * w[0] / flat, r * w[1] / flat] if flat else [0, 0]


def reflected(m, ask):
    length = math.hypot(*ask["wo"])
    o = [c / length for c in ask["wo"]]
    return [2 * sum(a * b for a, b in zip(m, o)) * c - d for c, d in zip(m, o)]


class Plot(unittest.TestCase):
    def panels(self, ask):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "lobe.svg")
            done = musurf("ibl", "plot", "-o", file, stdin=[ask])
            self.assertEqual((done.returncode, done.out, done.err), (0, "", ""))
            self.assertNotRegex(file.read_text(), r"(?i)\bnan\b|\binf\b")
            return xml.etree.ElementTree.parse(file).getroot().findall(SVG + "svg")

    def test_many_samples(self):
        """256 of 65536, from the first to the last."""
        dots = [[circle for circle in panel.iter(SVG + "circle") if circle.get("fill") == "#27c"] for panel in self.panels({**ASK, "N": 65536})]
        few = [[circle for circle in panel.iter(SVG + "circle") if circle.get("fill") == "#27c"] for panel in self.panels({**ASK, "N": 256})]
        for many, some in zip(dots, few):
            self.assertEqual((len(many), len(some)), (256, 256))
            for end in (0, -1):
                self.assertAlmostEqual(float(many[end].get("cx")), float(some[end].get("cx")), delta=0.011)

    def test_points_stand_where_the_axis_says(self):
        panels = self.panels(ASK)
        axis = answers(musurf("ibl", "axis", stdin=[ASK]))[0]
        self.assertEqual(len(panels), 3)
        for number, panel in enumerate(panels):
            seen = [(lambda m: slopes(m, ASK)), equal_area, (lambda m: equal_area(reflected(m, ASK)))][number]
            for key, fill, count in (("far", "#d50", 2), ("near", "#094", 2), ("samples", "#27c", 6)):
                dots = [(float(dot.get("cx")), float(dot.get("cy"))) for dot in panel.iter(SVG + "circle") if dot.get("fill") == fill]
                self.assertEqual(len(dots), count, key)
                for dot, micronormal in zip(dots, axis[key]):
                    x, y = seen(micronormal)
                    self.assertAlmostEqual(dot[0], SIDE / 2 * (1 + x), delta=0.006)  # written in hundredths of a pixel
                    self.assertAlmostEqual(dot[1], SIDE / 2 * (1 - y), delta=0.006)
            steps = [path for path in panel.iter(SVG + "path") if path.get("fill").startswith("rgb")]
            self.assertEqual(len(steps), 16)
        discs = [path for path in panels[2].iter(SVG + "path") if path.get("stroke") == "#27c"]
        self.assertEqual(len(discs), 6)

    def test_density_is_that_of_ggx(self):
        """The densest cells of the slopes' panel are around the middle; the lobe's outline has the axes of Sigma."""
        dark = [path for path in self.panels({"sigma": [0.3, 0.1], "wo": [0, 0, 1]})[0].iter(SVG + "path")
                if path.get("fill").startswith("rgb")]
        for step in (8, 12):
            cells = [[int(n) for n in run.replace("h", " ").replace("v", " ").split()[:3]] for run in dark[step - 1].get("d").split("M")[1:]]
            wide = max(width for _, _, width in cells)
            tall = 3 * len(cells)
            # P22 falls to f² of its peak where 1 + x²/2 sigma² = 1/f; the panel's half is 0.48, cells are of 3 pixels
            level = (step - 0.5) / 16
            for size, sigma in ((wide, 0.3), (tall, 0.1)):
                self.assertAlmostEqual(size / 2, SIDE / 2 / 0.48 * sigma * math.sqrt(2 / level - 2), delta=3.01)

    def test_what_has_no_density(self):
        for ask in ({"sigma": [0, 0], "wo": [0.3, 0, 0.7]}, {"sigma": [0.3, 0.1], "wo": [1, 0, 0]}, {"sigma": [1e200, 1e-200], "wo": [1, 0, 1]}):
            self.assertEqual(len(self.panels(ask)), 3)

    def test_refusals(self):
        self.assertEqual(musurf("ibl", "plot", stdin=[ASK]).returncode, 2)
        self.assertEqual(musurf("ibl", "plot", "-o", "/nowhere/x.svg", stdin=[ASK]).returncode, 2)
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "lobe.svg")
            done = musurf("ibl", "plot", "-o", file, stdin=json.dumps({**ASK, "N": 0}))
            self.assertEqual((done.returncode, file.exists()), (2, False))
            self.assertIn("$.N", done.err)
            file.write_text(json.dumps(ASK))
            done = musurf("ibl", "plot", file, "-o", file)
            self.assertEqual((done.returncode, file.read_text()), (2, json.dumps(ASK)))
            self.assertIn("would replace", done.err)


if __name__ == "__main__":
    unittest.main()
