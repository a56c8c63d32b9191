#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf surface boxes` and `soup` against pencil and paper.

Shares are exact but for rounding and slivers (at most 512 of 1e-14 of a triangle each): 1e-11.
"""
import itertools
import json
import sys
import unittest

import numpy as np

from command import musurf, strict
from test_surface_command import MAPS, Folder, numbers, write_exr

from crosscheck import heightfield, maps, masking  # noqa: E402

EXACT = 1e-11


def ask(command, views, *more):
    done = musurf("surface", command, *more, *[f"--view={numbers(v)}" for v in views])
    assert (done.returncode, done.err) == (0, ""), done.err
    return strict(done.out)


def part(answer, name, what="G1"):
    """A list of shares over the triangles of one part, by area."""
    facets = [f for f in answer["facets"] if f["part"].startswith(name)]
    area = np.array([f["area"] for f in facets])
    return area @ np.array([f[what] for f in facets]) / area.sum()


class Wave(unittest.TestCase):
    """Ridges from 0 to W and a gap of g = P - W, height H, top moved by S along x; views v = (t, s, 1).

    In coordinates that lean with the ridge, x - S z/H, it stands upright and a ray climbs by r = t - S/H sideways per
    unit of height. So a ridge's shadow on the ground is |r| H wide, on its left if r > 0 (the next one is in the way) and
    on its right if r < 0, however much it hangs over, whatever s; and of the side that faces v, the rising one if r < 0,
    the falling one if r > 0, all is seen if the ray leaves the gap, |r| (H - z) < g: the upper g / |r| of it. Tops lie
    open. Two views see what both see: shadows on different sides add up, on the same side the wider one counts.
    Turned upside down the ground is the top, and the top a floor of width W in pits; there r = t + S/H.
    """
    VIEWS = [np.array(v) for v in ([0.0, 0, 1], [0.3, 0, 1], [-0.6, 0.9, 1], [1.7, -2, 1], [-5.0, 0, 1], [40.0, 3, 1])]

    def expected(self, r, height, wide):
        """Floor, rising side, falling side: a list per view; then the same of pairs."""
        shadow = np.minimum(1, abs(r) * height / wide)
        with np.errstate(divide="ignore"):
            side = np.minimum(1, wide / (abs(r) * height))
        single = 1 - shadow, np.where(r < 0, side, 0), np.where(r > 0, side, 0)
        pairs = [[], [], []]
        for a, b in itertools.combinations(range(len(r)), 2):
            together = shadow[a] + shadow[b] if r[a] * r[b] < 0 else max(shadow[a], shadow[b])
            pairs[0].append(max(0, 1 - together))
            for k in (1, 2):
                pairs[k].append(min(single[k][a], single[k][b]))
        return single, pairs

    def test_closed_forms(self):
        t = np.array([v[0] for v in self.VIEWS])
        for period, width, height, slant in [(2, 1, 1, 0), (2, 1, 0.5, 0.25), (3, 0.7, 1.3, -2.2), (1, 0.9, 4, 0.05),
                                             (2, 1, 1, 5)]:
            options = [f"--period={period}", f"--width={width}", f"--height={height}", f"--slant={slant}"]
            for over in (False, True):
                answer = ask("boxes", self.VIEWS, *options, *(["--turn-over"] if over else []))
                r = t + slant / height if over else t - slant / height
                floor, top = ("top", "ground") if over else ("ground", "top")
                # turned over, the rising side stands at the pit's left, and looks to the right
                names = (floor, "falling", "rising") if over else (floor, "rising", "falling")
                single, pairs = self.expected(r, height, width if over else period - width)
                with self.subTest(options=options, over=over):
                    np.testing.assert_allclose(part(answer, top), 1, atol=EXACT)
                    np.testing.assert_allclose(part(answer, top, "G2"), 1, atol=EXACT)
                    for name, one, two in zip(names, single, pairs):
                        np.testing.assert_allclose(part(answer, name), one, atol=EXACT)
                        np.testing.assert_allclose(part(answer, name, "G2"), two, atol=EXACT)
                    for view in answer["views"]:
                        self.assertAlmostEqual(view["projected_area"], 1, delta=EXACT)

    def test_correlated(self):
        """The example below Eq. (12c): of m = n both G1 are 1/2, G1 G1 = 1/4, but both see the same tops: G2 = 1/2.

        At finite angles: G1 = 1 - |t| H/P while the shadow is shorter than the gap, and G2 = 1 - 2 |t| H/P, at least 1/2."""
        for t in (0.1, 0.4, 0.5, 0.8, 1, 3, 100):
            level, = [n for n in ask("boxes", [[t, 0, 1], [-t, 0, 1]])["normals"] if n["normal"] == [0, 0, 1]]
            g1, g2 = 1 - min(t, 1) / 2, max(0.5, 1 - t)
            np.testing.assert_allclose(level["G1"], g1, atol=EXACT)
            np.testing.assert_allclose(level["G2"], g2, atol=EXACT)
            self.assertEqual((level["area"], level["D"]), (2, 1))
            if t >= 1:
                self.assertAlmostEqual(level["G1"][0] * level["G1"][1], 0.25, delta=EXACT)
                self.assertAlmostEqual(level["G2"][0], 0.5, delta=EXACT)
        # the same direction twice is no further restriction: G2(v, m, v) = G1(v, m), Eq. (12b)
        for n in ask("boxes", [[3, 1, 1], [3, 1, 1]], "--slant=0.4")["normals"]:
            np.testing.assert_allclose(n["G2"], n["G1"][0], atol=EXACT)

    def test_transformed(self):
        """M = diag(a, 1) makes a wave of a P, a W, a S. Heights stay, and so the level facets' area per macro area, 1;
        the sides are H long (upright) on a period of a P. A mirror, a < 0, swaps left and right."""
        for a in (0.2, 3, -1.5):
            for slant in (0, 1.1):
                answer = ask("boxes", self.VIEWS, f"--transform={a},0,0,1", f"--slant={slant}", "--height=0.8")
                r = np.array([v[0] for v in self.VIEWS]) - a * slant / 0.8
                single, pairs = self.expected(r, 0.8, abs(a))
                sides = ("rising", "falling") if a > 0 else ("falling", "rising")
                for name, one, two in zip(("ground", *sides), single, pairs):
                    np.testing.assert_allclose(part(answer, name), one, atol=EXACT)
                    np.testing.assert_allclose(part(answer, name, "G2"), two, atol=EXACT)
                density = {tuple(np.round(n["normal"], 9)): n["D"] for n in answer["normals"]}
                side = np.array([0.8, -a * slant]) * np.sign(a)
                up = tuple(np.round([*(side / np.hypot(*side))], 9))
                self.assertAlmostEqual(density[(0, 0, 1)], 1, delta=EXACT)
                self.assertAlmostEqual(density[(up[0], 0, up[1])], np.hypot(0.8, a * slant) / (2 * abs(a)), delta=EXACT)
        # A skew along the ridges and a turn change no cross section but turn what is "across".
        turn = maps.rotation(0.8) @ np.array([[1.0, 0.0], [1.7, 1.0]])
        answer = ask("boxes", [maps.carried(turn, v) for v in self.VIEWS], f"--transform={numbers(turn)}", "--slant=0.5")
        single, _ = self.expected(np.array([v[0] for v in self.VIEWS]) - 0.5, 1, 1)
        for name, one in zip(("ground", "rising", "falling"), single):
            np.testing.assert_allclose(part(answer, name), one, atol=EXACT)


class Box(unittest.TestCase):
    """A box's shadow on the ground is its foot swept by the top's way, (a, b) = (S - t H): a hexagon of the area
    W^2 + W (|a| + |b|), of which the foot is no ground. While |a|, |b| < P - W it meets no other box, and the sides that
    face the view lie open. Shadows to opposite quadrants share nothing but the foot. This holds for any slant."""

    def test_shadows(self):
        period, width, height = 2.5, 0.9, 0.7
        ground = period**2 - width**2
        for slant in ([0, 0], [0.5, -0.3], [-0.9, 0.2]):
            views = [[0, 0, 1], [0.9, 0, 1], [0.4, 1.1, 1], [-0.3, -0.8, 1], [-0.5, 0.6, 1]]
            vectors = np.array([[slant[k] - v[k] * height for k in range(2)] for v in views])
            self.assertLess(abs(vectors).max(), period - width)
            options = ["--shape=box", f"--period={period}", f"--width={width}", f"--height={height}",
                       f"--slant={slant[0]},{slant[1]}"]
            areas = width * abs(vectors).sum(1)
            for m in (np.eye(2), *MAPS.values()):
                answer = ask("boxes", [maps.carried(m, np.array(v)) for v in views], *options, f"--transform={numbers(m)}")
                # M of condition 100 magnifies rounding as much
                np.testing.assert_allclose(part(answer, "ground"), 1 - areas / ground, atol=100 * EXACT)
                np.testing.assert_allclose(part(answer, "top"), 1, atol=100 * EXACT)
                for name, sign in (("side x low", vectors[:, 0]), ("side x high", -vectors[:, 0]),
                                   ("side y low", vectors[:, 1]), ("side y high", -vectors[:, 1])):
                    np.testing.assert_allclose(part(answer, name), sign > 1e-12, atol=100 * EXACT)
                for k, (a, b) in enumerate(itertools.combinations(range(len(views)), 2)):
                    if (vectors[a] * vectors[b] <= 0).all():
                        both = 1 - (areas[a] + areas[b]) / ground
                        self.assertAlmostEqual(part(answer, "ground", "G2")[k], both, delta=100 * EXACT)
                for view in answer["views"]:
                    self.assertAlmostEqual(view["projected_area"], 1, delta=100 * EXACT)

    def test_sinking_view(self):
        """Along x the strips of ground between boxes, W wide, are in shadow up to the next box; the others never."""
        for t in (0.5, 1, 2, 30):
            answer = ask("boxes", [[t, 0, 1]], "--shape=box", "--period=3", "--width=1.2", "--height=1.1")
            self.assertAlmostEqual(part(answer, "ground")[0], 1 - 1.2 * min(1.8, 1.1 * t) / (9 - 1.44), delta=EXACT)
            self.assertAlmostEqual(part(answer, "side x high")[0], min(1, 1.8 / (1.1 * t)), delta=EXACT)


class Soup(Folder):
    def test_files(self):
        """A level triangle over another, as OBJ and as JSON: along (1/2, 0, 1) the shadow is moved by half a unit and
        leaves 1 - (1/2)^2; along (-1/2, 0, 1) as well, and the two shadows touch in a point only: 1/2 for both. A roof of
        a square (one face of four corners) over a floor twice as long: 3/4 is seen from above."""
        obj, js, roof = self.folder / "a.obj", self.folder / "a.json", self.folder / "b.obj"
        obj.write_text("# two\nv 0 0 0\nv 1 0 0\nv 0 1 0\n\nvn 0 0 1\ng upper\nv 0 0 1\nv 1 0 1\nv 0 1 1 # no w\n"
                       "f 1//1 2//1 3//1\nusemtl x\nf -3/1/2 -2/1 -1\n")
        js.write_text(json.dumps({"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]],
                                  "triangles": [[0, 1, 2], [3, 4, 5]]}))
        views = [[0, 0, 1], [0.5, 0, 1], [-0.5, 0, 1], [1, 0, 1]]
        answers = [ask("soup", views, file) for file in (obj, js)]
        self.assertEqual(*answers)
        lower, upper = answers[0]["facets"]
        np.testing.assert_allclose(lower["G1"], [0, 0.75, 0.75, 1], atol=EXACT)
        np.testing.assert_allclose(upper["G1"] + upper["G2"], 1, atol=EXACT)
        self.assertAlmostEqual(lower["G2"][3], 0.5, delta=EXACT)  # of the second and third view
        self.assertIsNone(answers[0]["views"][0]["projected_area"])
        self.assertNotIn("period", answers[0])
        roof.write_text("v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 5 6 7 8\n")
        facets = ask("soup", [[0, 0, 1], [1, 1, 1]], roof)["facets"]
        floor = sum(np.array(f["G1"]) * f["area"] for f in facets[:2]) / 4
        np.testing.assert_allclose(floor, [0.75, 1], atol=EXACT)
        facets = ask("soup", [[0, 0, 1], [1.5, 0, 1]], roof, "--period=2,0,0,2")["facets"]
        # moved by 1.5 the roof's shadow wraps round the period: still one of its area of 1 on 4
        np.testing.assert_allclose(sum(np.array(f["G1"]) * f["area"] for f in facets[:2]) / 4, 0.75, atol=EXACT)

    def test_loose_facets_are_invariant(self):
        """Eq. (11) holds for a salad, too: no neighbours are needed, only lines that stay lines."""
        rng = np.random.default_rng(5)
        corners = rng.uniform(0, 1, (12, 3, 3)) + rng.uniform(0, 2, (12, 1, 3))
        file = self.folder / "salad.json"
        file.write_text(json.dumps({"vertices": corners.reshape(-1, 3).tolist(), "period": [[2.5, 0.3], [-0.4, 2.1]],
                                    "triangles": np.arange(36).reshape(-1, 3).tolist()}))
        views = [maps.direction(35, 10), maps.direction(60, 130)]
        first = ask("soup", views, file)["facets"]
        self.assertGreater(sum(0 < f["G1"][0] < 1 for f in first), 2)
        for name, m in MAPS.items():
            moved = ask("soup", [maps.carried(m, v) for v in views], file, f"--transform={numbers(m)}")["facets"]
            with self.subTest(map=name):
                for a, b in zip(first, moved):
                    np.testing.assert_allclose(a["G1"] + a["G2"], b["G1"] + b["G2"], atol=1e-9)

    def test_heightfield_as_soup(self):
        """Exact shares of a heightfield's facets: cos/sigma as a whole to rounding, and those of 225 points a facet of
        `measure` to what a grid of 15 x 15 leaves: where a border of a shadow cuts a facet, at most some 30 of its points
        are next to it, 2 sqrt(30)/225 = 0.05 of a facet at random, on 32 facets 0.01."""
        h = heightfield.make(4, 0.9, 1.2, 2).astype(np.float32).astype(float)
        exr, js = self.folder / "h.exr", self.folder / "h.json"
        write_exr(exr, h)
        vertices, triangles = [], []
        for i, j in itertools.product(range(4), range(4)):
            for corners in (((0, 0), (1, 0), (0, 1)), ((1, 1), (0, 1), (1, 0))):
                triangles.append([len(vertices) + k for k in range(3)])
                vertices += [[i + a, j + b, h[(i + a) % 4, (j + b) % 4]] for a, b in corners]
        js.write_text(json.dumps({"vertices": vertices, "triangles": triangles, "period": [[4, 0], [0, 4]]}))
        views = [maps.direction(65, 40), maps.direction(80, 200)]
        exact = ask("soup", views, js)["views"]
        sampled = ask("measure", views, exr, "--subsamples=225")["views"]
        for v, a, b in zip(views, exact, sampled):
            self.assertAlmostEqual(a["projected_area"], 1, delta=EXACT)
            self.assertAlmostEqual(a["G1_projected"], v[2] / masking.sigma(heightfield.slopes(h), v), delta=EXACT)
            self.assertAlmostEqual(a["G1_projected"], b["G1_projected"], delta=0.01)

    def refused(self, command, words, *arguments):
        done = musurf("surface", command, *arguments)
        with self.subTest(arguments=arguments):
            self.assertEqual((done.returncode, done.out), (2, ""))
            self.assertRegex(done.err, rf"^musurf surface {command}: [^\n]*\n$")
            self.assertIn(words, done.err)

    def test_refusals(self):
        view, file = "--view=0,0,1", self.folder / "a"
        for words, *arguments in [("--view is needed",), ("below the period", view, "--width=2"), ("no option", view, "x"),
                                  ("has no --depth", view, "--shape=box", "--depth=1"), ("one number", view, "--slant=1,2"),
                                  ("above 0", view, "--height=0"), ("known: wave, box", view, "--shape=ball"),
                                  ("singular", view, "--transform=1,1,1,1"), ("z > 0", "--view=1,0,0")]:
            self.refused("boxes", words, *arguments)
        self.refused("soup", "FILE of triangles", view)
        self.refused("soup", "No such file", view, self.folder / "none")
        for text, words in [("", "has no triangle"), ("v 1 2\n", "a:1: a vertex needs three numbers"),
                            ("v 0 0 nan\n", "three numbers"), ("v 0 0 0\nf 1 1 2\n", "a:2: a face names a vertex"),
                            ("v 0 0 0\nv 1 0 0\nf 1 2\n", "three corners"), ("l 1 2\n", "neither v nor f"),
                            ("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "triangle 0 has no area"),
                            ('{"vertices": []}', "a list of triangles"), ('{"triangle": []}', '"triangle'),
                            ('{"vertices": [[0, 0]], "triangles": []}', "3 numbers"),
                            ('{"vertices": [[0, 0, 0]], "triangles": [[0, 0, 1]]}', "$.triangles[0][2]"),
                            ('{"vertices": [], "triangles": [], "period": [[1, 0], [2, 0]]}', "span no area"),
                            ('{"vertices": [', "a:1")]:
            file.write_text(text)
            self.refused("soup", words, view, file)
        file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.refused("soup", "span no area", view, file, "--period=1,1,2,2")
        self.refused("soup", "--view is needed", file)


if __name__ == "__main__":
    sys.exit(unittest.main())
