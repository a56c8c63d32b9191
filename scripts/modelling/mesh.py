# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Grids of points as triangle meshes with texture coordinates, and PLY files of them.

A grid is [rows, columns + 1, 3]: u runs along a row from 0 to 1, closed (the last point is the first), v from row to row; dp/du x dp/dv is
outside. A row that is one point is a pole: it has a point for each sector, in the middle of its u, and one triangle for each, so that
none is without area. Corners at one place with other texture coordinates are points of their own, as musurf's tension wants them.
"""
import dataclasses
import os

import numpy as np


@dataclasses.dataclass(frozen=True)
class Mesh:
    points: np.ndarray  # [n, 3]
    uv: np.ndarray      # [n, 2]
    faces: np.ndarray   # [f, 3]

    def moved(self, move):
        """The same with `move` applied to the points."""
        return dataclasses.replace(self, points=move(self.points))


def of_grid(grid, v):
    """The mesh of a closed grid; v of each row."""
    rows, columns = grid.shape[0], grid.shape[1] - 1
    pole = np.ptp(grid, axis=1).max(-1) == 0
    u = np.where(pole[:, None], (np.arange(columns + 1) + 0.5) / columns, np.arange(columns + 1) / columns)
    index = np.arange(rows * (columns + 1)).reshape(rows, columns + 1)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    low, high = np.broadcast_to(pole[:-1, None], a.shape), np.broadcast_to(pole[1:, None], a.shape)
    first = np.stack([a, b, np.where(high, d, c)], -1)[~low]  # at the pole below, a is b
    second = np.stack([a, c, d], -1)[~high]
    faces = np.concatenate([first, second])
    used = np.unique(faces)
    back = np.full(index.size, -1)
    back[used] = np.arange(len(used))
    uv = np.stack([u, np.broadcast_to(np.asarray(v)[:, None], u.shape)], -1)
    return Mesh(grid.reshape(-1, 3)[used], uv.reshape(-1, 2)[used], back[faces])


def joined(meshes):
    starts = np.cumsum([0] + [len(mesh.points) for mesh in meshes])
    return Mesh(np.concatenate([mesh.points for mesh in meshes]), np.concatenate([mesh.uv for mesh in meshes]),
                np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts)]))


def around(columns):
    """[columns + 1, 2]: cosine and sine of a turn, the last exactly the first."""
    angle = 2 * np.pi * (np.arange(columns + 1) % columns) / columns
    return np.stack([np.cos(angle), np.sin(angle)], -1)


def write(mesh, path):
    """Binary PLY; beside, then renamed: no half mesh replaces a whole one, also where two programs make it at once."""
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(mesh.points)}\n"
            + "".join(f"property float {name}\n" for name in ("x", "y", "z", "s", "t"))
            + f"element face {len(mesh.faces)}\nproperty list uchar int vertex_indices\nend_header\n")
    faces = np.empty(len(mesh.faces), dtype=[("n", "u1"), ("corner", "<i4", 3)])
    faces["n"], faces["corner"] = 3, mesh.faces
    fresh = path.with_name(f"{path.name}.{os.getpid()}.new")
    fresh.write_bytes(head.encode() + np.hstack([mesh.points, mesh.uv]).astype("<f4").tobytes() + faces.tobytes())
    fresh.replace(path)
