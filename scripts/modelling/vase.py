# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A turned vase with a wall: foot, belly, neck and lip outside, then down again inside. u runs around, as the brush did."""
import numpy as np

from . import curves

# r, z
PROFILE = [(0, 0.0), (0.2, 0.0), (0.255, 0.012), (0.25, 0.05), (0.205, 0.10), (0.24, 0.20), (0.37, 0.40), (0.43, 0.62), (0.39, 0.84), (0.26, 1.04),
           (0.175, 1.18), (0.165, 1.28), (0.21, 1.37), (0.262, 1.415), (0.255, 1.43), (0.195, 1.37), (0.145, 1.28), (0.15, 1.15), (0.2, 1.04), (0.33, 0.84)]


def vase(fine=1.0):
    v = np.linspace(0, 1, round(320 * fine) + 1)
    r, z = curves.through(PROFILE, v).T
    r = np.maximum(r, 0)
    r[0] = 0
    return curves.revolved(r, z, v, round(160 * fine))
