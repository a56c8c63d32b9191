# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Means over realisations, their standard errors, and how far chance may carry them."""
import functools
import math
import threading

import mpmath
import numpy as np

ONE_AT_A_TIME = threading.Lock()  # mpmath changes its precision on the way, for all threads
FAMILY = 0.01  # the chance that a right core fails anywhere in one validation
NORMAL = 10**9  # degrees of freedom of a normal value


def standard_error(values):
    """Of the mean over realisations, the first axis."""
    values = np.asarray(values, float)
    return values.std(0, ddof=1) / np.sqrt(len(values))


def ratio(top, bottom):
    """(sum top / sum bottom, its standard error) from independent blocks, the last axis."""
    value = top.sum(-1) / bottom.sum(-1)
    count = top.shape[-1]
    residual = top - value[..., None] * bottom
    return value, np.sqrt((residual**2).sum(-1) * count / (count - 1)) / bottom.sum(-1)


def folded(values, folds):
    """Sums over blocks [..., block] of a square of them; with folds, of a block and its mirror images in both axes, which
    are the same piece of surface and scatter alike."""
    if not folds:
        return values
    side = math.isqrt(values.shape[-1])
    square = values.reshape(*values.shape[:-1], side, side)
    half = (square + square[..., ::-1, :])[..., : side // 2, :]
    half = (half + half[..., ::-1])[..., : side // 2]
    return half.reshape(*values.shape[:-1], -1)


def dependence(both, a, b, every):
    """(sum both / sum of what independence within each class predicts, its standard error); [class, block]."""
    total_a, total_b, count = (x.sum(-1, keepdims=True) for x in (a, b, every))
    count = np.maximum(count, 1)  # an empty class adds nothing
    expected = (total_a * total_b / count).sum()
    value = both.sum() / expected
    change = (a * total_b + b * total_a) / count - every * total_a * total_b / count**2
    residual = (both - value * change).sum(0) / expected
    return float(value), float(np.sqrt((residual**2).sum() * residual.size / (residual.size - 1)))


def small_sample(count):
    """Mean of a sample's standard deviation over the true one, for normal values."""
    return math.sqrt(2 / (count - 1)) * math.exp(math.lgamma(count / 2) - math.lgamma((count - 1) / 2))


@functools.lru_cache(None)
def two_sided(t, freedom):
    """P(|Student's t| >= t); of a normal value from NORMAL degrees of freedom on."""
    if freedom >= NORMAL:
        return math.erfc(t / math.sqrt(2))
    with ONE_AT_A_TIME:
        freedom = mpmath.mpf(freedom)
        return float(mpmath.betainc(freedom / 2, 0.5, 0, freedom / (freedom + mpmath.mpf(t) ** 2), regularized=True))


@functools.lru_cache(None)
def student(freedom, level):
    """The t that |Student's t| exceeds with probability `level`."""
    low, high = 0.0, 2.0
    while two_sided(high, freedom) > level:
        high *= 2
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if two_sided(middle, freedom) > level else (low, middle)
    return high


def chance_variation(errors):
    """Mean and standard deviation of the total variation that normal errors of the bins make by themselves."""
    errors = np.asarray(errors)
    return (float(0.5 * np.sqrt(2 / np.pi) * errors.sum()),
            float(0.5 * np.sqrt((1 - 2 / np.pi) * (errors**2).sum())))
