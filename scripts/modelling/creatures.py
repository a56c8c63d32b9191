# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Two rubber animals made of tubes, and what is done to them: maps of space, of which those that keep volume are marked *.

Both look along +x and stand on z = 0; lengths are about those of the animal at rest. The animals stand for the birds and dogs of
Figure 6 of *Microsurface Transformations* (Atanasov et al. 2022), whose models are not published.
"""
import numpy as np

from . import curves, mesh


def bird(fine=1.0):
    rows, columns = round(128 * fine), round(80 * fine)
    body = curves.tube([(-0.78, 0, 0.66, 0), (-0.62, 0, 0.62, 0.10), (-0.34, 0, 0.46, 0.30), (0.02, 0, 0.40, 0.39), (0.32, 0, 0.56, 0.27),
                        (0.38, 0, 0.84, 0.17), (0.42, 0, 1.08, 0.23), (0.58, 0, 1.17, 0.18), (0.72, 0, 1.15, 0.07), (0.90, 0, 1.10, 0)],
                       rows=2 * rows, columns=columns)
    wings = [curves.tube([(0.24, s * 0.34, 0.52, 0), (0.06, s * 0.40, 0.50, 0.17), (-0.22, s * 0.40, 0.54, 0.15), (-0.56, s * 0.30, 0.66, 0)],
                         side=(0, 1, 0), flat=0.42, rows=rows, columns=columns // 2) for s in (1, -1)]
    return mesh.joined([body, *wings])


def dog(fine=1.0):
    """Of sausages, as they are twisted from one long balloon."""
    rows, columns = round(64 * fine), round(56 * fine)

    def sausage(a, b, r, side=(0, 1, 0)):
        a, b = np.array(a, float), np.array(b, float)
        inner = [(*(a + f * (b - a)), r * g) for f, g in ((0.12, 0.72), (0.35, 1), (0.65, 1), (0.88, 0.72))]
        return curves.tube([(*a, 0), *inner, (*b, 0)], side=side, rows=rows, columns=columns)

    legs = [sausage((x, y, 0.72), (x + 0.03, 1.35 * y, 0), 0.125, side=(1, 0, 0)) for x in (-0.42, 0.36) for y in (0.13, -0.13)]
    ears = [sausage((0.58, 0.05 * s, 1.16), (0.42, 0.27 * s, 1.46), 0.085, side=np.cross((-0.16, 0.22 * s, 0.30), (1, 0, 0))) for s in (1, -1)]
    return mesh.joined([sausage((-0.5, 0, 0.72), (0.46, 0, 0.72), 0.185), *legs, sausage((0.4, 0, 0.74), (0.6, 0, 1.2), 0.125), *ears,
                        sausage((0.52, 0, 1.18), (1.0, 0, 1.1), 0.12), sausage((-0.46, 0, 0.72), (-0.68, 0, 1.22), 0.07)])


def stretched(factor):
    """* Upwards."""
    return lambda p: p * (factor ** -0.5, factor ** -0.5, factor)


def elongated(factor):
    """* Along x."""
    return lambda p: p * (factor, factor ** -0.5, factor ** -0.5)


def twisted(turn):
    """* About the vertical, by this many radians in a unit of height."""
    def move(p):
        c, s = np.cos(turn * p[:, 2]), np.sin(turn * p[:, 2])
        return np.column_stack([c * p[:, 0] - s * p[:, 1], s * p[:, 0] + c * p[:, 1], p[:, 2]])
    return move


def bowed(turn):
    """The vertical becomes an arc of this many radians in a unit of height: the inside is compressed, the outside stretched."""
    def move(p):
        angle, arm = turn * p[:, 2], 1 / turn - p[:, 0]
        return np.column_stack([1 / turn - arm * np.cos(angle), p[:, 1], arm * np.sin(angle)])
    return move


def puffed(factor, centre, width):
    """Blown up around a place, by the factor there."""
    def move(p):
        away = p - centre
        return centre + away * (1 + (factor - 1) * np.exp(-(away ** 2).sum(1) / width ** 2))[:, None]
    return move


def grounded(points):
    """Set down on z = 0."""
    return points - (0, 0, points[:, 2].min())


# In the order of the figure; the first and the last are at rest there, too.
POSES = {
    "bird": (bird, {"stretched": stretched(1.5), "squashed": stretched(0.55), "bowed": bowed(0.75), "elongated": elongated(1.6)}),
    "dog": (dog, {"stretched": stretched(1.4), "puffed": puffed(1.9, (0, 0, 0.72), 0.45), "twisted": twisted(1.1), "elongated": elongated(1.6)}),
}


def posed(name, fine=1.0):
    """{"rest": mesh, pose: mesh, ...}"""
    make, poses = POSES[name]
    rest = make(fine)
    return {"rest": rest, **{pose: rest.moved(lambda p, move=move: grounded(move(p))) for pose, move in poses.items()}}
