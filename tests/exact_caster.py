# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""An exact caster for periodic heightfields, apart from POV-Ray and from scripts/crosscheck: for tests only.

Along a ray's shadow in the plane the surface is piecewise linear, with corners where the shadow crosses the lines
x = integer, y = integer and x + y = integer. A point that faces the direction is masked if and only if the surface
stands above the ray at one of these corners. Double precision; ties are the only doubt.
"""
import numpy as np


def height_at(h, x, y):
    """The surface over any points."""
    nx, ny = h.shape
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    u, w = x - i, y - j
    h00, h10, h01, h11 = (h[(i + a) % nx, (j + b) % ny] for a, b in ((0, 0), (1, 0), (0, 1), (1, 1)))
    lower = h00 + u * (h10 - h00) + w * (h01 - h00)
    upper = h11 + (1 - u) * (h01 - h11) + (1 - w) * (h10 - h11)
    return np.where(u + w < 1, lower, upper)


def on_line(h, family, line, along):
    """The surface on the line x = line, y = line or x + y = line, at y = along, x = along, x = along."""
    (nx, ny), j = h.shape, np.floor(along).astype(int)
    t = along - j
    if family == 0:
        a, b = h[line % nx, j % ny], h[line % nx, (j + 1) % ny]
    elif family == 1:
        a, b = h[j % nx, line % ny], h[(j + 1) % nx, line % ny]
    else:
        a, b = h[j % nx, (line - j) % ny], h[(j + 1) % nx, (line - j - 1) % ny]
    return (1 - t) * a + t * b


def visible(h, x, y, facing, v):
    """Which of the points over (x, y) the direction v sees."""
    z = height_at(h, x, y)
    seen = facing.copy()
    for family, (start, speed) in enumerate(((x, v[0]), (y, v[1]), (x + y, v[0] + v[1]))):
        if speed == 0:
            continue
        steps = int(np.ceil((h.max() - z.min()) / v[2] * abs(speed))) + 1
        first = np.floor(start).astype(int) + 1 if speed > 0 else np.ceil(start).astype(int) - 1
        for k in range(steps):
            line = first + k * (1 if speed > 0 else -1)
            t = (line - start) / speed
            along = y + t * v[1] if family == 0 else x + t * v[0]
            seen &= on_line(h, family, line, along) <= z + t * v[2]
    return seen
