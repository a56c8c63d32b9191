# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A normal map: metal beaten with a round hammer, as a picture that goes on beyond its edges.

Each blow leaves a paraboloid, h = |x - p|^2 / 2; where blows meet, the lower one is left, with a rim that is smooth over some of their distance: the
soft minimum, whose slope is the mean of x - p by weights exp(-h / w). Blows fall by the sequence of the plastic number, which fills a square evenly.
"""
import numpy as np

SIDE, BLOWS = 256, 64
STEEPEST = 0.5  # slope at the edge of a dent, about
RIM = 0.006  # of h, in dents' widths


def slopes(side=SIDE, blows=BLOWS):
    """dz/du, dz/dv at the middles of texels; the top row is v = 1."""
    points = np.modf(0.5 + np.outer(np.arange(blows), (0.7548776662466927, 0.5698402909980532)))[0]
    middle = (np.arange(side) + 0.5) / side
    across = np.modf(middle - points[:, :1] + 1.5)[0] - 0.5  # [blow, column], to the nearest copy
    up = np.modf(1 - middle - points[:, 1:] + 1.5)[0] - 0.5  # [blow, row]
    h = (across[:, None, :] ** 2 + up[:, :, None] ** 2) / 2 * blows
    weight = np.exp((h.min(0) - h) / RIM)
    weight /= weight.sum(0)
    scale = STEEPEST * np.sqrt(blows) / 0.5
    return scale * np.einsum("kyx,kx->yx", weight, across), scale * np.einsum("kyx,ky->yx", weight, up)


def picture(side=SIDE):
    """[side, side, 3] of uint8: x, y, z of the normals, [-1, 1] as [0, 255]."""
    x, y = slopes(side)
    n = np.stack([-x, -y, np.ones_like(x)], -1) / np.sqrt(1 + x * x + y * y)[..., None]
    return np.round(127.5 + 127.5 * n).astype(np.uint8)
