# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A tabulated distribution by its definition: P22 constant in the cells of a grid of slopes s, normals m ~ (-s, 1).

    D0(m) = P22(-m_xy / m_z) / m_z^4,    sigma0(u) = int max(0, u_z - u_xy.s) P22(s) ds,
exactly: the integral over a rectangle of the positive part of a linear function L with gradient k is the second difference of
max(0, L)^3 / (6 k_x k_y) over its corners. That cancels by the inverse cube of what L changes across a cell: hence the digits.
"""
import mpmath as mp

DIGITS = 160


class Histogram:
    def __init__(self, weights):
        """Rows of weights, from y_min on, as in a material."""
        self.weights = [[mp.mpf(w) for w in row] for row in weights]
        self.rows, self.columns = len(weights), len(weights[0])
        self.total = mp.fsum(w for row in self.weights for w in row)
        pad = [[mp.mpf(0)] * (self.columns + 2)] * 1
        padded = pad + [[mp.mpf(0), *row, mp.mpf(0)] for row in self.weights] + pad
        # what each corner weighs: the second difference of the cells around it
        self.corners = [[padded[j][i] - padded[j][i + 1] - padded[j + 1][i] + padded[j + 1][i + 1]
                         for i in range(self.columns + 1)] for j in range(self.rows + 1)]
        def mean(power, along):
            lines = zip(*self.weights) if along == 0 else self.weights
            return mp.fsum(mp.fsum(line) * ((k + 1) ** (power + 1) - k ** (power + 1)) / (power + 1)
                           for k, line in enumerate(lines)) / self.total
        self.mean = [mean(1, 0), mean(1, 1)]  # in cells
        cross = mp.fsum(w * (i + mp.mpf(1) / 2) * (j + mp.mpf(1) / 2) for j, row in enumerate(self.weights)
                        for i, w in enumerate(row)) / self.total
        self.covariance = [mean(2, 0) - self.mean[0] ** 2, cross - self.mean[0] * self.mean[1], mean(2, 1) - self.mean[1] ** 2]

    def cells(self, bounds):
        return (bounds[1] - bounds[0]) / self.columns, (bounds[3] - bounds[2]) / self.rows

    def density(self, bounds, slope):
        """P22"""
        size = self.cells(bounds)
        i, j = (int(mp.floor((slope[k] - bounds[2 * k]) / size[k])) for k in range(2))
        if not (0 <= i < self.columns and 0 <= j < self.rows):
            return mp.mpf(0)
        return self.weights[j][i] / self.total / (size[0] * size[1])

    def part(self, bounds, u, sign):
        """int max(0, sign (u_z - u_xy.s)) P22 ds"""
        with mp.workdps(DIGITS):
            size = self.cells(bounds)
            scale = abs(u[0]) + abs(u[1]) + abs(u[2])
            # a gradient of 0 is the limit of small ones: 1e-40 of the answer
            step = [-sign * u[k] * size[k] or scale * mp.mpf(10) ** -40 for k in range(2)]
            at = sign * (u[2] - u[0] * bounds[0] - u[1] * bounds[2])
            total = mp.mpf(0)
            for j, row in enumerate(self.corners):
                for i, weight in enumerate(row):
                    L = at + i * step[0] + j * step[1]
                    if weight and L > 0:
                        total += weight * L * L * L
            return total / (6 * step[0] * step[1] * self.total)

    def level(self, bounds, u):
        """int (u_z - u_xy.s) P22 ds"""
        size = self.cells(bounds)
        return u[2] - sum(u[k] * (bounds[2 * k] + self.mean[k] * size[k]) for k in range(2))

    def spread(self, bounds, u):
        """The standard deviation of u_xy.s"""
        x, y = (u[k] * self.cells(bounds)[k] for k in range(2))
        xx, xy, yy = self.covariance
        return mp.sqrt(x * x * xx + 2 * x * y * xy + y * y * yy)
