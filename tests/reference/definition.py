#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Holds bsdf.py to what its quantities mean, by plain quadrature over the sphere. About a minute.

    int D cos dm = 1,  int max(0, w.m) D dm = sigma(w)        for every family, mirrored, skewed and tilted
    int pdf dwi = 1 over both sides                            where almost nothing is reflected down or refracted up
    f(wo, wi) / n_o^2 = f(wi, wo) / n_i^2                      across a dielectric and on each side of it
    int max(0, u_z - u_xy.s) P22 ds                            of a histogram, by its cells cut into many
    int pdf dwi <= 1, = 1 where no sample is lost              for samplers other than visible normals
"""

import mpmath as mp
import numpy as np

import samplers
import smith
from bsdf import Bsdf
from histogram import Histogram

MOVED = {"transform": [[0.8, 0.7], [0.3, -0.9]], "tilt": [0.9, -0.4]}
MATERIALS = (
    {"ndf": "ggx", "alpha": 0.6, **MOVED},
    {"ndf": "gtr", "alpha": 0.5, "gamma": 3.0, "alpha_x": 0.3, "alpha_y": 0.9, "rotation": 0.7, **MOVED},
    {"ndf": "std", "alpha": 0.5, "gamma": 4.0, **MOVED},
    {"ndf": "phong", "exponent": 3.0, **MOVED},
    {"ndf": "sheen", "alpha": 0.6, **MOVED},
    {"ndf": "beckmann", "alpha_x": 0.5, "alpha_y": 0.8, "rotation": -0.4, "tilt": [0.3, 1.1]},
    {"ndf": "ellipsoid", "alpha_x": 0.4, "alpha_y": 0.7, "theta_x": 0.6, "theta_y": -0.5, "theta_z": 0.9},
    {"ndf": "ellipsoid", "A": [[0.4, 0.2, -0.3], [0.1, -0.8, 0.2], [0.5, 0.3, 1.2]], **MOVED},
)
VIEWS = ([0.6, 0.3, 0.5], [-0.8, 0.5, 0.1], [0.2, -0.9, 0.02])


def hemisphere(n):
    """Directions m and weights: Gauss in a variable that is fine at the horizon, trapezoid in azimuth."""
    nodes, weights = np.polynomial.legendre.leggauss(n)
    s = (nodes + 1) / 2
    z, dz = s * s, s * weights  # dz = 2 s ds
    phi = 2 * np.pi * (np.arange(2 * n) + 0.5) / (2 * n)
    z, phi = np.meshgrid(z, phi, indexing="ij")
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1).reshape(-1, 3), np.repeat(dz, 2 * n) * np.pi / n


def densities(case, points):
    """case.D over many normals. Doubles go through the same lines of Python as 50 digits do."""
    return np.array([float(case.D([mp.mpf(float(e)) for e in m])) for m in points])


def projected_areas():
    points, weights = hemisphere(96)
    for material in MATERIALS:
        case = Bsdf(material, VIEWS[0], [0, 0, 1], VIEWS[0])
        case.prepare()
        with mp.workdps(16):
            D = densities(case, points)
        errors = [abs(np.sum(D * points[:, 2] * weights) - 1)]
        for view in VIEWS:
            w = np.array(view) / np.linalg.norm(view)
            exact = case.sigma([mp.mpf(float(e)) for e in w], smith_lambda, 0)[0]
            errors.append(abs(np.sum(np.maximum(0, points @ w) * D * weights) / float(exact) - 1))
        print(f"{material['ndf']:9} int D cos - 1: {errors[0]:.1e}; sigma: {max(errors[1:]):.1e}")
        # The kink along wo.m = 0 leaves quadrature of n by 2n points with an error of a few 1/n^2 = 1e-4.
        assert errors[0] < 1e-6 and max(errors[1:]) < 1e-3


def smith_lambda(*arguments):
    return smith.Lambda(*arguments[:-1], digits=20)


def sum_of_pdf():
    points, weights = hemisphere(40)
    for extra in ({"ndf": "beckmann", "alpha": 0.3}, {"ndf": "beckmann", "alpha": 0.3, "tilt": [0.15, -0.1]}):
        for eta, wo in ((1.5, [0.3, 0.2, 0.9]), (1.5, [0.3, 0.2, -0.9]), (0.6, [0.1, 0.2, 0.9])):
            material = {**extra, "transmission": True, "fresnel": {"dielectric": eta}}
            total = 0.0
            with mp.workdps(16):
                for side in (1, -1):
                    pdf = [float(Bsdf(material, wo, wo, [float(p[0]), float(p[1]), side * float(p[2])])
                                 .evaluate(smith_lambda)["pdf"]) for p in points]
                    total += np.sum(np.array(pdf) * weights)
            print(f"tilt {extra.get('tilt')} eta {eta} wo.z {wo[2]}: int pdf - 1 = {total - 1:.1e}")
            assert abs(total - 1) < 5e-3  # what points down or up


def reciprocity():
    worst = 0
    for material in MATERIALS:
        for masking in ("height_correlated", "separable", "direction_correlated"):
            for eta in (1.5, 0.7):
                material = {**material, "masking": masking, "transmission": True, "fresnel": {"dielectric": eta}}
                for v, l in (([0.3, 0.2, 0.9], [0.1, -0.5, 0.4]), ([0.3, 0.2, 0.9], [-0.1, -0.2, -0.8]),
                             ([0.1, 0.1, -0.9], [-0.2, 0.3, -0.5])):
                    there, back = (Bsdf(material, *d).evaluate(smith_lambda)["f0"] / (mp.mpf(eta) ** 2 if d[0][2] < 0 else 1)
                                   for d in ((v, v, l), (l, l, v)))
                    assert there > 0, (material, v, l)
                    worst = max(worst, abs(there / back - 1))
    print("reciprocity: worst", mp.nstr(worst, 3))
    assert worst < 1e-20


def histograms():
    bounds, weights, cut = [-0.7, 1.3, -0.4, 0.5], [[1, 0, 3], [2, 5, 0.5]], 400
    x = (np.arange(3 * cut) + 0.5) / (3 * cut) * 2.0 - 0.7
    y = (np.arange(2 * cut) + 0.5) / (2 * cut) * 0.9 - 0.4
    mass = np.kron(np.array(weights), np.ones((cut, cut))) / np.sum(weights) / cut**2
    h, worst = Histogram(weights), 0
    for u in ([0.6, 0.3, 0.5], [-0.8, 0.5, 0.1], [0.2, -0.9, -0.3], [0.0, 0.5, 0.2], [0.0, 0.0, 1.0]):
        seen = u[2] - u[0] * x[None, :] - u[1] * y[:, None]
        for sign in (1, -1):
            worst = max(worst, abs(float(h.part(bounds, u, sign)) - np.sum(np.maximum(0, sign * seen) * mass)))
        worst = max(worst, abs(float(h.level(bounds, u)) - np.sum(seen * mass)))
        deviation = float(np.sqrt(max(0, np.sum(seen**2 * mass) - np.sum(seen * mass) ** 2)))
        worst = max(worst, abs(float(h.spread(bounds, u)) - deviation))
    print(f"histogram: worst {worst:.1e}")
    assert worst < 1e-5  # midpoints of cells cut into 400 x 400


def sum_of_samplers():
    points, weights = hemisphere(32)
    wo, skew = [0.5, 0.2, 0.7], {"transform": [[0.8, 0.7], [0.3, -0.9]]}
    for sampler in samplers.ALL:
        case = {"ndf": "ggx", "alpha": 0.4, "sampler": sampler, **skew}
        with mp.workdps(16):
            total = np.sum(weights * [float(Bsdf(case, wo, wo, [float(e) for e in p]).evaluate(smith_lambda)["pdf"]) for p in points])
        print(f"{sampler}: int pdf = {total:.5f}")
        assert abs(total - 1) < 5e-3 if sampler.startswith("folded") else 0.6 < total < 1.001


def main():
    projected_areas()
    histograms()
    sum_of_samplers()
    reciprocity()
    sum_of_pdf()


if __name__ == "__main__":
    main()
