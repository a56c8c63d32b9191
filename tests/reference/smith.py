# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Smith's Lambda to 30 digits by quadrature, and its logarithmic derivatives to about 8.

Definition (Smith 1967): Lambda(tau) = (1/mu) int_mu^inf (q - mu) P2(q) dq with mu = 1/tau and P2 the distribution of
slopes along the view. For an isotropic surface with survival Q(x) = P(slope^2 > x), writing P2 through Q and
integrating by parts twice,
    Lambda(tau) = (1/pi) int_0^inf Q((1 + t^2)/tau^2) t^2/(1 + t^2) dt.
With t = e^s the trapezoid rule converges geometrically: the integrand is analytic in |Im s| < pi/2. The step is
halved until 30 digits stand. GGX and Beckmann have closed forms; crosscheck() holds everything to the definition.
"""
import functools
import math

import mpmath as mp
import numpy as np

import families


def lambda_by_quadrature(ndf, alpha, gamma, tau, digits=30):
    """The integral above, to `digits`. STD's Q falls only as t^(2 - 2 gamma): there t = exp(u + e^(u - u0)), which is
    t = e^u up to u0 and reaches any t soon after it; past the last singularity, |t|^2 = 1 + b tau^2, the integrand
    is analytic in every sector, so that the trapezoid rule keeps its geometric convergence."""
    with mp.workdps(digits + 14):
        left, right = families.spread(ndf, alpha, gamma)
        low = -0.92 * digits - left
        if ndf == "std":
            u0 = float(mp.log(1 + (gamma - 1) * (alpha * tau) ** 2)) / 2 + 1
            high = u0 + float(mp.log1p((2.4 * digits + 35) / (2 * gamma - 3) + abs(u0)))
        else:
            high = float(mp.log(tau + 1)) + 2.4 * digits + 10 + right

        def term(s):
            growth = 1
            if ndf == "std":
                more = mp.exp(s - u0)
                s, growth = s + more, 1 + more
            t = mp.exp(s)
            t2 = t * t
            return families.survival(ndf, alpha, gamma, (1 + t2) / tau ** 2) * t2 * t / (1 + t2) * growth

        step = mp.mpf("0.25")
        count = int((high - low) / step)
        total = mp.fsum(term(low + k * step) for k in range(count + 1)) * step
        for _ in range(5):
            finer = (total + step * mp.fsum(term(low + (k + mp.mpf(1) / 2) * step) for k in range(count))) / 2
            step, count = step / 2, count * 2
            if abs(finer - total) <= abs(finer) * mp.mpf(10) ** (-digits / 2 - 1):
                return finer / mp.pi  # geometric convergence: the error of `finer` is the square of this
            total = finer
    raise ArithmeticError(f"no convergence: {ndf} {alpha} {gamma} {tau}")


def lambda_gtr(alpha, gamma, tau):
    return lambda_by_quadrature("gtr", alpha, gamma, tau)


@functools.lru_cache(None)
def Lambda(ndf, alpha, gamma, tau, digits=30):
    if tau == 0:
        return mp.mpf(0)
    if ndf == "beckmann":
        c = 1 / (alpha * tau)
        with mp.workdps(100 + int(4 * mp.log10(1 + c))):
            return mp.exp(-c * c) / (2 * c * mp.sqrt(mp.pi)) - mp.erfc(c) / 2
    if ndf == "ggx" or (ndf == "gtr" and alpha == 1):
        z = (alpha * tau) ** 2
        with mp.workdps(150):
            return (mp.sqrt(1 + z) - 1) / 2
    return lambda_by_quadrature(ndf, alpha, gamma, tau, digits)


def log_coarse(ndf, alpha, gamma, tau):
    """ln Lambda in double precision, for derivatives only."""
    if ndf in ("ggx", "beckmann") or (ndf == "gtr" and alpha == 1):
        value = Lambda(ndf, mp.mpf(alpha), mp.mpf(gamma), mp.mpf(tau))
        return float(mp.log(value)) if value > 0 else -math.inf
    left, right = families.spread(ndf, alpha, gamma)
    if ndf == "std":  # the substitution of lambda_by_quadrature
        u0 = math.log1p((gamma - 1) * (alpha * tau) ** 2) / 2 + 1
        u = np.arange(-16 - left, u0 + math.log1p(60 / (2 * gamma - 3) + u0), 0.1)
        s, growth = u + np.exp(u - u0), np.log1p(np.exp(u - u0))
    else:
        s, growth = np.arange(-16 - left, np.log1p(tau) + 42 + right, 0.1), 0
    if ndf == "gtr":
        t2 = np.exp(2 * s)
        a = alpha * alpha
        ln_q = np.log1p(-(1 - a) * tau * tau / (1 + t2 + tau * tau))
        close = (1 - a) * tau * tau > 0.5 * (1 + t2 + tau * tau)
        ln_q = np.where(close, np.log((1 + t2 + a * tau * tau) / (1 + t2 + tau * tau)), ln_q)
        d, ln_a = 1 - gamma, np.log(a)
        ln_Q = np.log(ln_q / ln_a if abs(d * ln_a) < 1e-7 else np.expm1(d * ln_q) / np.expm1(d * ln_a))
    else:
        ln_Q = families.log_survival(ndf, alpha, gamma, np.logaddexp(0, 2 * s) - 2 * np.log(tau))
    return float(np.logaddexp.reduce(ln_Q + 3 * s - np.logaddexp(0, 2 * s) + growth) + np.log(0.1 / np.pi))


@functools.lru_cache(None)
def derivatives(ndf, alpha, gamma, tau):
    """d ln Lambda / d ln of alpha, gamma, tau."""
    if tau == 0:
        return 0, 0, 0
    point = [float(alpha), float(gamma), float(tau)]
    if ndf == "beckmann" and 1 / (point[0] * point[2]) > 1e4:
        return 0, 0, 0
    result = []
    for i in range(3):
        if (i == 0 and ndf == "phong") or (i == 1 and ndf not in ("gtr", "std", "phong")):
            result.append(0)
            continue
        h = 1e-4 if not (ndf == "gtr" and i == 0 and point[0] * (1 + 1e-4) >= 1) else -1e-4
        if ndf == "std" and i == 1:
            h = min(h, 0.01 * (point[1] - 1.5) / point[1])  # gamma > 3/2
        if h > 0:
            high, low = ([x * (1 + sign * h) if k == i else x for k, x in enumerate(point)] for sign in (1, -1))
            width = 2 * h
        else:  # alpha = 1: one-sided
            high, low, width = point, [point[0] * (1 + h), point[1], point[2]], -h
        L1, L0 = log_coarse(ndf, *high), log_coarse(ndf, *low)
        result.append(mp.mpf((L1 - L0) / width) if L0 > -math.inf else 0)
    return tuple(result)


def crosscheck():
    """Quadrature against the definition itself and against the closed forms of the seed, Eq. (35)-(39)."""
    mp.mp.dps = 20
    for ndf, alpha, gamma, tau in (("ggx", .5, 2, 3), ("beckmann", .4, 2, 5), ("gtr", .6, 1.5, 2), ("gtr", .3, 3, 4),
                                   ("std", .5, 2.5, 2), ("phong", 1, 3, 2), ("sheen", .4, 0, 2)):
        alpha, gamma, tau = mp.mpf(alpha), mp.mpf(gamma), mp.mpf(tau)

        def slopes(x):
            cos2 = 1 / (1 + x)
            return families.density(ndf, alpha, gamma, cos2, x * cos2) * cos2 ** 2

        x = mp.mpf("0.7")
        assert abs(mp.diff(lambda x: families.survival(ndf, alpha, gamma, x), x) / (-mp.pi * slopes(x)) - 1) < 1e-12
        assert abs(families.survival(ndf, alpha, gamma, mp.mpf(10) ** -30) - 1) < mp.mpf(10) ** -15
        def along(q):
            return 2 * mp.quad(lambda r: slopes(q * q + r * r), [0, 1, 8, mp.inf], maxdegree=5)

        defined = tau * mp.quad(lambda q: (q - 1 / tau) * along(q), [1 / tau, 1, 8, mp.inf], maxdegree=5)
        error = abs(defined / Lambda(ndf, alpha, gamma, tau) - 1)
        print(f"definition {ndf} {mp.nstr(gamma, 3)}: {mp.nstr(error, 3)}")
        assert error < 1e-8
    mp.mp.dps = 50
    worst = mp.mpf(0)
    for alpha in (mp.mpf("0.003"), mp.mpf("0.2"), mp.mpf("0.8")):
        for tau in (mp.mpf("0.3"), mp.mpf(4), mp.mpf(500)):
            a, mu = alpha ** 2, 1 / tau
            A, B = mp.sqrt(mu ** 2 + a), mp.sqrt(mu ** 2 + 1)
            A4, B4 = 8 * a * a + 8 * a + 8, A
            S = {0: 2 / (1 + mp.sqrt(1 / mu ** 2 + 1)),
                 1: mu * mp.log(a) / (A - B + mu * mp.log(a * (mu + B) / (mu + A))),
                 2: 2 / (1 + mp.sqrt(a / mu ** 2 + 1)),
                 3: 4 * (a + 1) * mu * A / (a * (3 * a + 1) + 2 * mu * (a + 1) * (mu + A)),
                 4: 2 * A4 * mu * B4 ** 3 / (A4 * mu * (B4 ** 3 + mu ** 3)
                    + 3 * a * (a * (5 * a * a + 2 * a + 1) + 4 * mu ** 2 * (2 * a * a + a + 1)))}
            for gamma, value in S.items():
                exact = value if gamma != 4 else value
                worst = max(worst, abs(exact * (1 + lambda_gtr(alpha, mp.mpf(gamma), tau)) - 1))
                assert abs(log_coarse("gtr", float(alpha), gamma, float(tau))
                           - mp.log(lambda_gtr(alpha, mp.mpf(gamma), tau))) < 1e-9
    print("closed forms (35)-(39): worst", mp.nstr(worst, 3))
    assert worst < mp.mpf(10) ** -28


if __name__ == "__main__":
    crosscheck()
