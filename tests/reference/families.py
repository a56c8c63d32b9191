# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The isotropic distributions by their definitions: D in 1/sr, and the survival Q(x) = P(slope^2 > x) that follows.

`gamma` is the second parameter, whatever a family calls it: the tail of gtr and std, the exponent of phong. Sources:
GTR *Microsurface Transformations* Eq. (32), (33); STD Ribardiere et al. 2017; Phong Blinn 1977, normalised to
int D cos = 1; sheen Estevez and Kulla 2017. Q is the elementary integral of pi P22(x) dx, P22 = D cos^4, from x to
infinity; smith.crosscheck() differentiates it back. cos2 and sin2 come apart, so that nothing here cancels.
"""
import mpmath as mp
import numpy as np


def density(ndf, alpha, gamma, cos2, sin2):
    """D of the untransformed microsurface at a normal with these squares of cosine and sine."""
    a = alpha * alpha
    if ndf == "beckmann":
        return mp.exp(-sin2 / cos2 / a) / (mp.pi * a * cos2 * cos2)
    if ndf == "std":
        b = (gamma - 1) * a
        return (gamma - 1) * (b / (b + sin2 / cos2)) ** gamma / (b * mp.pi * cos2 * cos2)
    if ndf == "phong":
        return (gamma + 2) / (2 * mp.pi) * cos2 ** (gamma / 2)
    if ndf == "sheen":
        return (2 + 1 / alpha) * sin2 ** (1 / (2 * alpha)) / (2 * mp.pi)
    if ndf == "ggx":
        gamma = 2
    elif alpha == 1:
        return 1 / mp.pi  # the limit of Eq. (32) for every gamma
    base = sin2 + a * cos2
    if gamma == 1:
        return (a - 1) / (mp.pi * mp.log(a)) / base  # Eq. (33)
    if ndf == "ggx":
        return a / (mp.pi * base * base)
    return (gamma - 1) * (a - 1) / (mp.pi * (1 - a ** (1 - gamma))) / base ** gamma  # Eq. (32)


def survival(ndf, alpha, gamma, x):
    """Q(x); of GGX and Beckmann too, though their Lambda needs no quadrature."""
    a = alpha * alpha
    if ndf == "beckmann":
        return mp.exp(-x / a)
    if ndf == "ggx":
        return a / (a + x)
    if ndf == "std":
        b = (gamma - 1) * a
        return (b / (b + x)) ** (gamma - 1)
    if ndf == "phong":
        return (1 + x) ** (-(gamma + 2) / 2)
    if ndf == "sheen":
        return -mp.expm1((1 + 1 / (2 * alpha)) * mp.log1p(-1 / (1 + x)))
    ln_q = mp.log1p(-(1 - a) / (1 + x))  # gtr
    if gamma == 1:
        return ln_q / mp.log(a)
    return mp.expm1((1 - gamma) * ln_q) / mp.expm1((1 - gamma) * mp.log(a))


def log_survival(ndf, alpha, gamma, ln_x):
    """ln Q in double precision, for arrays of ln x: std, phong and sheen. For derivatives only."""
    if ndf == "std":
        return (1 - gamma) * np.logaddexp(0, ln_x - np.log((gamma - 1) * alpha * alpha))
    if ndf == "phong":
        return -(gamma + 2) / 2 * np.logaddexp(0, ln_x)
    return np.log(-np.expm1(-(1 + 1 / (2 * alpha)) * np.logaddexp(0, -ln_x)))  # sheen


def spread(ndf, alpha, gamma):
    """ln of how far Q's own shape carries the Smith integrand left and right of where tau puts it."""
    if ndf == "std":
        return float(mp.log(gamma)) / 2, 0.0
    if ndf == "phong":
        return float(mp.log(gamma / 2 + 1)) / 2, 0.0
    if ndf == "sheen":
        return 0.0, float(mp.log(1 + 1 / (2 * alpha))) / 2
    return 0.0, 0.0
