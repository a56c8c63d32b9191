#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The figures' meshes are what their makers say, their scenes differ in the tension alone, and `scripts/figures` makes pictures of them."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import exr
from command import BUILD, ROOT, musurf, strict

sys.path.insert(0, str(ROOT / "scripts"))
from figuring import pictures, triangle  # noqa: E402
from modelling import balloon, creatures, curves, hammered, make, mesh, teapot, vase, wave  # noqa: E402

FINE = 0.25


def volume(shape):
    """Signed: positive if outside is where corners run counter-clockwise."""
    a, b, c = (shape.points[shape.faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


class Meshes(unittest.TestCase):
    def test_outside_is_outside_and_no_triangle_is_without_area(self):
        shapes = [("vase", vase.vase(FINE)), ("teapot", teapot.teapot(FINE)), ("balloon", balloon.inflated(1, FINE))]
        shapes += [(f"{name} {pose}", shape) for name in creatures.POSES for pose, shape in creatures.posed(name, FINE).items()]
        for name, shape in shapes:
            with self.subTest(name):
                a, b, c = (shape.points[shape.faces[:, k]] for k in range(3))
                self.assertGreater(np.linalg.norm(np.cross(b - a, c - a), axis=1).min(), 1e-9)
                self.assertGreater(volume(shape), 0.005)

    def test_maps_that_keep_volume_do(self):
        """Linear ones to rounding; a twist but for chords of arcs: each sector's triangles turn against one another by much less than 0.1."""
        for name, pose, tolerance in (("bird", "stretched", 1e-12), ("bird", "squashed", 1e-12), ("dog", "elongated", 1e-12), ("dog", "twisted", 0.01)):
            with self.subTest(pose):
                shapes = creatures.posed(name, 0.5)
                self.assertAlmostEqual(volume(shapes[pose]) / volume(shapes["rest"]), 1, delta=tolerance)

    def test_a_tube_is_a_ball_where_its_radius_says_so(self):
        """Along a straight line r^2 = t (1 - t) is a ball of radius 1/2; the curve through its points is that parabola."""
        t = np.linspace(0, 1, 9)
        shape = curves.tube([(x, 0, 0, (x * (1 - x)) ** 0.5) for x in t], rows=64, columns=64)
        np.testing.assert_allclose(np.linalg.norm(shape.points - (0.5, 0, 0), axis=1), 0.5, atol=1e-9)

    def test_files_are_the_same_every_time(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            files = [make.write(folder / name, 0.1) for name in "ab"]
            self.assertEqual(len(files[0]), 2 * 5 + balloon.FRAMES + 4)
            for a, b in zip(*files):
                self.assertEqual(a.read_bytes(), b.read_bytes())
            self.assertEqual(sorted(file.suffix for file in folder.rglob("*") if file.is_file()), sorted([".ply"] * 2 * (len(files[0]) - 2) + [".png"] * 4))


class Map(unittest.TestCase):
    def test_dents_are_of_a_surface(self):
        """That goes on beyond its edges: slopes add up to none along every line around. A sum over texels misses a rim, a step of up to
        twice the steepest slope some 4 texels wide, by less than a fortieth of a texel's share of that: of 8 rims 8 / 40 1.5 / 256."""
        x, y = hammered.slopes(256)
        np.testing.assert_allclose(x.mean(1), 0, atol=2e-3)
        np.testing.assert_allclose(y.mean(0), 0, atol=2e-3)
        self.assertGreater(hammered.picture(32)[..., 2].min(), 200)

    def test_strokes_run_where_they_are_said_to(self):
        """Around the sun; flat on still water's floor. A byte holds a component to 1/255."""
        shown = wave.picture(128).astype(float) / 127.5 - 1
        v, u = np.mgrid[0:128, 0:128]
        u, v = (u + 0.5) / 128, 1 - (v + 0.5) / 128
        away = np.stack([u - 0.77, v - 0.76], -1)
        sun = np.hypot(*np.moveaxis(away, -1, 0)) < 0.12
        np.testing.assert_allclose((shown[..., :2] * away).sum(-1)[sun] / np.hypot(*away[sun].T), 0, atol=2 / 255)
        np.testing.assert_allclose(np.hypot(shown[..., 0], shown[..., 1]), 1, atol=2 / 255)
        self.assertLess(np.abs(shown[-1, :, 1]).max(), 0.06)


class Tension(unittest.TestCase):
    def said(self, *shapes):
        with tempfile.TemporaryDirectory() as folder:
            files = [pathlib.Path(folder) / name for name in ("rest.ply", "deformed.ply")]
            for shape, file in zip(shapes, files):
                mesh.write(shape, file)
            done = musurf("tension", *files, "--json")
        self.assertEqual(done.returncode, 0, done.err)
        return strict(done.out)

    def test_every_triangle_of_every_pose_has_one(self):
        for name in creatures.POSES:
            shapes = creatures.posed(name, FINE)
            for pose, shape in shapes.items():
                summary = self.said(shapes["rest"], shape)["summary"]
                with self.subTest(f"{name} {pose}"):
                    self.assertEqual([summary[key] for key in ("rest_flat", "deformed_flat", "uv_none", "uv_flat", "uv_changed", "uv_mirrored", "inverted",
                                                               "points_without")], [0] * 8)

    def test_a_balloon_stretches_as_it_says(self):
        """Where b = 1, parallels by PARALLELS; meridians by AXIS where r does not change, and up to PARALLELS towards the top. A face's T is
        that of its middle to first order in its size: faces are 1/40 high."""
        rest, full = (balloon.inflated(q, FINE) for q in (0, 1))
        m = np.reshape(self.said(rest, full)["faces"], (-1, 2, 2))
        z = rest.points[rest.faces][:, :, 2].mean(1)
        waist = np.abs(z - 0.62) < 0.03  # of r's largest value
        np.testing.assert_allclose(m[z > 0.4, 0, 0], balloon.PARALLELS, rtol=1e-5)
        np.testing.assert_allclose(m[waist, 1, 1], balloon.AXIS, rtol=0.02)
        self.assertTrue((m[z > 0.4, 1, 1] > balloon.AXIS * (1 - 1e-5)).all())
        np.testing.assert_allclose(m[z < balloon.NECK - 0.02], np.broadcast_to(np.eye(2), m[z < balloon.NECK - 0.02].shape), atol=1e-5)

    def test_it_is_the_paper_s(self):
        """D R^-1 computed apart, of the same floats: rounding of doubles times the condition of R, below 1000 here."""
        shapes = creatures.posed("bird", FINE)
        rest, bowed = (shapes[k].moved(lambda p: p.astype(np.float32).astype(float)) for k in ("rest", "bowed"))
        said = self.said(rest, bowed)["faces"]
        some = range(0, len(said), 97)
        rest, bowed = (mesh.Mesh(s.points, s.uv.astype(np.float32).astype(float), s.faces) for s in (rest, bowed))
        self.assertLess(max(triangle.Pair(rest, bowed, k, np.reshape(said[k], (2, 2))).difference for k in some), 1e-11)


class Scenes(unittest.TestCase):
    def test_rows_differ_in_the_tension_alone(self):
        for name in ("birds", "dogs"):
            plain, tense = (json.loads((ROOT / "scenes" / "figures" / f"{name}{end}.json").read_text()) for end in ("", "-tension"))
            deformed = [item for item in tense["objects"] if item.pop("tension", None)]
            self.assertEqual(len(deformed), len([item for item in tense["objects"] if item.get("mesh", "rest") != "rest"]))
            plain.pop("description")
            tense.pop("description")
            self.assertEqual(plain, tense)


class Pictures(unittest.TestCase):
    def test_quick_figures(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, str(ROOT / "scripts" / "figures"), "--quick", "-o", folder], capture_output=True, text=True,
                                  env=dict(os.environ, BUILD=str(BUILD)))
            self.assertEqual(done.returncode, 0, done.stderr)
            folder = pathlib.Path(folder)
            for name in ("figure6.png", "figure7.png", "figure8.png", "balloon.png", "balloon.gif"):
                with pictures.Image.open(folder / name) as image:
                    image.load()
                    self.assertGreaterEqual(image.width, 64)
            told = json.loads((folder / "figures.json").read_text())
            self.assertEqual((folder / "fragment.html").read_text().count("<img "), 4)
            plain, tense = (exr.read(folder / f"birds{end}.exr")[1]["G"] for end in ("", "-tension"))
            self.assertEqual(len(list((folder / "balloon").glob("*.exr"))), 3)
            self.assertEqual(len(list((folder / "vase").glob("*.exr"))), 6)
        self.assertLess(told["figure7"]["largest_difference"], 1e-11)
        # the same random numbers: birds at rest, at both ends of the row, are the same but for light from the others; those between are not
        apart = np.abs(plain - tense) / plain.mean()
        ends = np.concatenate([apart[:, :plain.shape[1] // 7], apart[:, -plain.shape[1] // 7:]], 1).mean()
        self.assertLess(10 * ends, apart[:, plain.shape[1] // 4:-plain.shape[1] // 4].mean())


if __name__ == "__main__":
    sys.exit(unittest.main())
