#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Refraction through explicit surfaces against the material's, `musurf eval` with "transmission", as far as Smith allows.

The material is f = f0 G2 with f0 what facets would refract if none were hidden; so is a surface, with a G2 of its own. Of the
surface's two facts are exact, whatever its shape. What faces the view has the projected area 1 + Lambda(v) over the plane's,
of which 1 is seen: Lambda(v) is hidden. Of what is seen, the share `caught`, which is counted, is hidden from below. So with
a disc of light of radiance L about l, and the factor 1/eta^2,
    f0 - L (Lambda(v) + caught) / eta^2  <=  f of the surface  <=  f0,
while the material's is f0 G2, both known. Where roughness and angles are small all three are one number.
Facets' slopes are off their law by a relative rms d over bins of equal shares, which musurf surface make reports; a disc whose
facets are a share q of all, f = (1 - F) L q / eta^2, changes by d f / sqrt(q) at most (Cauchy and Schwarz): d sqrt(f L) / eta.

Where they are not, Smith's G1 leave the joint visibility of one facet, from v above and t below, between
    max(0, G1(v) + G1(t) - 1)  and  min(G1(v), G1(t))
(Frechet), of which a lower height raises one and lowers the other: at most G1(v) G1(t). Uniformly distributed heights (Smith's)
have B(1 + Lambda(v), 1 + Lambda(t)). The material takes 1/(1 + Lambda(v) + Lambda(t)), which is more than the product: it
lets through more than any surface whose heights oppose.
"""
import math
import sys
import unittest

import numpy as np

import test_surface_statistics as above
from command import answers, microfacet, musurf, strict
from test_surface_command import Folder, numbers
from test_surface_refraction import disc, refracted

from crosscheck import maps  # noqa: E402

UP = np.array([0, 0, 1.0])


def about(l, degrees, sectors=24):
    """Directions in a disc about l, and weights for the mean over it by solid angle: Gauss and Legendre's along the radius."""
    nodes, weights = np.polynomial.legendre.leggauss(12)
    cosine = 1 - (1 + nodes)[:, None] / 2 * (1 - np.cos(np.radians(degrees)))
    phi = (np.arange(sectors) + 0.5) * 2 * np.pi / sectors
    x = np.cross(l, [0.6, 0.8, 0.0])
    x /= np.linalg.norm(x)
    sine = np.sqrt(1 - cosine**2)[..., None]
    w = cosine[..., None] * l + sine * (np.cos(phi)[:, None] * x + np.sin(phi)[:, None] * np.cross(l, x))
    return w.reshape(-1, 3), np.repeat(weights / 2 / sectors, sectors)


class Material(Folder):
    def made(self, ndf, alpha, size, correlation):
        """Eight surfaces: a standard error from them has 7 degrees of freedom; 4 are exceeded by chance once in 190 times."""
        files, self.deviation = [self.folder / f"{ndf}{seed}.exr" for seed in range(8)], 0
        for seed, file in enumerate(files):
            done = musurf("surface", "make", f"--ndf={ndf}", f"--alpha={alpha}", f"--size={size}",
                          f"--correlation={correlation}", f"--seed={seed}", "-o", file)
            self.assertEqual(done.returncode, 0, done.err)
            self.deviation = max(self.deviation, *strict(done.out)["deviation"])
        return files

    def evaluated(self, material, v, directions):
        lines = [{"material": material, "wo": list(v), "wi": list(w)} for w in directions]
        out = answers(musurf("eval", "--precision", "double", stdin=lines))
        return np.array([[a["f"][0], a["G2"], a["Lambda"]] for a in out]).T


class Narrow(Material):
    RADIUS = 8

    def test_discs(self):
        """From either side, with total reflection; slopes of Beckmann .3 hide less than 1e-3 from 60 degrees."""
        files = self.made("beckmann", 0.3, 128, 4)
        for eta, angles in ((1.5, (0, 40, 60)), (1 / 1.5, (0, 20))):
            material = microfacet(ndf="beckmann", alpha=0.3, transmission=True, fresnel={"dielectric": eta})
            for degrees in angles:
                v = maps.direction(degrees, 30)
                flat = refracted(v, UP, eta)[0]
                lights = [flat, about(flat, 12, 3)[0][-3], about(flat, 14, 3)[0][-2]]
                view, = above.statistics(files, [v], f"--fresnel=dielectric:{eta!r}", "--transmission", "--bounces=0",
                                         *[f"--light={numbers(l)},{self.RADIUS}" for l in lights])["views"]
                given = view["transmission"]
                for l, lamp in zip(lights, given["lights"]):
                    w, weights = about(l, self.RADIUS)
                    f, g2, Lambda = self.evaluated(material, v, w)
                    weights = weights * abs(w[:, 2]) / np.dot(weights, abs(w[:, 2]))
                    model, bare = np.dot(weights, f), np.dot(weights, f / g2)
                    light = disc(l, l, self.RADIUS)
                    hidden = light / eta**2 * (Lambda[0] + given["caught"])
                    error = 4 * lamp["f_error"] + self.deviation * np.sqrt(bare * light) / eta
                    with self.subTest(eta=eta, view=degrees, light=l):
                        self.assertLess(lamp["f"], bare + error)
                        self.assertGreater(lamp["f"], bare - hidden - error)
                        self.assertLess(abs(bare - model), 1e-3 * bare)
                        self.assertLess(hidden + error, 0.1 * bare)  # or little is said


class Wide(Material):
    def quadrature(self, alpha, v, eta, slopes=500, turns=360):
        """Integrals of (v.m) D (1 - F) G2 / v.z over normals of GGX, for each form of G2 and for G1(v) alone."""
        u = 1 - (1 - (np.arange(slopes) + 0.5) / slopes)**2  # P(tan < .) at nodes that crowd toward steep ones
        du = 2 * (1 - (np.arange(slopes) + 0.5) / slopes) / slopes
        steep = alpha * np.sqrt(u / (1 - u))[:, None]
        phi = (np.arange(turns) + 0.5) * 2 * np.pi / turns
        m = np.stack([steep * np.cos(phi), steep * np.sin(phi), 1 + 0 * steep * phi], -1)
        length = np.linalg.norm(m, axis=-1)
        m /= length[..., None]
        t, f = refracted(v, m, eta)
        weight = du[:, None] / turns * length * np.maximum(0, m @ v) / v[2] * (1 - f)
        tan2 = lambda w: (w[..., 0]**2 + w[..., 1]**2) / w[..., 2]**2
        a, b = ((np.sqrt(1 + alpha**2 * tan2(w)) - 1) / 2 for w in (v, t))
        gamma, down = np.vectorize(math.lgamma), t[..., 2] < 0
        b = np.minimum(b, 1e9)
        forms = {"v": 1 / (1 + a), "correlated": 1 / (1 + a + b), "separable": 1 / (1 + a) / (1 + b),
                 "beta": np.exp(math.lgamma(1 + a) + gamma(1 + b) - gamma(2 + a + b)),
                 "least": np.maximum(0, 1 / (1 + a) + 1 / (1 + b) - 1)}
        return {name: np.sum(weight * g * (1 if name == "v" else down)) for name, g in forms.items()}

    def test_total(self):
        """GGX .5 from 75 degrees: 18 % is caught, of which the material knows 11."""
        eta, v = 1.5, maps.direction(75, 0)
        view, = above.statistics(self.made("ggx", 0.5, 128, 4), [v], f"--fresnel=dielectric:{eta!r}", "--transmission",
                                 "--bounces=0")["views"]
        given, form = view["transmission"], self.quadrature(0.5, v, eta)
        error = 4 * given["caught_error"]
        self.assertLess(error, 0.02)
        self.assertGreater(given["caught"], form["v"] - form["separable"] - error)
        self.assertLess(given["caught"], form["v"] - form["least"] + error)
        self.assertLess(abs(given["caught"] - (form["v"] - form["beta"])), abs(given["caught"] - (form["v"] - form["separable"])))
        # The material: what it lets through is what its form of G2 says, and off by no more than Frechet allows.
        total = eta**2 * self.all_through(v, eta)
        self.assertLess(abs(total - form["correlated"]), 0.005)
        self.assertLess(abs(given["escaped"] - total), form["correlated"] - form["least"] + error)

    def all_through(self, v, eta, rings=60, sectors=80):
        """The material's f over the cone about -v into which level to grazing facets refract, to asin(1/eta) from grazing.
        The horizon cuts 120 or so of 4800 cells, whose halves are taken or left: with signs as they come 120^(1/2)/2/4800 of
        a mean's few-fold, 3e-3."""
        nodes, weights = np.polynomial.legendre.leggauss(rings)
        most = np.arccos(1 / eta)
        theta, phi = most * (1 + nodes)[:, None] / 2, (np.arange(sectors) + 0.5) * 2 * np.pi / sectors
        x, y = np.array([v[2], 0, -v[0]]), UP[[1, 2, 0]]
        w = -(np.cos(theta)[..., None] * v + np.sin(theta)[..., None] * (np.cos(phi)[:, None] * x + np.sin(phi)[:, None] * y))
        below, f = w[..., 2] < 0, np.zeros(w.shape[:2])
        material = microfacet(ndf="ggx", alpha=0.5, transmission=True, fresnel={"dielectric": eta})
        f[below] = self.evaluated(material, v, w[below])[0] * -w[below][:, 2]
        return np.dot(f.mean(1) * np.sin(theta[:, 0]), weights) / 2 * most * 2 * np.pi


if __name__ == "__main__":
    sys.exit(unittest.main())
