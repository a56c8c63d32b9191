# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""D under M against Eq. (22): facet by facet for the analytic and for the measured D, and bins of facets for the analytic."""
import numpy as np

from . import expect, mesh, normals, statistics
from .verdicts import bounded, statistical

FACETS = 600  # of the first surface, spread evenly
CELLS = 48  # a side, of the measured D


def measured_material(h):
    """The surface's own slopes as the core's `tabulated` distribution."""
    x, y = (a.ravel() for a in mesh.baked_slopes(h, np.eye(2)))
    reach = float(1.001 * max(abs(x).max(), abs(y).max(), 1e-6))
    counts, _, _ = np.histogram2d(y, x, CELLS, [[-reach, reach]] * 2)
    return {"material": "musurf.microfacet", "ndf": "tabulated",
            "histogram": {"bounds": [-reach, reach, -reach, reach], "weights": counts.astype(int).tolist()}}


def identity(spec, core, name, m, h):
    """D_M(m) cos^4 m over |det M| D(u) cos^4 u, of baked facets m and the original's u: 1, whatever D.

    Both normals come from cross products of edges, |M^T m| appears nowhere here. A vertex at N |M| is rounded by eps of that,
    on edges at least as long as M's least stretch, so slopes are off by eps (N cond(M) s + range of h), and the logarithm of
    P22 by that times its steepest slope, at most 2 s/alpha^2 + 4/alpha (Beckmann's and GGX's); 16 covers the few operations.
    """
    original, baked = (mesh.baked_slopes(h, x).reshape(2, -1) for x in (np.eye(2), m))
    chosen = np.linspace(0, original.shape[1] - 1, FACETS).astype(int)
    original, baked = original[:, chosen], baked[:, chosen]
    steepest = float(np.hypot(*original).max())
    eps = np.finfo(float).eps
    tolerance = 16 * eps * (max(h.shape) * np.linalg.cond(m) * steepest + np.ptp(h)) * (2 * steepest / spec.alpha**2 + 4 / spec.alpha)
    u, w = normals.normals_of(original), normals.normals_of(baked)
    table = measured_material(h)
    both = [("measured D", table, {**table, "transform": m.tolist()})]
    for which, before, after in both if spec.file else [("analytic D", spec.plain(), expect.moved(spec, m)), *both]:
        plain, moved = (core.ask(material, ["D"], np.array([0.0, 0, 1]), wm=at)["D"] for material, at in ((before, u), (after, w)))
        left, right = moved * w[:, 2] ** 4, plain * u[:, 2] ** 4 * abs(np.linalg.det(m))
        sure = right > 1e-280
        off = float(abs(left[sure] / right[sure] - 1).max()) if sure.any() else float("nan")
        yield bounded("D facet by facet", spec.name, name, which, off <= tolerance, measured=off, tolerance=float(tolerance),
                      facets=int(sure.sum()), tracer="none")


def distribution(spec, core, name, m, jobs):
    """Shares of bins of normals, by total variation; tolerance: what errors of the bins' size make by chance.

    The fitted surfaces follow the radial law closer than chance, so only the azimuths scatter; the bound is the larger.
    """
    if len(jobs) < 2:
        return None, None
    shares = np.array([job["shares"] for job in jobs])
    reference, core_shares = shares.mean(0), expect.normal_shares(core, spec, m, spec.alpha)
    shares, predicted = normals.pooled(shares, reference), normals.pooled(core_shares, reference)
    error = statistics.standard_error(shares)
    mean, spread = statistics.chance_variation(error / statistics.small_sample(len(shares)))
    variation = normals.total_variation(shares.mean(0), predicted)
    relative = shares.mean(0)[:-1] / predicted[:-1] - 1
    row = statistical("D of normals", spec.name, name, "all", variation, spread, statistics.NORMAL, mean, exact=(0.0, mean + FIT),
                      tracer="none", bins=len(predicted), rms=float(np.sqrt((relative**2).mean())),
                      integral=float(core_shares.sum()))
    return row, {"measured": shares.mean(0), "predicted": predicted, "error": error}


FIT = 0.001  # total variation: the passes of fitting leave .4 % rms in bins of equal mass on U, half of which is L's, exact
