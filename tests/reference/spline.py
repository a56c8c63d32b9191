# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""GTR's approximate masking of Appendix A of *Microsurface Transformations*: Eq. (35) to (39) as printed, and the natural cubic
spline in gamma through them, solved as a system. Kept within [S_0, 1], in which the exact average visibility lies."""
import functools

from mpmath import log, lu_solve, matrix, mp, mpf, sqrt


def visibility(alpha, mu):
    """S_0 to S_4 as Appendix A prints them, mu the cotangent of the view's angle."""
    a2, a4 = alpha**2, alpha**4
    A1, B1, B3, A4 = sqrt(mu**2 + a2), sqrt(mu**2 + 1), a2 + 1, 8 * a4 + 8 * a2 + 8
    return [
        2 / (1 + sqrt(1 / mu**2 + 1)),
        mu * log(a2) / (A1 - B1 + mu * log(a2 * (mu + B1) / (mu + A1))),
        2 / (1 + sqrt(a2 / mu**2 + 1)),
        4 * B3 * mu * A1 / (a2 * (3 * a2 + 1) + 2 * mu * B3 * (mu + A1)),
        2 * A4 * mu * A1**3 / (A4 * mu * (A1**3 + mu**3) + 3 * a2 * (a2 * (5 * a4 + 2 * a2 + 1) + 4 * mu**2 * (2 * a4 + a2 + 1))),
    ]


def natural_spline(y, x):
    """Through (k, y[k]), no curvature at the ends."""
    bend = [mpf(0), *lu_solve(matrix([[4, 1, 0], [1, 4, 1], [0, 1, 4]]), matrix([6 * (y[k - 1] - 2 * y[k] + y[k + 1]) for k in (1, 2, 3)])), mpf(0)]
    k = min(int(x), 3)
    t = x - k
    return (1 - t) * y[k] + t * y[k + 1] + ((1 - t) ** 3 - (1 - t)) / 6 * bend[k] + (t**3 - t) / 6 * bend[k + 1]


@functools.lru_cache(4096)
def weights(gamma):
    """The spline is linear in what it goes through."""
    return [natural_spline([mpf(k == j) for j in range(5)], gamma) for k in range(5)]


@functools.lru_cache(4096)
def tails(alpha, tau):
    """Lambda_0 to Lambda_4: what S = 1 / (1 + Lambda) says."""
    with mp.workdps(150 + int(4 * abs(mp.log10(tau)))):
        return [1 / s - 1 for s in visibility(alpha, 1 / tau)]


def Lambda(alpha, gamma, tau, off=lambda name: 0):
    """Lambda of the spline of S; off(name) is how far a program's weights and tails are off, relative to them."""
    if tau == 0:
        return mpf(0)
    if alpha == 1:
        return tau * tau / (2 * (1 + sqrt(1 + tau * tau)))  # D is 1/pi for every gamma
    exact = tails(alpha, tau)
    Lambdas = [L * (1 + off(f"tail{k}")) for k, L in enumerate(exact)]
    c = [w * (1 + off(f"weight{k}")) for k, w in enumerate(weights(gamma))]
    T = sum(w / (1 + L) for w, L in zip(c, Lambdas))
    H = sum(w * L / (1 + L) for w, L in zip(c, Lambdas))
    return mpf(0) if H <= 0 else Lambdas[0] if T * (1 + Lambdas[0]) <= 1 else H / T
