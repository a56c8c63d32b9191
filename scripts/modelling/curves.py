# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Smooth curves through few given points, tubes around them, and surfaces of revolution."""
import numpy as np

from . import mesh


def through(points, at):
    """The curve through three or more points (rows of any length) at parameters in [0, 1]: cubic Hermite pieces whose parameter is the length
    of the polygon in the first three columns, tangents those of the parabola through each point and its neighbours."""
    p = np.asarray(points, float)
    knot = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(p[:, :3], axis=0), axis=1))])
    step, slope = np.diff(knot), np.diff(p, axis=0) / np.diff(knot)[:, None]
    inner = (step[1:, None] * slope[:-1] + step[:-1, None] * slope[1:]) / (step[1:] + step[:-1])[:, None]
    tangent = np.concatenate([[2 * slope[0] - inner[0]], inner, [2 * slope[-1] - inner[-1]]])
    x = np.asarray(at) * knot[-1]
    k = np.clip(np.searchsorted(knot, x, side="right") - 1, 0, len(step) - 1)
    t = ((x - knot[k]) / step[k])[:, None]
    h = step[k][:, None]
    return ((2 * t**3 - 3 * t**2 + 1) * p[k] + (t**3 - 2 * t**2 + t) * h * tangent[k]
            + (3 * t**2 - 2 * t**3) * p[k + 1] + (t**3 - t**2) * h * tangent[k + 1])


def clustered(rows):
    """From 0 to 1, denser toward both ends, where round caps need it."""
    return (1 - np.cos(np.pi * np.arange(rows + 1) / rows)) / 2


def tube(spine, side=(0, 1, 0), flat=1.0, rows=96, columns=64):
    """Around a plane curve. `spine`: rows x, y, z, r; r is 0 at both ends, which come out round, for what is interpolated is r^2.
    `side` is normal to the curve's plane; along it the radius is multiplied by `flat`."""
    spine, side = np.asarray(spine, float), np.asarray(side, float) / np.linalg.norm(side)
    v = clustered(rows)
    c = through(np.column_stack([spine[:, :3], spine[:, 3] ** 2]), v)
    ahead = np.gradient(c[:, :3], v, axis=0)
    ahead -= (ahead @ side)[:, None] * side
    ahead /= np.linalg.norm(ahead, axis=1)[:, None]
    other = np.cross(ahead, side)
    r = np.sqrt(np.maximum(c[:, 3], 1e-6 * c[:, 3].max()))
    r[[0, -1]] = 0
    turn = mesh.around(columns)
    ring = flat * turn[None, :, :1] * side + turn[None, :, 1:] * other[:, None]
    return mesh.of_grid(c[:, None, :3] + r[:, None, None] * ring, v)


def revolved(radius, height, v, columns):
    """Of the profile (radius, height), walked with outside to the right: upwards on the outer wall. v: of each of its points."""
    turn = mesh.around(columns)
    ring = radius[:, None, None] * turn[None]
    return mesh.of_grid(np.concatenate([ring, np.broadcast_to(height[:, None, None], (*ring.shape[:2], 1))], -1), v)
