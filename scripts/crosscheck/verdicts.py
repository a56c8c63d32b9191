# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The rules by which a number of a surface and a number of the core agree, differ as Smith is known to, or fail.

Statistical rows hold a measured value x, its standard error s with f degrees of freedom, and two intervals around the
core's value: `exact`, where it must lie if the model is true (a point, or as wide as what is known not to be exact about the
measurement or the quadrature), and `known`, which also has what Smith is known to be off by (known.py), or None.
- For either interval, p = P(|t_f| >= d/s), d the distance from x to it: Student's t, since s is estimated. Where the
  model is true, p is at least uniform on (0, 1).
- Holm's method over all n statistical rows of a run rejects, in ascending order, while p_(k) <= FAMILY / (n - k + 1).
  Whatever the rows' dependence (maps see the same bits, Eq. 11), the chance that a run rejects any true one is at most
  FAMILY. It is done once for `exact` and once for `known`.
- exact not rejected: AGREES. Else known not rejected: KNOWN. Else FAILS.

Bounded rows hold numbers that only rounding may move, with the bound derived where the row is made: AGREES or FAILS.

A row whose model has no range (`known` None) fails if its exact interval is rejected. On surfaces of the user's no source
says how far Smith is off: there `known` is what no masking can leave, 0 to 1 or independence to full correlation, and the row
says so.
"""
import numpy as np

from . import statistics

AGREES, KNOWN, FAILS = "agrees", "differs as Smith is known to", "FAILS"
FAMILY = statistics.FAMILY


def label(view):
    theta, phi = np.degrees(np.arctan2(np.hypot(view[0], view[1]), view[2])), np.degrees(np.arctan2(view[1], view[0]))
    return f"{theta:.4g} deg, azimuth {phi % 360:.4g}"


def bounded(check, surface, name, view, good, **values):
    """A row that rounding alone may move."""
    return {"check": check, "surface": surface, "map": name, "view": view, "verdict": AGREES if good else FAILS, **plain(values)}


def statistical(check, surface, name, view, measured, error, freedom, predicted, exact=None, known=None, **values):
    """A row to be judged with all others. exact, known: (low, high) absolute; known may hold its source as a third.

    "confidence" is the measured value's own 99 % interval.
    """
    quantile = statistics.student(int(freedom), 0.01)
    return {"check": check, "surface": surface, "map": name, "view": view, "verdict": None,
            **plain({"measured": measured, "standard_error": error, "freedom": freedom, "predicted": predicted,
                     "confidence": [measured - k * error for k in (quantile, -quantile)],
                     "deviation": measured / predicted - 1 if predicted else float("nan"),
                     "exact": exact or (predicted, predicted), "known": known[:2] if known else None,
                     "source": known[2] if known and len(known) > 2 else None, **values})}


def plain(values):
    """numpy's numbers as Python's."""
    def one(v):
        if isinstance(v, (tuple, list)):
            return [one(x) for x in v]
        return v.item() if isinstance(v, (np.generic, np.ndarray)) and np.ndim(v) == 0 else v
    return {k: one(v) for k, v in values.items()}


def chance(row, interval):
    """p of the interval; 0 where a number is missing, so that nothing unmeasured passes."""
    low, high = interval
    x, s = row["measured"], row["standard_error"]
    if not np.isfinite([low, high, x, s]).all():
        return 0.0
    distance = max(low - x, x - high, 0.0)
    if distance == 0:
        return 1.0
    return statistics.two_sided(distance / s, row["freedom"]) if s > 0 else 0.0


def holm(chances, family=FAMILY):
    """Which hypotheses are rejected."""
    rejected = [False] * len(chances)
    for rank, k in enumerate(sorted(range(len(chances)), key=chances.__getitem__)):
        if chances[k] > family / (len(chances) - rank):
            break
        rejected[k] = True
    return rejected


def judge(rows):
    """Writes the verdicts of the statistical rows, all at once."""
    open_rows = [r for r in rows if "exact" in r]
    exact = [chance(r, r["exact"]) for r in open_rows]
    known = [max(p, chance(r, r["known"])) if r["known"] else p for p, r in zip(exact, open_rows)]
    for r, p, q, off, wrong in zip(open_rows, exact, known, holm(exact), holm(known)):
        r["chance"] = p
        r["chance_known"] = q if r["known"] else None
        # rejected within a known range that includes the exact one, it is rejected there, too
        r["verdict"] = AGREES if not off else KNOWN if r["known"] and not wrong else FAILS
    return rows


def worst(rows):
    order = [AGREES, KNOWN, FAILS]
    return max((r["verdict"] for r in rows), key=order.index)
