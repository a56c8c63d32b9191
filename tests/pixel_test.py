# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Whether two renderers make the same picture: each renders K times with seeds of its own, and Welch's t of each pixel's mean says
whether they differ.

Where they do not, |t| follows Student's distribution of the 2 K - 2 degrees of freedom (a little fewer by Welch, for unequal variances;
K - 1 at the least). Its mean is E = 2 sqrt(d) Γ((d+1)/2) / ((d-1) sqrt(pi) Γ(d/2)), and its variance d/(d-2) - E². The mean of |t| over n
pixels, which are independent where the filter is a box, must stay below E(K - 1) + 4 standard errors: what is off by half a
standard error everywhere raises it by a tenth and is found from some hundred pixels on."""
import math

import numpy as np


def expected(d):
    """Mean and standard deviation of |t|."""
    mean = 2 * math.sqrt(d) * math.exp(math.lgamma((d + 1) / 2) - math.lgamma(d / 2)) / ((d - 1) * math.sqrt(math.pi))
    return mean, math.sqrt(d / (d - 2) - mean**2)


def t_of(first, second):
    """Of K pictures each (K x height x width x 3): t of each pixel's luminance; 0 where neither varies and both agree."""
    weights = np.array((0.2126, 0.7152, 0.0722))
    a, b = np.asarray(first, dtype=float) @ weights, np.asarray(second, dtype=float) @ weights
    spread = np.sqrt(a.var(axis=0, ddof=1) / len(a) + b.var(axis=0, ddof=1) / len(b))
    difference = a.mean(axis=0) - b.mean(axis=0)
    rounding = 1e-5 * (np.abs(a.mean(axis=0)) + np.abs(b.mean(axis=0)))  # sums of floats, where there is no noise
    return np.where(np.abs(difference) <= rounding, 0, difference / np.maximum(spread, 1e-30))


def judge(first, second):
    """(mean |t|, its bound) over the pixels that vary."""
    t = np.abs(t_of(first, second))
    seen = t[t > 0]
    mean, deviation = expected(len(first) - 1)
    return float(seen.mean()), mean + 4 * deviation / math.sqrt(seen.size)
