#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What scripts/efficiency stands on: the knot is a closed tube seen from outside, the scene's switch turns light sampling off
and changes no mean, noise is measured as it says, and the samples for a level are read off the power law it claims.
"""
import json
import pathlib
import sys
import tempfile
import unittest

import numpy as np

from command import MUSURF, ROOT, musurf

sys.path.insert(0, str(ROOT / "scripts"))
from sampling import furnace, knot, noise, rendering  # noqa: E402


class Knot(unittest.TestCase):
    def test_closes_and_faces_outwards(self):
        vertices, triangles = knot.mesh(240, 24)
        grid = vertices.reshape(241, 25, 8)
        self.assertLess(np.abs(grid[0, :, :6] - grid[-1, :, :6]).max(), 1e-9)  # the same but for u
        self.assertLess(np.abs(grid[:, 0, :6] - grid[:, -1, :6]).max(), 1e-9)
        p, n = vertices[triangles][..., :3], vertices[triangles][..., 3:6].mean(1)
        facing = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
        self.assertTrue(((facing * n).sum(-1) > 0).all())
        # a closed oriented surface: the vectors of area sum to 0, and the divergence theorem gives a tube's volume, the
        # length of its axis times the polygon's area (Pappus; exact for a tube as the step along it shrinks: 1 %)
        self.assertLess(np.abs(facing.sum(0)).max(), 1e-9)
        volume = (p[:, 0] * facing).sum() / 6
        axis = knot.curve(np.linspace(0, 2 * np.pi, 100001))
        length = np.linalg.norm(np.diff(axis, axis=0), axis=1).sum()
        self.assertAlmostEqual(volume / (length * 12 * np.sin(2 * np.pi / 24) * knot.TUBE**2), 1, delta=0.01)


class Rendering(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="musurf-efficiency-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.mesh = knot.write(self.folder / "knot.ply", 120, 16)

    def noise_of(self, sampler, lit, right):
        description = rendering.scene(self.mesh, (32, 24), rendering.material(1, 0, sampler), lit)
        picture, inside, _, _ = rendering.render(MUSURF, description, self.folder, 16, 7)
        return noise.errors(picture, *right[:1], inside, right[1])[0], (picture - right[0])[inside].mean(), inside

    def test_light_sampling_matters_to_noise_alone(self):
        """Without it noise is above 2.5 times that with it (about 10 here); the mean moves by less than 6 standard errors."""
        right = rendering.reference(MUSURF, self.mesh, (32, 24), 1, 0, 256, self.folder)
        found = {lit: self.noise_of("visible", lit, right) for lit in (True, False)}
        self.assertGreater(found[False][0], 2.5 * found[True][0])
        for level, gap, inside in found.values():
            self.assertLess(abs(gap), 6 * np.sqrt((level + right[1][inside].mean()) / inside.sum()))

    def test_candidates_lower_noise_and_move_no_mean(self):
        """A shadow ray of four candidates: less noise than of one (about half here), the mean within 6 standard errors; and
        numbers that are no squares are refused."""
        right = rendering.reference(MUSURF, self.mesh, (32, 24), 1, 0.75, 256, self.folder)
        found = {}
        for candidates in (1, 4, 9):
            description = rendering.scene(self.mesh, (32, 24), rendering.material(1, 0.75, "visible"), True, candidates)
            picture, inside, _, _ = rendering.render(MUSURF, description, self.folder, 16, 7)
            found[candidates] = noise.errors(picture, *right[:1], inside, right[1])[0]
            gap = (picture - right[0])[inside].mean()
            self.assertLess(abs(gap), 6 * np.sqrt((max(found[candidates], 0) + right[1][inside].mean()) / inside.sum()))
        self.assertLess(found[4], 0.8 * found[1])
        self.assertLess(found[9], found[1])
        path = self.folder / "wrong.json"
        path.write_text(json.dumps(rendering.scene(self.mesh, (8, 6), rendering.material(1, 0, "visible"), True, 5)))
        done = musurf("render", path, "-o", self.folder / "x.exr")
        self.assertEqual(done.returncode, 2)
        self.assertIn("light_candidates: is 5; 1, 4, 9 or 16", done.err)

    def test_the_renderer_chooses_as_auto_does(self):
        """What it chooses without being told is what "auto" is, to the bit; and a sampler that is named stays."""
        pictures = {}
        for sampler in (None, "auto", "visible"):
            description = rendering.scene(self.mesh, (8, 6), rendering.material(0.1, 0, sampler))
            pictures[sampler] = rendering.render(MUSURF, description, self.folder, 4, 1)[0]
            self.assertEqual(rendering.chosen(MUSURF, description, self.folder), "visible" if sampler == "visible" else "folded_uniform")
        self.assertTrue((pictures[None] == pictures["auto"]).all())
        self.assertFalse((pictures[None] == pictures["visible"]).all())

    def test_the_switch_is_a_flag(self):
        scene = rendering.scene(self.mesh, (8, 6), rendering.material(1, 0, "visible"))
        scene["integrator"]["light_sampling"] = 0
        path = self.folder / "wrong.json"
        path.write_text(json.dumps(scene))
        done = musurf("render", path, "-o", self.folder / "x.exr")
        self.assertEqual(done.returncode, 2)
        self.assertIn("light_sampling", done.err)


class Arithmetic(unittest.TestCase):
    def test_standard_error_is_the_jackknife(self):
        """Of a mean it is the standard deviation over sqrt(n): here of 1, 2, 3, 6 in both settings, 2.160 / 2."""
        values = np.array([1, 2, 3, 6.0])
        out = [[(values.sum() - v) / 3, 0] for v in values]
        settings = [{"mode": "mis", "samplers": {"x": {"left_out": out}}}] * 2
        self.assertAlmostEqual(noise.standard_error(settings, "mis", "x"), values.std(ddof=1) / 2)
        self.assertIsNone(noise.standard_error([{"mode": "mis", "samplers": {"x": {"left_out": []}}}], "mis", "x"))

    def test_noise_is_the_mean_square_less_the_references_own(self):
        rng = np.random.default_rng(20261201)
        truth = rng.uniform(0.5, 1, (200, 200))
        inside = np.ones_like(truth, dtype=bool)
        first, second = (truth + rng.normal(0, 0.1, truth.shape) for _ in range(2))
        picture = truth + rng.normal(0, 0.2, truth.shape)
        absolute, _ = noise.errors(picture, (first + second) / 2, inside, (first - second) ** 2 / 4)
        # 0.04 with a standard error of sqrt(2) 0.045 / 200 = 3.2e-4; forgetting the reference's 0.005 would be 16 of them
        self.assertAlmostEqual(absolute, 0.04, delta=6 * 3.2e-4)

    def test_samples_are_read_off_the_power_law(self):
        rows = {"noise": {16: [2.0, 2.0], 64: [0.25, 0.25]}}  # N^-1.5
        self.assertAlmostEqual(noise.samples_for(rows, 0.25, noise.FULL, 0), 64)
        self.assertAlmostEqual(noise.samples_for(rows, 2.0, noise.FULL, 0), 16)
        rows = {"noise": {16: [4.0, 4.0], 64: [1.0, 1.0]}}
        self.assertAlmostEqual(noise.samples_for(rows, 0.5, noise.FULL, 0), 128)

    def test_only_area_preserving_stretches_have_an_s(self):
        self.assertEqual(furnace.stretch(((2, 0), (0, 0.5))), 0.5)
        self.assertEqual(furnace.stretch(((1, 0), (0, 1))), 0)
        self.assertIsNone(furnace.stretch(((1, 1), (0, 1))))
        self.assertIsNone(furnace.stretch(((0.5, 0), (0, 0.5))))


if __name__ == "__main__":
    sys.exit(unittest.main())
