# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A rubber balloon as it is inflated.

At rest it is a limp pear with a neck: z from the lip at 0 to the top at 1, radius r(z). Inflated by q in [0, 1], a parallel is stretched by
1 + (P - 1) q b(z), a piece of the axis by 1 + (A - 1) q b(z); b is 0 in the neck, which stays as it is, and 1 in the body: the body, a
slender 1 : 3 at rest, comes out rounder and larger. Meridians of the body are thus stretched by A at its waist and by P at the top, where both
directions are alike; parallels by P throughout. In rubber's law pressure decides q, not here: what matters is that the stretch is large,
smooth and not the same in both directions.
"""
import numpy as np

from . import curves

PARALLELS, AXIS = 3.4, 1.9
NECK, RISE = 0.10, 0.25  # b rises over RISE from NECK on
FRAMES = 24


def profile(rows):
    """(z, r) at rest, from the lip to the top."""
    shape = np.array([(0, 0.062), (0.02, 0.070), (0.045, 0.058), (0.10, 0.052), (0.17, 0.062), (0.28, 0.105), (0.45, 0.155), (0.62, 0.170),
                      (0.78, 0.150), (0.90, 0.105), (1.0, 0.0)])
    t = np.sin(np.pi / 2 * np.arange(rows + 1) / rows)  # dense at the top
    z, squared = curves.through(np.column_stack([shape[:, 0], 0 * shape[:, 0], shape[:, 1] ** 2]), t)[:, [0, 2]].T
    r = np.sqrt(np.maximum(squared, 0))
    r[-1] = 0
    return z, r


def body(z):
    t = np.clip((z - NECK) / RISE, 0, 1)
    return t * t * (3 - 2 * t)


def inflated(q, fine=1.0):
    z, r = profile(round(160 * fine))
    fill = q * body(z)
    along = 1 + (AXIS - 1) * (fill[1:] + fill[:-1]) / 2
    height = np.concatenate([[0], np.cumsum(np.diff(z) * along)])
    return curves.revolved(r * (1 + (PARALLELS - 1) * fill), height, z, round(128 * fine))


def frames(fine=1.0, count=FRAMES):
    """[rest, ..., full]: q rises evenly."""
    return [inflated(k / (count - 1), fine) for k in range(count)]
