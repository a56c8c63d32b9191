# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Error against one axis at a time: alpha, gamma, the view, the condition of M, and what is measured. Left as measured, right
beyond what the inputs explain; above in double, below in float. Each point is one value, each line the 99th percentile of a quantity."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from .measure import QUANTITIES, ROWS  # noqa: E402
from .tables import FORMATS, symbol  # noqa: E402

AXES = {"alpha": "α (alpha; of phong √(2/(n+2)))", "cos": "cosine of the view, from the horizon (left) to the normal",
        "cond": "condition of M", "gamma": "γ of gtr and std", "quantity": "what is measured"}
NAMED = ("gamma", "quantity")  # places side by side, under their names
EPSILON = {"double": 2.0**-53, "float": 2.0**-24}


def position(x, axis, places):
    """alpha = 1 - 1e-7 stands beside alpha = 1, and what is 0 at the left."""
    if axis == "alpha" and x == 1 - 1e-7:
        return 0.8
    return x if x > 0 else min(p for p in places if p > 0) / 10


def panel(ax, records, axis, key, floor):
    colours = plt.get_cmap("tab10").colors
    rng = np.random.default_rng(1)
    named = axis in NAMED
    places = sorted({r[axis] for r in records}, key=ROWS.index if axis == "quantity" else None)
    for number, quantity in enumerate(ROWS if axis == "quantity" else QUANTITIES):
        rows = [r for r in records if r["quantity"] == quantity]
        if not rows:
            continue
        colour = colours[number % len(colours)]
        x = np.array([places.index(r[axis]) if named else position(r[axis], axis, places) for r in rows])
        y = np.maximum([r[key] for r in rows], floor)
        spread = rng.uniform(-0.12, 0.12, len(x))
        ax.plot(x + 2 * spread if named else x * 10 ** spread, y, ".", color=colour, markersize=1.5, alpha=0.35)
        line = [(p, np.percentile(y[x == p], 99)) for p in np.unique(x) if np.sum(x == p) >= 10]
        if line:
            ax.plot(*zip(*line), "_" if axis == "quantity" else "-", color=colour, linewidth=1.2, label=symbol(quantity))
    if named:
        names = [symbol(p) if axis == "quantity" else f"{p:.10g}" for p in places]
        ax.set_xticks(range(len(places)), names, rotation=60 if axis == "gamma" else 90, fontsize=7)
    else:
        ax.set_xscale("log")
    ax.set_yscale("log")
    ax.grid(alpha=0.2)


def draw(records, axis, path):
    figure, panels = plt.subplots(2, 2, figsize=(12, 8), sharex=True, sharey="row", layout="constrained")
    for row, precision in zip(panels, FORMATS):
        shown = [r for r in records if r["precision"] == precision and r["determined"] and r.get(axis) is not None]
        for ax, key, title in ((row[0], "error", "as measured"), (row[1], "excess", "beyond what the inputs explain")):
            panel(ax, shown, axis, key, EPSILON[precision] / 8)
            ax.axhline(EPSILON[precision], color="black", linewidth=0.7, linestyle=":")
            ax.set_title(f"{precision}: {title}")
    if panels[0][0].lines and axis != "quantity":
        panels[0][1].legend(*panels[0][0].get_legend_handles_labels(), fontsize=8, ncols=3, loc="upper left")
    for ax in panels[1]:
        ax.set_xlabel(AXES[axis])
    for ax in panels[:, 0]:
        ax.set_ylabel("relative error (dotted: half an ULP of 1)")
    figure.savefig(path, dpi=110)
    plt.close(figure)
