#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What stands between the values of a parameter: materials blended, maps with their Jacobians, and means over a pixel."""
import json
import math
import sys
import unittest

import numpy as np

import exr
from command import microfacet, musurf
from plates import M, Pictures


class Blends(Pictures):
    def test_gamma_between_its_values(self):
        """A formula that takes two values: the materials of these, each on its half, bit by bit. In between, a mixture whose
        mean is the two neighbours' mean: pictures by many samples, within scatter."""
        two = self.picture(self.metal(ndf="gtr", alpha=0.2, gamma={"expression": "1.25 + 1.75*min(floor(2*u), 1)"}, transform=M))
        left, right = (self.picture(self.metal(ndf="gtr", alpha=0.2, gamma=gamma, transform=M)) for gamma in (1.25, 3))
        same = (two == left) | (two == right)
        self.assertGreater(same.all(0).mean(), 0.9)  # but where a pixel sees both
        self.assertGreater((two != left).any(0).mean(), 0.2)
        self.assertGreater((two != right).any(0).mean(), 0.2)
        # 1 + 2/16 lies between 1 and 1.25: of 17 values from 1 to 3 the second is 3^(1/16)
        second = 3**(1 / 16)
        share = (1.03 - 1) / (second - 1)
        mixed = self.picture(self.metal(ndf="gtr", alpha=0.2, gamma={"expression": "1.03 + 1.97*floor(u) - 0.03*floor(1 - u)"}), samples=256)
        ends = [self.picture(self.metal(ndf="gtr", alpha=0.2, gamma=g), samples=256) for g in (1, second)]
        wanted = (1 - share) * ends[0] + share * ends[1]
        self.assertLess(np.abs(mixed - wanted).mean(), 0.02 * wanted.mean())

    def test_gamma_and_alpha_at_once(self):
        """Formulas of two values each, on halves and on the other halves: everywhere it is bit by bit one of the four materials, each on its
        quarter."""
        step = "{} + {}*min(floor(2*{}), 1)"
        got = self.picture(self.metal(ndf="gtr", gamma={"expression": step.format(1.25, 1.75, "u")}, alpha={"expression": step.format(0.2, 0.2, "v")}, transform=M))
        four = [self.picture(self.metal(ndf="gtr", gamma=g, alpha=a, transform=M)) for g in (1.25, 3) for a in (0.2, 0.4)]
        same = np.array([(got == one).all(0) for one in four])
        self.assertGreater(same.any(0).mean(), 0.85)  # but where a pixel sees two, along two lines now
        for one in same & (np.array(four).std(0) > 0).any(0):
            self.assertGreater(one.mean(), 0.05)

    def test_alpha_of_gtr(self):
        """What the plugin refuses in a slot is blended: between 17 values of a ratio below 1.1 a mixture is near its middle."""
        formula = {"expression": "0.15 + 0.3*u"}
        texture = self.texture("a.exr", {"Y": np.tile(0.15 + 0.3 * (np.arange(256) + 0.5) / 256, (2, 1))}) | {"wrap": "clamp"}
        got = [self.picture(self.metal(ndf="gtr", gamma=2, alpha=a), samples=256) for a in (formula, texture)]
        exact = self.picture(self.metal(ndf="ggx", alpha=formula), samples=256)
        for picture in got:
            self.assertLess(np.abs(picture - exact).mean(), 0.02 * exact.mean())


