# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Surfaces of `musurf surface make` as shaded relief, with the slopes of their facets against the law.

The law is the core's own D, from `musurf eval`: the density of slopes is D cos^4 (one over the slope's Jacobian, and a facet's area
over the plane), that of their lengths r is 2 pi r D cos^4. U facets are those that the surface's maker does not fit directly.
"""
import numpy as np

LAWS = [("beckmann", {"alpha": 0.3}), ("ggx", {"alpha": 0.3}), ("gtr", {"alpha": 0.3, "gamma": 1.5}), ("std", {"alpha": 0.3, "gamma": 2.5}),
        ("phong", {"exponent": 20}), ("sheen", {"alpha": 0.6})]
BINS = 60
LIGHT = np.array([-0.45, 0.45, 0.77])


def named(ndf, values):
    return ", ".join([ndf, *(f"{key} {value:g}" for key, value in values.items())])


def slopes(h):
    """Lengths of slopes of L and U facets."""
    right, up, corner = np.roll(h, -1, 0), np.roll(h, -1, 1), np.roll(h, (-1, -1), (0, 1))
    return np.hypot(right - h, up - h).ravel(), np.hypot(corner - up, corner - right).ravel()


def relief(h):
    """Lit from the upper left, [row from above, column]."""
    gx, gy = (np.roll(h, -1, axis) - np.roll(h, 1, axis) for axis in (0, 1))
    normal = np.stack([-gx / 2, -gy / 2, np.ones_like(h)], -1)
    return np.maximum(normal @ (LIGHT / np.linalg.norm(LIGHT)) / np.linalg.norm(normal, axis=-1), 0).T[::-1]


def law(ask, ndf, values, radii):
    """Density of the slope's length at the radii."""
    material = {"material": "musurf.microfacet", "ndf": ndf, **values}
    said = ask([{"material": material, "wo": [0, 0, 1], "wm": [r, 0, 1]} for r in radii])
    return np.array([2 * np.pi * r * answer["D"] / (1 + r * r) ** 2 for r, answer in zip(radii, said)])


def compared(h, ask, ndf, values):
    """Histograms of L and U, the law, and the total variation of U's from the law's over the bins (what lies beyond is one bin)."""
    lower, upper = slopes(h)
    edges = np.linspace(0, np.quantile(lower, 0.99), BINS + 1)
    fine = np.linspace(0, edges[-1], 8 * BINS + 1)
    density = law(ask, ndf, values, np.maximum(fine, 1e-9))
    steps = (density[:-1] + density[1:]) / 2 * np.diff(fine)
    mass = steps.reshape(BINS, 8).sum(1)
    found = [np.histogram(s, edges)[0] / len(s) for s in (lower, upper)]
    beyond = abs((1 - found[1].sum()) - (1 - mass.sum()))
    return {"edges": edges, "lower": found[0], "upper": found[1], "fine": fine, "density": density,
            "total_variation": float(0.5 * (abs(found[1] - mass).sum() + beyond))}


def draw(plt, shown, path):
    figure, axes = plt.subplots(2, len(shown), figsize=(3 * len(shown), 5.6), squeeze=False, gridspec_kw={"height_ratios": [1.5, 1]})
    for k, (ndf, values, h, found) in enumerate(shown):
        axes[0, k].imshow(relief(h), cmap="gray", vmin=0, vmax=1, interpolation="nearest")
        axes[0, k].set(xticks=[], yticks=[])
        axes[0, k].set_title(named(ndf, values), fontsize=10)
        width = np.diff(found["edges"])
        axes[1, k].stairs(found["upper"] / width, found["edges"], fill=True, color="#b9c4cf", label="U facets")
        axes[1, k].stairs(found["lower"] / width, found["edges"], color="#5a7086", label="L facets")
        axes[1, k].plot(found["fine"], found["density"], color="#b3261e", linewidth=1, label="law (core's D)")
        axes[1, k].set(xlabel="slope", yticks=[])
    axes[1, 0].legend(fontsize=7)
    figure.savefig(path, dpi=110, bbox_inches="tight")
    plt.close(figure)
