# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A turned pot with lid, spout and handle, for what the seed of image-based lighting shows on the Utah teapot. On body and lid u runs around, as
the brush did; on spout and handle around the tube."""
import numpy as np

from . import curves, mesh

# r, z: foot, belly, shoulder, a groove, the lid and its knob
PROFILE = [(0, 0.0), (0.52, 0.0), (0.60, 0.015), (0.64, 0.06), (0.80, 0.20), (0.96, 0.42), (1.0, 0.62), (0.94, 0.82), (0.80, 1.0), (0.66, 1.10), (0.625, 1.135), (0.60, 1.125),
           (0.575, 1.14), (0.54, 1.17), (0.36, 1.26), (0.16, 1.315), (0.085, 1.345), (0.075, 1.39), (0.12, 1.43), (0.145, 1.475), (0.11, 1.525), (0, 1.545)]
# x, y, z, r; r is 0 within the body
SPOUT = [(0.70, 0, 0.36, 0), (0.92, 0, 0.42, 0.19), (1.20, 0, 0.55, 0.15), (1.38, 0, 0.80, 0.105), (1.50, 0, 1.03, 0.085), (1.60, 0, 1.16, 0)]
HANDLE = [(-0.74, 0, 1.0, 0), (-0.95, 0, 1.06, 0.075), (-1.25, 0, 1.05, 0.075), (-1.48, 0, 0.88, 0.075), (-1.42, 0, 0.58, 0.075), (-1.16, 0, 0.36, 0.075), (-0.86, 0, 0.28, 0.075),
          (-0.72, 0, 0.26, 0)]


def teapot(fine=1.0):
    v = np.linspace(0, 1, round(280 * fine) + 1)
    r, z = curves.through([(r, z, 0) for r, z in PROFILE], v)[:, :2].T
    r = np.maximum(r, 0)
    r[[0, -1]] = 0
    rows, columns = round(96 * fine), round(48 * fine)
    tubes = [curves.tube(spine, rows=rows, columns=columns) for spine in (SPOUT, HANDLE)]
    return mesh.joined([curves.revolved(r, z, v, round(192 * fine)), *tubes])
