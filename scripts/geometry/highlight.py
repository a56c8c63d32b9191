# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A highlight's peak, light, place and shape, of facets against material, and whether they agree.

By what the ground truth allows, epsilon: the rms relative error of a BRDF's bin, of explicit heightfields against Smith's model (Beckmann
of slope roughness up to 0.3, views up to 75 degrees: 5 %; other laws, rougher ones: 10 %). What follows from it for sums over a highlight:
let p be the material's picture of it, divided by its sum, and the facets' p (1 + e), rms of e under p at most epsilon. Then
- all light differs by E_p[e]: at most epsilon relatively; so does light at the peak (pixels of at least 0.8 of the largest value, in the
  full form a hundred and more), if e is no larger there than elsewhere;
- the mean of any function g of the place, of the facets' highlight divided by its own sum, differs by E_p[e g] - E_p[e] E_p[g], a
  covariance: at most epsilon sd_p(g) by Cauchy and Schwarz.
So every row holds a deviation in units in which epsilon itself is the tolerance: d = (facets / material - 1), or (E_facets[g] - E_p[g]) /
sd_p(g) for g = x, y (place) and (x - mx)^2, (y - my)^2, (x - mx)(y - my) (second moments: sd of the first is sqrt(kurtosis - 1) sigma^2).
Nothing of this is fitted. Realisations are independent, which gives d its standard error s; musurf's noise, by two renders, is added.
With t the 99 % quantile of Student's t: |d| + t s <= epsilon agrees, |d| - t s > epsilon FAILS, else the run was too small to tell: undecided.
"""
import numpy as np

from crosscheck import statistics

from . import errors

AGREES, FAILS, UNDECIDED = "agrees", "FAILS", "undecided"
PEAK = 0.8  # of the largest value
LEVEL = 0.01


def tolerance(law, m):
    """epsilon for a law of slopes under M, by the slope roughness of the transformed surface where it is largest."""
    alpha = law["alpha"] * np.linalg.norm(np.linalg.inv(m), 2)
    return 0.05 if law["ndf"] == "beckmann" and alpha <= 0.3 else 0.10


def places(camera, length):
    """[row, column, 2]: where the pixels' middles lie on the plate, in edges."""
    columns, rows = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
    d = camera.rays(columns, rows)
    t = -camera.eye[2] / np.where(d[..., 2] < 0, d[..., 2], np.nan)
    return (camera.eye[:2] + t[..., None] * d[..., :2]) / length


def measures(place, material):
    """What is compared, of the pixels [n, 2], as weights of them, by the material's picture [n]:
    [(name, weights of the sum, weights of what it is divided by or None)], in which a row is linear."""
    p = material / material.sum()
    x, y = (place - p @ place).T
    peak = (material >= PEAK * material.max()).astype(float)
    yield "light", np.ones_like(p) / material.sum(), None
    yield "peak", peak / (peak @ material), None
    for name, g in (("place x", x), ("place y", y), ("moment xx", x * x), ("moment yy", y * y), ("moment xy", x * y)):
        mean = p @ g
        yield name, (g - mean) / np.sqrt(p @ (g - mean) ** 2), np.ones_like(p)


def rows(geometry, material, whole, place, epsilon):
    """geometry [R, row, column, 3], material [2, ...] of independent noise."""
    facets, twice = geometry[:, whole] @ errors.LUMINANCE, material[:, whole] @ errors.LUMINANCE
    found = []
    for name, weights, over in measures(place[whole], twice.mean(0)):
        of = [picture @ weights / (picture @ over if over is not None else 1) - (over is None) for picture in (facets, twice)]
        deviation, freedom = float(of[0].mean()), len(facets) - 1
        error = float(np.hypot(statistics.standard_error(of[0]), abs(of[1][0] - of[1][1]) / 2))
        reach = statistics.student(freedom, LEVEL) * error
        verdict = AGREES if abs(deviation) + reach <= epsilon else FAILS if abs(deviation) - reach > epsilon else UNDECIDED
        found.append({"measure": name, "deviation": deviation, "error": error, "verdict": verdict})
    return found


def ellipse(picture, whole, place):
    """(standard deviations along the longer and the shorter axis, in edges; degrees of the longer from +x) of a highlight."""
    p = picture[whole] @ errors.LUMINANCE
    p = p / p.sum()
    away = place[whole] - p @ place[whole]
    values, axes = np.linalg.eigh((p[:, None] * away).T @ away)
    return float(np.sqrt(values[1])), float(np.sqrt(values[0])), float(np.degrees(np.arctan2(axes[1, 1], axes[0, 1])) % 180)
