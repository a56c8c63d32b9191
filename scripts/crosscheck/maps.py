# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The linear maps M, the views, and how directions follow M."""
import numpy as np

def rotation(angle):
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def random_mirror(seed):
    """A seeded M with det < 0: rotation, stretches between 1/2.5 and 2.5 with one axis turned over, rotation."""
    rng = np.random.default_rng(seed)
    turn, spin = rng.uniform(0, 2 * np.pi, 2)
    scale = 2.5 ** rng.uniform(-1, 1, 2) * [1.0, -1.0]
    return rotation(turn) @ np.diag(scale) @ rotation(spin)


def direction(theta_degrees, phi_degrees):
    theta, phi = np.radians(theta_degrees), np.radians(phi_degrees)
    return np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


def carried(m, v):
    """M v / |M v|: a direction goes with the surface, Eq. (11)."""
    w = np.array([*(m @ v[:2]), v[2]])
    return w / np.linalg.norm(w)
