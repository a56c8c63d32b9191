# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Light reflected by explicit facets that are mirrors, as POV-Ray traces it.

The camera is orthographic along the view; its image is one period, skewed so that every pixel has the same share of the
projected area. The facets reflect by Fresnel's equations of a dielectric (POV-Ray's own), and the sky's colour is a code of
the direction: T (0.05 + 0.45 (x + 1)), T (0.05 + 0.45 (y + 1)), 0.95 T with T the light left after all reflections; black
below the horizon, and black where the facets reflect more often than max_trace_level allows. So one image of one reflection
has its directions, its albedo without Fresnel (the share of coloured pixels) and with it (the mean of T).
"""
import numpy as np

from . import povray

THETA, PHI = 12, 24  # bins of 7.5 by 15 degrees
BLOCKS = 4
FLAT = 30
CODE = ("0.05+0.45*(x+1)", "0.05+0.45*(y+1)", "0.95")


def periods(h, m, view):
    """Periods around the middle one: as the view needs, in the original's plane, and for reflected rays that rise by 1 in
    FLAT; flatter ones may leave over the border below the highest peak, and count as lost if they go down there."""
    return povray.tiles(h, [[*(np.linalg.inv(m) @ view[:2]), view[2]], [FLAT, 0, 1]])


def scene(h, m, view, index, level):
    """The period as mirrors, seen along the view in the space of the transformed surface."""
    around, turn = periods(h, m, view), povray.upright(m)
    (nx, ny), v, m = h.shape, povray.turned(turn, view), turn @ m
    x, y = m @ [nx, 0], m @ [0, ny]
    centre = np.array([*(x + y) / 2, 0.0])
    vector = povray.vector
    text = ["#version 3.7;", f"global_settings {{ assumed_gamma 1 ambient_light rgb 0 max_trace_level {level} adc_bailout 0 }}",
            "camera { orthographic location %s direction %s right %s up %s }" % (
                vector(centre + v * (h.max() + 10) / v[2]), vector(-v), vector([*x, 0]), vector([*y, 0])),
            "sky_sphere { pigment { average pigment_map {"]
    for code, colour in zip(CODE, ("<3,0,0>", "<0,3,0>", "<0,0,3>")):
        text.append(f"[1 function {{ select(z, 0, {code}) }} color_map {{ [0 rgb 0] [1 rgb {colour}] }}]")
    # the sky turns with the surface: its code stays that of the direction before
    text += ["} } matrix <%s> }" % ",".join(povray.number(a) for a in (*turn.T[0], 0, *turn.T[1], 0, 0, 0, 1, 0, 0, 0)), "#declare Period = object { %s\n  texture { pigment { color rgb 0 } finish { ambient 0 emission 0 diffuse 0 "
             "reflection { 0 1 fresnel on } } } interior { ior %s } }" % (povray.mesh2(h, m), povray.number(index))]
    for a in range(-around, around + 1):
        for b in range(-around, around + 1):
            text.append("object { Period translate %s }" % vector([*(a * x + b * y), 0]))
    return "\n".join(text) + "\n"


def decode(image):
    """(light left T, it left the surface, direction's x, y) per pixel, from a 16-bit image."""
    value = image / 65535.0
    left = value[..., 2] / 0.95
    out = left > 0
    with np.errstate(divide="ignore", invalid="ignore"):
        x, y = ((value[..., k] / left - 0.05) / 0.45 - 1 for k in (0, 1))
    return left, out, x, y


def bins(x, y):
    """The bin of direction (x, y, sqrt(1 - x^2 - y^2)): theta times PHI plus phi."""
    theta = np.degrees(np.arcsin(np.clip(np.hypot(x, y), 0, 1)))
    phi = np.degrees(np.arctan2(y, x)) % 360
    return np.minimum(theta * THETA / 90, THETA - 1).astype(int) * PHI + np.minimum(phi * PHI / 360, PHI - 1).astype(int)


def per_block(values):
    side = len(values)
    block = np.arange(side) * BLOCKS // side
    return np.bincount((block[:, None] * BLOCKS + block).ravel(), np.ravel(values), BLOCKS * BLOCKS)


def reduce(once, always):
    """Sums per block of the image: pixels, left after one reflection, their T, their directions [block, bin]; and after all."""
    left, out, x, y = decode(once)
    block = np.arange(len(once)) * BLOCKS // len(once)
    block = (block[:, None] * BLOCKS + block)[out]
    shares = np.bincount(block * THETA * PHI + bins(x[out], y[out]), minlength=BLOCKS**2 * THETA * PHI)
    every, gone, _, _ = decode(always)
    return {"pixels": per_block(np.ones(left.shape)), "once": per_block(out), "once_fresnel": per_block(left),
            "bins": shares.reshape(BLOCKS**2, -1).astype(np.int32), "all": per_block(gone), "all_fresnel": per_block(every)}


def nodes(count=6):
    """Directions [bin, node, 3] and weights in solid angle [bin, node] of Gauss-Legendre in every bin."""
    x, w = np.polynomial.legendre.leggauss(count)
    step, turn = np.pi / 2 / THETA, 2 * np.pi / PHI
    theta = (np.arange(THETA)[:, None, None, None] + (x[:, None] + 1) / 2) * step
    phi = (np.arange(PHI)[None, :, None, None] + (x[None, :] + 1) / 2) * turn
    theta, phi = np.broadcast_arrays(theta, phi)
    direction = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)
    weight = np.sin(theta) * (w[:, None] * w[None, :]) * step * turn / 4
    return direction.reshape(THETA * PHI, -1, 3), weight.reshape(THETA * PHI, -1)
