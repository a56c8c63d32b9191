# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""How far the material's picture is from the facets': by the view's angle, as a whole, and by FLIP.

Realisations of the surface are independent, so the spread of their pictures gives every number its standard error; that
of musurf's own noise is measured by two renders and added. With R realisations the relative error of a standard error is
1/sqrt(2 (R - 1)); neighbouring angles share nothing, so the bins' errors are independent.
"""
import flip_evaluator
import numpy as np

LUMINANCE = np.array((0.2126, 0.7152, 0.0722))


def ratio(geometry, material, where):
    """(sum over the pixels of facets / material - 1, its standard error). geometry is [R, ...], material [2, ...]."""
    facets, twice = geometry[:, where] @ LUMINANCE, material[:, where] @ LUMINANCE
    of_geometry, of_material = facets.sum(1), twice.sum(1)
    share = of_geometry / of_material.mean()
    noise = np.abs(of_material[0] - of_material[1]) / 2 / of_material.mean()
    return share.mean() - 1, np.hypot(share.std(ddof=1) / np.sqrt(len(share)), noise)


def by_angle(geometry, material, whole, angle, bins):
    """Rows {"from", "to", "pixels", "deviation", "error"} over the view's angle to the normal."""
    edges = np.linspace(angle[whole].min(), angle[whole].max() + 1e-9, bins + 1)
    rows = []
    for low, high in zip(edges, edges[1:]):
        where = whole & (angle >= low) & (angle < high)
        if where.sum() >= 8:
            deviation, error = ratio(geometry, material, where)
            rows.append({"from": float(low), "to": float(high), "pixels": int(where.sum()), "deviation": float(deviation), "error": float(error)})
    return rows


def display(picture, exposure):
    """sRGB in [0, 1]; FLIP and eyes look at this."""
    x = np.clip(picture * exposure, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055).astype(np.float32)


def exposure(picture):
    """Brings the 98th percentile of the luminance to white."""
    return 1 / np.quantile(picture @ LUMINANCE, 0.98)


def flip(reference, test, whole, scale):
    """FLIP between two pictures of linear radiance, shown at the same exposure: (map, mean over the plate's pixels)."""
    found, _, _ = flip_evaluator.evaluate(display(reference, scale), display(test, scale), "LDR", True, False, True, {})
    found = np.asarray(found)[..., 0]
    return found, float(found[whole].mean())


def flip_floor(geometry, whole, scale):
    """FLIP between the means of two halves of the realisations: what noise of the facets alone costs, and more than
    what it costs in the comparison, whose reference is the mean of all."""
    half = len(geometry) // 2
    return flip(geometry[:half].mean(0), geometry[half:].mean(0), whole, scale)[1]
