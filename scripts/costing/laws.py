# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Power laws y = a x^p through measured points, and costs as sums of terms with positive coefficients."""
import itertools

import numpy as np


def power(xs, ys):
    """{"slope", "error", "factor", "points"}: least squares of log y on log x; the standard error is from the scatter about the line,
    None for two points; None for fewer."""
    x, y = np.log(np.asarray(xs, float)), np.log(np.asarray(ys, float))
    if len(x) < 2 or np.ptp(x) == 0:
        return None
    spread = ((x - x.mean()) ** 2).sum()
    slope = ((x - x.mean()) * (y - y.mean())).sum() / spread
    left = y - y.mean() - slope * (x - x.mean())
    error = float(np.sqrt((left ** 2).sum() / (len(x) - 2) / spread)) if len(x) > 2 else None
    return {"slope": float(slope), "error": error, "factor": float(np.exp(y.mean() - slope * x.mean())), "points": len(x)}


def at(law, x):
    return law["factor"] * x ** law["slope"]


def sums(terms, ys):
    """Coefficients >= 0 that make terms [point, term] fit ys in relative least squares: the best of all choices of terms."""
    terms, ys = np.asarray(terms, float), np.asarray(ys, float)
    best, found = np.inf, np.zeros(terms.shape[1])
    for count in range(1, terms.shape[1] + 1):
        for chosen in itertools.combinations(range(terms.shape[1]), count):
            columns = terms[:, chosen] / ys[:, None]
            scale = np.linalg.norm(columns, axis=0)
            c = np.linalg.lstsq(columns / scale, np.ones(len(ys)), rcond=None)[0] / scale
            left = ((columns @ c - 1) ** 2).sum()
            if (c >= 0).all() and left < best:
                best, found = left, np.zeros(terms.shape[1])
                found[list(chosen)] = c
    return found