class Maps(Pictures):
    def test_formula_is_the_named_map(self):
        for transform in ([[1, 0], [0, 1]], M):
            named, formula = {"map": "power_shear", "amount": 2, "exponent": 5}, {"u": "u", "v": "v + 2*u^5"}
            self.assertTrue(np.array_equal(*(self.picture(self.metal(alpha=0.25, transform=transform, jacobian=j)) for j in (named, formula))))

    def test_displacement_is_its_formula(self):
        """A spline through the texels of 2 u^5, whose derivative is off by h^2/6 of its third one: 2e-4 for u = 1."""
        u = (np.arange(256) + 0.5) / 256
        self.texture("d.exr", {"X": np.zeros((4, 256)), "Y": np.tile(2 * u**5, (4, 1))})
        formula = self.picture(self.metal(alpha=0.25, jacobian={"u": "u", "v": "v + 2*u^5"}))
        got = self.picture(self.metal(alpha=0.25, jacobian={"displacement": "d.exr", "channels": ["X", "Y"], "wrap": "clamp"}))
        off = np.abs(got - formula) > 0.01 * formula
        self.assertLess(off.mean(), 0.02)
        ramp = np.add.outer(-np.arange(64), 2 * np.arange(64)) / 64  # v grows upwards
        self.texture("r.exr", {"X": ramp, "Y": -ramp})
        linear = self.picture(self.metal(alpha=0.25, jacobian={"u": "u + 0.25*(2*u + v)", "v": "v - 0.25*(2*u + v)"}))
        got = self.picture(self.metal(alpha=0.25, jacobian={"displacement": "r.exr", "channels": ["X", "Y"], "scale": 0.25, "wrap": "clamp"}))
        off = np.abs(got - linear) > 1e-3 * linear
        self.assertLess(off.mean(), 2 * 4 / 64)  # but for two texels at each edge, where the ramp ends


class Filtering(Pictures):
    """A plate under a sun alone, so that nothing but the texture is sampled; a pixel sees some 45 texels in a row."""

    def plate(self, material, samples):
        scene = {"camera": {"position": [0, -3, 2.6], "target": [0, 0, 0], "fov": 34},
                 "film": {"width": 20, "height": 15, "pixels": "float", "filter": "box"}, "integrator": {"samples": samples, "depth": 1},
                 "objects": [{"shape": "rectangle", "material": material}],
                 "lights": [{"type": "directional", "direction": [0.1, 3, 2.7], "irradiance": [1, 1, 1]}]}
        (self.folder / "plate.json").write_text(json.dumps(scene))
        done = musurf("render", self.folder / "plate.json", "-o", self.folder / "plate.exr", "--progress", "none")
        self.assertEqual(done.returncode, 0, done.err)
        return exr.read(self.folder / "plate.exr")[1]["G"].astype(float)

    def test_few_samples_do_not_alias_and_many_converge(self):
        """Against 4096 unfiltered samples: one filtered sample is nearer than one unfiltered; where roughness varies, by far,
        once what one sample does to a plate without texture is taken off; of 16 neither kind is worse than the other by more
        than scatter; and of 1024 both are the same, for neighbours differ by more than 1/1024."""
        rng = np.random.default_rng(3)
        angle = rng.uniform(-0.6, 0.6, (128, 128))
        strong, mild = np.where(rng.random((128, 128)) < 0.5, 0.1, 0.4), rng.uniform(0.2, 0.3, (128, 128))
        self.texture("turned.exr", {"X": np.cos(angle), "Y": np.sin(angle)})
        cases = [("alpha", self.texture(name, {"Y": plane}), {}, math.sqrt(np.mean(plane**2)))
                 for name, plane in (("strong.exr", strong), ("mild.exr", mild))]
        cases.append(("rotation", {"direction_map": "turned.exr", "channels": ["X", "Y"]}, dict(alpha_x=0.08, alpha_y=0.4), None))
        for parameter, source, others, level in cases:
            def made(samples, value=None, **how):
                value = value or source | {"scale": [5, 5]} | how
                return self.plate(microfacet(ndf="beckmann", sampler="visible", **others, **{parameter: value}), samples)

            def error(picture, of):
                return math.sqrt(np.mean((picture - of)**2) / np.mean(of**2))
            truth = made(4096, filter="none")
            with self.subTest(source):
                one, point = error(made(1), truth), error(made(1, filter="none"), truth)
                floor = error(made(1, level), made(256, level)) if level else 0
                self.assertLess(one**2 - floor**2, (point**2 - floor**2) / (4 if level else 1))
                self.assertLess(error(made(16), truth), 1.1 * error(made(16, filter="none"), truth))
                self.assertLess(error(made(1024), made(1024, filter="none")), 1e-4)


if __name__ == "__main__":
    sys.exit(unittest.main())
