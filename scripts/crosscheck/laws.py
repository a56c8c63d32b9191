# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What clipping takes from a distribution: no facet of a surface is steeper than a limit R, and its slope r becomes R.

sigma(v) = E max(0, cos - sin s), s the slope along v, so it loses at most sin E max(0, r - R) / pi: the cosine of the slope's
azimuth, where positive, averages 1/pi. E max(0, r - R) is the integral of P(slope > r) over r > R, with P from the
distributions' closed forms.
"""
import numpy as np


def survival(p, x):
    """P(tan^2 > x) of the untransformed distribution."""
    ndf, a = p["ndf"], p.get("alpha", 1.0) ** 2
    if ndf == "beckmann":
        return np.exp(-x / a)
    if ndf == "ggx":
        return a / (x + a)
    if ndf == "std":
        return (1 + x / ((p["gamma"] - 1) * a)) ** (1 - p["gamma"])
    if ndf == "phong":
        return (1 + x) ** (-(p["exponent"] + 2) / 2)
    if ndf == "sheen":
        return -np.expm1((1 + 1 / (2 * p["alpha"])) * -np.log1p(1 / x))
    d, ln = 1 - p["gamma"], np.log1p(-(1 - a) / (1 + x))
    return ln / np.log(a) if d == 0 else np.expm1(d * ln) / np.expm1(d * np.log(a))


def clipped(parameters, limit):
    """E max(0, slope - limit), by Gauss-Legendre in u = limit/slope; 0 for a surface that is what it is."""
    if parameters is None:
        return 0.0
    x, w = np.polynomial.legendre.leggauss(64)
    u = (x + 1) / 2
    return float((survival(parameters, (limit / u) ** 2) * limit / u**2 * w / 2).sum())
