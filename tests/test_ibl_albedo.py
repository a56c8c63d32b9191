#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf ibl albedo` against quadrature of what `musurf eval` says, against a furnace, and sampler against sampler."""
import math
import pathlib
import subprocess
import sys
import unittest

import numpy

from command import answers, microfacet, musurf

NDFS = [dict(ndf="ggx", alpha=0.5), dict(ndf="beckmann", alpha=0.4), dict(ndf="gtr", alpha=0.3, gamma=1.4), dict(ndf="std", alpha=0.4, gamma=2.2),
        dict(ndf="phong", exponent=12), dict(ndf="sheen", alpha=0.5), dict(ndf="ellipsoid", alpha_x=0.4, alpha_y=0.2, theta_x=0.2, theta_y=0.1, theta_z=0)]
SKEW = [[1.5, 0.7], [-0.3, 0.8]]


def tables(materials, *options):
    return answers(musurf("ibl", "albedo", *options, stdin=[{"id": i, "material": material} for i, material in enumerate(materials)]))


def quadrature(material, wo):
    """The integral of f cos over the hemisphere: Gauss-Legendre in the cosine's square root, midpoints around. f is smooth at the
    scale of alpha >= 0.3 under SKEW, slope roughness 0.2 and more: 64 x 128 points; against 48 x 96 it moves by less than 1e-4."""
    x, weight = numpy.polynomial.legendre.leggauss(64)
    z, weight = ((x + 1) / 2) ** 2, weight / 2 * (x + 1)  # z = s², dz = 2 s ds
    phi = 2 * math.pi * (numpy.arange(128) + 0.5) / 128
    lines = [{"material": material, "wo": wo, "wi": [math.sqrt(1 - c * c) * math.cos(p), math.sqrt(1 - c * c) * math.sin(p), c]}
             for c in z for p in phi]
    f = numpy.array([answer["f"] for answer in answers(musurf("eval", stdin=lines))]).reshape(64, 128, 3)
    return (f * (weight * z)[:, None, None]).sum((0, 1)) * 2 * math.pi / 128


class Albedo(unittest.TestCase):
    def test_of_tables_of_compensation(self):
        """scripts/albedo_tables, which reads the structs of a header: what it finds is the integral to the tables' 1e-2."""
        script = pathlib.Path(__file__).resolve().parent.parent / "scripts/albedo_tables"
        done = subprocess.run([sys.executable, script, "alpha=0.5", "tilt=0.3,0.1", "transform=1.5,0.7,-0.3,0.8", "--steps", "1"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        theta, phi, told = map(float, done.stdout.splitlines()[1].split(","))
        self.assertEqual((theta, phi), (45, 0))
        right = quadrature(microfacet(alpha=0.5, tilt=[0.3, 0.1], transform=SKEW), [math.sqrt(0.5), 0, math.sqrt(0.5)])[0]
        self.assertAlmostEqual(told, right, delta=1e-2)

    def test_is_the_integral(self):
        """To 5 standard errors of the table and the rule's 1e-4: together 1e-3, whether directions are drawn by rejection (Beckmann) or not."""
        for material in (microfacet(ndf="ggx", alpha=0.5, transform=SKEW, fresnel={"schlick": [0.9, 0.5, 0.1]}),
                         microfacet(ndf="beckmann", alpha=0.5, transform=SKEW, fresnel={"conductor": "Cu"})):
            table = tables([material], "--rows", 2, "--columns", 3, "--samples", 1 << 14)[0]
            self.assertLess(5 * table["deviation"] + 1e-4, 1e-3)
            for row, column in ((0, 1), (1, 2)):
                z, phi = table["cosines"][row], table["azimuths"][column]
                wo = [math.sqrt(1 - z * z) * math.cos(phi), math.sqrt(1 - z * z) * math.sin(phi), z]
                self.assertAlmostEqual(z, (row + 0.5) / 2, delta=1e-15)
                for got, right in zip(table["albedo"][3 * row + column], quadrature(material, wo)):
                    self.assertAlmostEqual(got, right, delta=5 * table["deviation"] + 1e-4)

    def test_every_distribution(self):
        """Two samplers agree, within 5 deviations of either: 7 x 6 views, chances of 1e-5 in all. Weights of visible normals lie in
        [0, 1]: they deviate by 1/2 at most, and 16 batches know that to a factor of 2."""
        options = "--rows", 2, "--columns", 3, "--samples", 2048
        visible = tables([microfacet(transform=SKEW, **ndf) for ndf in NDFS], *options)
        normals = tables([microfacet(transform=SKEW, sampler="ndf", **ndf) for ndf in NDFS], *options, "--seed", 1)
        for ndf, a, b in zip(NDFS, visible, normals):
            self.assertNotIn("error", a, ndf)
            a_values, b_values = numpy.array(a["albedo"]), numpy.array(b["albedo"])
            self.assertTrue(((a_values > 0) & (a_values < 1 + 5 * a["deviation"])).all(), ndf)
            self.assertLess(numpy.max(numpy.abs(a_values - b_values)), 5 * math.hypot(a["deviation"], b["deviation"]), ndf)
            self.assertLess(a["deviation"], 2 * 0.5 / math.sqrt(2048))

    def test_furnace(self):
        """What is lost by single reflection comes back on the random walk: all of it."""
        table = tables([microfacet(ndf="ggx", alpha=0.7, transform=SKEW, multiple_scattering="random_walk")], "--rows", 2, "--columns", 2)[0]
        self.assertLess(numpy.max(numpy.abs(numpy.array(table["albedo"]) - 1)), 5 * table["deviation"] + 1e-12)

    def test_mirror(self):
        table = tables([microfacet(ndf="flat", fresnel={"schlick": [0.5, 0.5, 0.5]})], "--rows", 3, "--columns", 1)[0]
        for z, albedo in zip(table["cosines"], table["albedo"]):
            self.assertAlmostEqual(albedo[0], 0.5 + 0.5 * (1 - z) ** 5, delta=1e-12)
        self.assertEqual(table["azimuths"], [0])

    def test_bad_lines(self):
        done = musurf("ibl", "albedo", "--rows", 1, "--columns", 1, stdin=[{"id": 1}, {"id": 2, "material": microfacet(alpha=-1)}, {"id": 3, "material": microfacet()}])
        self.assertEqual(done.returncode, 1)
        self.assertEqual(["error" in answer for answer in answers(done)], [True, True, False])
        self.assertEqual(musurf("ibl", "albedo", "--rows", 0).returncode, 2)


if __name__ == "__main__":
    unittest.main()
