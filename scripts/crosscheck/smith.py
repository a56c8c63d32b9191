# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Where Smith's masking is known to be wrong on Gaussian surfaces, and by how much.

Measured beforehand with an exact double-precision caster, apart from this code and from POV-Ray: the average visibility
of the facets whose slope along the view, over alpha, lies in a bin, against Smith's value, which is one for all. The
masking of a Gaussian surface depends on view and roughness through nu = cot(theta)/alpha alone, so the three tables,
taken at alpha .3 and .6, serve every alpha; in between, the deviation lies between its neighbours.
"""
import numpy as np

EDGES = (-np.inf, -1.0, -0.5, 0.0, 0.5, np.inf)
# nu: visibility per bin, Smith's G1. Facets turn away at nu, so that small nu has fewer bins.
MEASURED = {
    0.8932: ((0.987, 0.979, 0.965, 0.928, 0.784), 0.9625),  # alpha .3, 75 degrees
    0.2916: ((0.679, 0.658, 0.613, 0.497), 0.6458),  # alpha .3, 85 degrees
    0.1458: ((0.419, 0.409, 0.375, 0.296), 0.4039),  # alpha .6, 85 degrees
}
SPREAD = 0.046  # relative, between one surface of N = 256 and one of N = 1024: the tables' own uncertainty


def edges(nu):
    """Bins up to nu; a last sliver narrower than a quarter joins its neighbour."""
    kept = [e for e in EDGES[:-1] if e < nu]
    if len(kept) > 1 and nu - kept[-1] < 0.25 and kept[-1] > 0:
        kept.pop()
    return [*kept, np.inf]


def known_deviation(nu, index):
    """(lowest, highest) relative deviation of bin index from Smith, or None where nothing is known."""
    nus = sorted(MEASURED)
    above = [x for x in nus if x >= nu - 5e-4][:1]
    below = [x for x in nus if x <= nu + 5e-4][-1:]
    if not below or nu > 2:
        return None
    found = []
    for key in {*above, *below}:
        values, smith = MEASURED[key]
        if index >= len(values):
            return None
        found.append(values[index] / smith - 1)
    if not above:  # flatter surfaces are masked less, and Smith's error fades with the masking
        found.append(0.0)
    return min(found) - SPREAD, max(found) + SPREAD
