# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""One measurement each: a surface under one M, looked at by POV-Ray, reduced to sums per block. All of it is kept in the store.

A look is three views of the original; the transformed surface is looked at from M v. All reductions use the slopes of the
baked facets and the transformed directions only.
"""
import itertools
import pathlib

import numpy as np

from . import heightfield, maps, masking, mesh, normals, povray, reflect, store

HERE = pathlib.Path(__file__).parent
FINE = 3  # points per facet side: 9 points in every facet, the middle one among them
INDEX = 5.0  # of refraction, of the facets of the multi-bounce images: they reflect .44 head-on
LEVELS = (2, 20)  # max_trace_level for one reflection and for (nearly) all
VERSION = store.of_files(*(HERE / f"{x}.py" for x in ("heightfield", "maps", "masking", "measure", "mesh", "normals",
                                                      "povray", "reflect")))
# Facets' slopes along the view over alpha, up to nu = cot(theta)/alpha where they turn away
EDGES = (-np.inf, -1.0, -0.5, 0.0, 0.5, np.inf)


def edges(nu):
    """Bins up to nu; a last sliver narrower than a quarter joins its neighbour."""
    kept = [e for e in EDGES[:-1] if e < nu]
    if len(kept) > 1 and nu - kept[-1] < 0.25 and kept[-1] > 0:
        kept.pop()
    return [*kept, np.inf]


def nu(view, alpha):
    return view[2] / np.hypot(view[0], view[1]) / alpha


def pairs(views):
    return list(itertools.combinations(range(len(views)), 2))


def bits(h, alpha, m, views, folder, label, lights=None, field=False, fine=FINE):
    """Packed bits [direction, i, j, L|U, point] under M from the lights (M v unless given), and what they come down to."""
    h, quantised = heightfield.quantise(h)
    directions = [maps.carried(m, v) for v in views]
    turn = povray.upright(m)
    surface = povray.height_field(h, quantised, folder / f"{label}.pgm") if field else povray.mesh2(h, turn @ m)
    around = [povray.turned(turn, light) for light in (directions if lights is None else lights)]
    text = povray.scene(surface, h, turn @ m, around, povray.tiles(h, views))
    image, used = povray.run(text, folder, label, 2 * h.shape[0] * fine, h.shape[1] * fine)
    seen = povray.visibility(image, h.shape, len(views))
    found = {"bits": np.packbits(seen), "total": seen[0].size, "seconds": used["seconds"], "megabytes": used["megabytes"]}
    return found if lights is not None or field else {**found, **reduced(h, alpha, m, views, directions, seen)}


def reduced(h, alpha, m, views, directions, seen):
    slopes = mesh.baked_slopes(h, m)
    kinds = masking.classes(slopes, alpha, m)
    kind = normals.index(slopes, m, alpha)
    found = {"projected": [masking.projected_mean(b, slopes, w) for b, w in zip(seen, directions)],
             "joint": [masking.joint(seen, slopes, a, b, directions, kinds) for a, b in pairs(views)],
             "visible": [masking.per_bin(b.mean(-1) * masking.facing(slopes, w), kind, normals.COUNT)
                         for b, w in zip(seen, directions)]}
    for k, (b, w, v) in enumerate(zip(seen, directions, views)):
        found[f"bins{k}"] = masking.binned(b, slopes, w, nu(v, alpha), edges(nu(v, alpha)))
    return found


def mirrors(h, m, view, resolution, folder, label):
    """One reflection and all of them, seen from the view in the space of the transformed surface."""
    images, seconds, megabytes = [], 0.0, 0.0
    for level in LEVELS:
        image, used = povray.run(reflect.scene(h, m, view, INDEX, level), folder, f"{label}-{level}", resolution, resolution, True)
        images.append(image)
        seconds, megabytes = seconds + used["seconds"], max(megabytes, used["megabytes"])
    return {**reflect.reduce(*images), "seconds": seconds, "megabytes": megabytes}


def facets(h, alpha, m, directions):
    """Without POV-Ray: share of the facets per bin of normals, and sigma towards each direction."""
    slopes = mesh.baked_slopes(h, m)
    share = np.bincount(normals.index(slopes, m, alpha).ravel(), minlength=normals.COUNT) / slopes[0].size
    return {"shares": share, "sigma": [masking.sigma(slopes, w) for w in directions]}
