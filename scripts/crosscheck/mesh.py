# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The heightfield's triangles with M baked into their vertices, and the slopes of the triangles as they are baked.

Positions go with M, heights stay: (x, y, h) becomes (M (x, y), h), Eq. (9). A mirror turns the triangles over, which
an observer above does not notice; their upward normals are what is meant by normals.
"""
import numpy as np

TRIANGLES = (((0, 0), (1, 0), (0, 1)), ((1, 1), (0, 1), (1, 0)))  # L and U as corners of a cell


def vertices(h, m):
    """[Nx+1, Ny+1, 3]: the corners of one period, its far sides included, at M (i, j)."""
    nx, ny = h.shape
    i, j = np.meshgrid(np.arange(nx + 1.0), np.arange(ny + 1.0), indexing="ij")
    return np.stack([m[0, 0] * i + m[0, 1] * j, m[1, 0] * i + m[1, 1] * j, np.pad(h, (0, 1), mode="wrap")], -1)


def triangles(shape):
    """[i, j, L|U, 3]: indices into the flattened vertices."""
    nx, ny = shape
    i, j = np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij")
    return np.stack([np.stack([(i + a) * (ny + 1) + j + b for a, b in corners], -1) for corners in TRIANGLES], 2)


def baked_slopes(h, m):
    """Slopes [2, i, j, L|U] of the transformed facets, from the cross products of their baked edges."""
    corner = vertices(h, m).reshape(-1, 3)[triangles(h.shape)]
    normal = np.cross(corner[..., 1, :] - corner[..., 0, :], corner[..., 2, :] - corner[..., 0, :])
    return np.stack([-normal[..., 0] / normal[..., 2], -normal[..., 1] / normal[..., 2]])
