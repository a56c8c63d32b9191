# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The torus knot of Figure 10: a tube along a (2, 3) knot, as a PLY mesh; u runs along the tube, v around it.

The frame along the curve is the torus's own: tangent, the torus's normal made orthogonal to it, and their product. It closes.
"""
import numpy as np

P, Q = 2, 3  # turns about the axis, turns about the tube of the torus
RADIUS, AMPLITUDE, TUBE = 1.0, 0.45, 0.26


def curve(t):
    ring = RADIUS + AMPLITUDE * np.cos(Q * t)
    return np.stack([ring * np.cos(P * t), ring * np.sin(P * t), AMPLITUDE * np.sin(Q * t)], axis=-1)


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def mesh(along, around):
    """Vertices (position, normal, uv) of an (along + 1) x (around + 1) grid, its seams doubled, and triangles."""
    t = np.linspace(0, 2 * np.pi, along + 1)
    step = 1e-4
    tangent = unit(curve(t + step) - curve(t - step))
    core = np.stack([RADIUS * np.cos(P * t), RADIUS * np.sin(P * t), 0 * t], axis=-1)
    out = curve(t) - core
    out = unit(out - tangent * (out * tangent).sum(-1, keepdims=True))
    side = np.cross(tangent, out)
    phi = np.linspace(0, 2 * np.pi, around + 1)
    normal = np.cos(phi)[None, :, None] * out[:, None] + np.sin(phi)[None, :, None] * side[:, None]
    position = curve(t)[:, None] + TUBE * normal
    uv = np.stack(np.meshgrid(t / (2 * np.pi), phi / (2 * np.pi), indexing="ij"), axis=-1)
    first = (np.arange(along)[:, None] * (around + 1) + np.arange(around)).ravel()
    quads = np.stack([first, first + around + 1, first + around + 2, first + 1], axis=-1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    corners = position.reshape(-1, 3)[triangles]
    facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = (facing * normal.reshape(-1, 3)[triangles[:, 0]]).sum(-1) < 0
    triangles[inward] = triangles[inward][:, [0, 2, 1]]
    return np.concatenate([position, normal, uv], axis=-1).reshape(-1, 8), triangles


def write(path, along=480, around=48):
    vertices, triangles = mesh(along, around)
    names = ["x", "y", "z", "nx", "ny", "nz", "s", "t"]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(vertices)}", *(f"property float {n}" for n in names),
              f"element face {len(triangles)}", "property list uchar int vertex_indices", "end_header"]
    faces = np.empty(len(triangles), dtype=[("n", "u1"), ("v", "<i4", 3)])
    faces["n"], faces["v"] = 3, triangles
    path.write_bytes("\n".join(header).encode() + b"\n" + vertices.astype("<f4").tobytes() + faces.tobytes())
    return path
