# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Beckmann's D, G1, sigma and height-correlated G2 under M in closed form, apart from the C core; and wrong ones.

Lambda of the isotropic surface is textbook (Walter et al. 2007, with erfc); under M the view is M^-1 v, the normal M^T m.
"""
import math

import numpy as np


class Core:
    """Stands where crosscheck.predict.Core stands."""

    def __init__(self, mutant=None):
        self.mutant = mutant

    def prepared(self, alpha, m):
        return (alpha * 1.05 if self.mutant == "alpha 5 % large" else alpha,
                np.linalg.inv(m) if self.mutant == "M inverse" else m)

    def smith(self, alpha, m, v):
        alpha, m = self.prepared(alpha, m)
        reach = alpha * np.hypot(*np.linalg.solve(m, v[:2])) / v[2]
        if reach == 0:
            return 0.0
        c = 1 / reach
        return math.exp(-c * c) / (2 * c * math.sqrt(math.pi)) - math.erfc(c) / 2

    def masking(self, alpha, m, directions):
        Lambda = np.array([self.smith(alpha, m, v) for v in directions])
        return 1 / (1 + Lambda), np.array([v[2] for v in directions]) * (1 + Lambda)

    def joint(self, alpha, m, a, b):
        right = 1 / (1 + self.smith(alpha, m, a) + self.smith(alpha, m, b))
        wrong = 1 / (1 + self.smith(alpha, m, a))
        return (wrong if self.mutant == "G1 for G2" else right, wrong if "G1" in (self.mutant or "") else right)

    def distribution(self, alpha, m, normals):
        alpha, m = self.prepared(alpha, m)
        u = np.concatenate([normals[..., :2] @ m, normals[..., 2:]], -1)  # M^T m
        length = np.linalg.norm(u, axis=-1)
        u = u / length[..., None]
        tan2 = (u[..., 0] ** 2 + u[..., 1] ** 2) / u[..., 2] ** 2
        d = np.exp(-tan2 / alpha**2) / (np.pi * alpha**2 * u[..., 2] ** 4)
        determinant = 1 if self.mutant == "no determinant" else abs(np.linalg.det(m))
        return determinant * d / length ** (3 if self.mutant == "cube for fourth power" else 4)
