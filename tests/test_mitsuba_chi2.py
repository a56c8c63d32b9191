#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Mitsuba's own chi² test of BSDFs (mitsuba.chi2) over ours: what sample draws follows pdf. Three distributions under a skewed M, a
rough dielectric from both sides, and a plugin that is not ours. The significance level is Mitsuba's, 1 %, with its correction for
the number of tests; its seed is fixed in there."""
import sys
import unittest

import mitsuba_host

mi, musurf_mitsuba = mitsuba_host.enter()
from mitsuba.chi2 import BSDFAdapter, ChiSquareTest, SphericalDomain  # noqa: E402

SKEW = "1 0.6 -0.3 1.4"
VIEWS = ([0, 0, 1], [0.6, 0.2, 0.7745967], [-0.3, 0.9, 0.3162278])
MATERIALS = {
    "ggx": dict(ndf="ggx", alpha=0.4, transform=SKEW),
    "beckmann": dict(ndf="beckmann", alpha=0.5, transform=SKEW),
    "gtr": dict(ndf="gtr", alpha=0.4, gamma=1.5, transform=SKEW, sampler="visible"),
    "glass": dict(ndf="ggx", alpha=0.4, transform=SKEW, fresnel="dielectric", fresnel_dielectric=1.5, transmission=True),
}


class Chi2(unittest.TestCase):
    def accepted(self, views=VIEWS, tests=1, cells=51, **material):
        for wi in views:
            sample, pdf = BSDFAdapter("musurf", {"type": "musurf", **material}, wi=wi)
            test = ChiSquareTest(SphericalDomain(), sample, pdf, sample_dim=3, sample_count=200000, res=cells, ires=16, seed=1)
            self.assertTrue(test.run(test_count=tests, quiet=True), f"{material} from {wi}:\n{test.messages}")

    def test_every_distribution_under_a_skewed_map(self):
        count = len(VIEWS) * (len(MATERIALS) + 1)
        for name, material in MATERIALS.items():
            # what goes straight through is a peak at the pole of the domain: Mitsuba integrates its own roughdielectric over as many
            self.accepted(tests=count, cells=201 if name == "glass" else 51, **material)

    def test_glass_from_within(self):
        self.accepted(views=[[0.4, -0.3, -0.8660254]], cells=201, **MATERIALS["glass"])

    def test_another_plugin(self):
        self.accepted(views=[[0.6, 0.2, 0.7745967]], material="template.lambert", reflectance=0.5)

    def test_it_can_fail(self):
        """The pdf of another M is rejected: the test sees M."""
        sample, _ = BSDFAdapter("musurf", {"type": "musurf", **MATERIALS["gtr"]}, wi=VIEWS[1])
        _, pdf = BSDFAdapter("musurf", {"type": "musurf", **MATERIALS["gtr"], "transform": "1 0.6 -0.3 1.3"}, wi=VIEWS[1])
        test = ChiSquareTest(SphericalDomain(), sample, pdf, sample_dim=3, sample_count=200000, res=51, ires=16, seed=1)
        self.assertFalse(test.run(quiet=True))


if __name__ == "__main__":
    sys.exit(unittest.main())
