# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""G1 from images: POV-Ray looks along the view itself, and each pixel tells the facet that it sees.

An orthographic camera along -v whose right and up are the period's edges N x and N y: a pixel is the shadow, along v, of (N/R)^2
on the plane. A facet of slope s shades 1/2 (1 - s.v / v.z), so that its visible share is its pixels times the ratio of the two. Red
and green carry the cell, blue the triangle; EXR holds whole numbers up to 2048 in half precision.
"""
import json
import pathlib
import sys

import numpy as np

from crosscheck import povray

from . import process
from .laboratory import EDGES, VIEWS

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests"))
import exr  # noqa: E402

MOST = 2048  # cells a side
AWAY = 1e4  # cells from the surface to the camera


def heights(file):
    return next(iter(exr.read(file)[1].values())).astype(float)


def slopes(h):
    """[L | U, i, j, (x, y)]"""
    right, up, corner = np.roll(h, -1, 0), np.roll(h, -1, 1), np.roll(h, (-1, -1), (0, 1))
    return np.stack([np.stack([right - h, up - h], -1), np.stack([corner - up, corner - right], -1)])


def pigment(n):
    cell = "[1 function { mod(floor(%s + %d), %d) / %d } colour_map { [0 rgb 0] [1 rgb %s] }]"
    fraction = "mod(x + %d, 1) + mod(y + %d, 1)" % (MOST * n, MOST * n)
    return "pigment { average pigment_map {\n  %s\n  %s\n  [1 function { select(%s - 1, 0, 0.5) } colour_map { [0 rgb 0] [1 rgb <0,0,6>] }] } }" % (
        cell % ("x", MOST * n, n, MOST, f"<{3 * MOST},0,0>"), cell % ("y", MOST * n, n, MOST, f"<0,{3 * MOST},0>"), fraction)


def scene(n, mesh, view, h, around):
    up = max(h.max(), 0) + AWAY
    centre = np.array([n / 2, n / 2, 0]) + view * (up / view[2])
    lines = ["#version 3.7;", "global_settings { assumed_gamma 1 }", "camera { orthographic location %s direction %s right <%d,0,0> up <0,%d,0> }" % (
        povray.vector(centre), povray.vector(-view), n, n),
        '#declare Period = object { #include "%s" }' % mesh, "union {"]
    lines += ["  object { Period translate <%d,%d,0> }" % (a * n, b * n) for a in range(-around, around + 1) for b in range(-around, around + 1)]
    return "\n".join([*lines, "  texture { %s finish { ambient 0 emission 1 diffuse 0 } }\n}" % pigment(n)]) + "\n"


def counted(picture, n):
    """Pixels [L | U, i, j]. A pixel of no facet would be an error of the scene."""
    i, j, upper = (np.rint(picture[c]).astype(int) for c in "RGB")
    if min(i.min(), j.min(), upper.min()) < 0 or max(i.max(), j.max()) >= n or upper.max() > 1:
        raise process.ProgramError("POV-Ray's image names facets that do not exist")
    return np.bincount(((upper * n + i) * n + j).ravel(), minlength=2 * n * n).reshape(2, n, n)


def g1(h, view, pixels):
    """Mean visible share of the facets [bin] by slope towards the view, of those that face it; `pixels` [L | U, i, j] of R x R."""
    n, s = len(h), slopes(h)
    level = np.hypot(*view[:2])
    along = (s @ view[:2]) / level
    shade = 0.5 * (1 - (s @ view[:2]) / view[2])
    share = pixels * (n * n / pixels.sum()) / np.where(shade > 0, shade, np.inf)
    bins = np.digitize(along, EDGES) - 1
    return [share[(bins == k) & (shade > 0)].mean() if ((bins == k) & (shade > 0)).any() else np.nan for k in range(len(EDGES) - 1)]


def measure(lab, file, pixels):
    """(G1 [view, bin], cost of mesh and renders) from one image of pixels^2 a view."""
    h, folder = heights(file), lab.folder
    around = povray.tiles(h, VIEWS)
    costs = [process.call(lab.musurf, "surface", "mesh", file, "--format", "pov", "-o", folder / "period.inc")[1]]
    found = []
    for view in VIEWS:
        (folder / "image.pov").write_text(scene(len(h), "period.inc", view, h, around))
        costs.append(process.call(povray.find(), "+Iimage.pov", "+Oimage.exr", "+FE", f"+W{pixels}", f"+H{pixels}", "-A", "-D", "-C", "-P", "+WT1",
                                  "-GD", "-GR", "-V", "File_Gamma=1", folder=folder)[1])
        found.append(g1(h, view, counted(exr.read(folder / "image.exr")[1], len(h))))
    return np.array(found), process.total(costs)
