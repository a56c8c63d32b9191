# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Pictures of the cross-check: the surfaces lit from M v, what is masked, G1 and the normals against the core."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.transforms import Affine2D  # noqa: E402

from . import maps, masking, mesh  # noqa: E402
from .verdicts import label  # noqa: E402


def save(figure, path):
    """Beside, then renamed: no half picture replaces a whole one."""
    fresh = path.with_suffix(".new.png")
    figure.savefig(fresh, dpi=110, bbox_inches="tight")
    plt.close(figure)
    fresh.replace(path)
    return path


def raster(values):
    """[i, j, L|U] as an image with two columns per cell, row 0 at y = 0."""
    return values.reshape(len(values), len(values), 2).transpose(1, 0, 2).reshape(len(values), -1)


def surfaces(setup, measured, path, cells=96):
    """A corner of each surface from above in its own space, lit from M v of the second view: cos times visibility."""
    view = min(1, len(setup.views) - 1)
    figure, axes = plt.subplots(1, len(setup.maps), figsize=(4 * len(setup.maps), 4.2), squeeze=False)
    for axis, (name, m) in zip(axes[0], setup.maps.items()):
        light = maps.carried(m, setup.views[view])
        slopes = mesh.baked_slopes(measured["first"], m)
        cosine = masking.facing(slopes, light) / np.sqrt(1 + slopes[0] ** 2 + slopes[1] ** 2)
        shade = raster((cosine * masking.centre(measured["bits"][name])[view, ..., 0])[:cells, :cells])
        axis.imshow(shade, cmap="gray", origin="lower", extent=(0, cells, 0, cells), vmin=0, vmax=max(shade.max(), 1e-9),
                    transform=Affine2D(np.array([[*m[0], 0], [*m[1], 0], [0, 0, 1]])) + axis.transData)
        corners = np.array([[0, 0], [cells, 0], [cells, cells], [0, cells]]) @ m.T
        reach, middle = max(np.ptp(corners, 0)) / 2 * 1.05, (corners.min(0) + corners.max(0)) / 2
        axis.set(xlim=(middle[0] - reach, middle[0] + reach), ylim=(middle[1] - reach, middle[1] + reach), aspect="equal",
                 title=name, facecolor="#8aa", xticks=[], yticks=[])
    return save(figure, path)


def masks(setup, measured, path):
    """What the views see of the original and its images, in the original's coordinates, and where bits differ.

    The last column is a negative control, lit from v instead of M v.
    """
    shown = {name: masking.centre(bits)[..., 0] for name, bits in measured["bits"].items()}
    for control in measured["controls"][:1]:
        shown[f"{control['map']}, lit from {control['lit_from']}"] = control["bits"][..., 0]
    first, n = shown["original"], setup.size
    figure, axes = plt.subplots(2, len(shown), figsize=(3.2 * len(shown), 6.8))
    for (above, below), (name, bits) in zip(axes.T, shown.items()):
        colours = np.zeros((3, *raster(bits[0]).shape))
        colours[: len(bits)] = [raster(b) for b in bits]
        above.imshow(colours.transpose(1, 2, 0), origin="lower", extent=(0, n, 0, n))
        above.set_title(name)
        i, j, upper = np.nonzero((bits != first).any(0))
        below.plot(i + 0.25 + 0.5 * upper, j + 0.5, "r.", markersize=4 if len(i) < 1000 else 0.5)
        below.set(title=f"{int((bits != first).sum())} of {bits.size} bits differ", xlim=(0, n), ylim=(0, n), aspect="equal")
        for axis in (above, below):
            axis.set(xticks=[], yticks=[])
    return save(figure, path)


def masking_functions(setup, rows, path):
    """G1 against the core: projected means of all M, and one M's facets by slope."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(12, 4.6))
    shown = [r for r in rows if r["check"] == "G1 projected mean"]
    left.errorbar(range(len(shown)), [r["measured"] for r in shown], yerr=[r["standard_error"] for r in shown], fmt="o",
                  label="POV-Ray, projected mean")
    left.plot(range(len(shown)), [r["predicted"] for r in shown], "k_", markersize=18, label="core, G1 at Mv")
    left.plot(range(len(shown)), [r["facet_mean"] for r in shown], "x", color="C1", label="POV-Ray, facet mean")
    left.set_xticks(range(len(shown)), [f"{r['map']}\n{r['view'].split(',')[0]}" for r in shown], rotation=70, fontsize=7)
    left.set(ylabel="G1", ylim=(0, 1.05))
    left.legend()
    name = list(setup.maps)[-1]
    for k, view in enumerate(setup.views):
        from_view = [r for r in rows if r["check"] == "G1 per slope" and r["map"] == name and r["view"] == label(view)]
        x = [(max(r["low"], -1.5) + r["high"]) / 2 for r in from_view]
        right.errorbar(x, [r["measured"] for r in from_view], yerr=[r["standard_error"] for r in from_view], fmt="o-",
                       color=f"C{k}", label=label(view))
        if from_view:
            right.axhline(from_view[0]["predicted"], color=f"C{k}", linestyle="--")
    right.set(xlabel="slope along the view / alpha (of the original)", ylabel="G1", ylim=(0, 1.05),
              title=f"{name}: POV-Ray (dots), Smith (dashed)")
    right.legend()
    return save(figure, path)


def distributions(tables, path):
    """Measured over predicted share of each bin of normals."""
    figure, axes = plt.subplots(1, len(tables), figsize=(4 * len(tables), 3.2), sharey=True, squeeze=False)
    for axis, (name, t) in zip(axes[0], tables.items()):
        with np.errstate(divide="ignore", invalid="ignore"):
            axis.errorbar(100 * t["predicted"], t["measured"] / t["predicted"], yerr=t["error"] / t["predicted"], fmt=".")
        axis.axhline(1, color="k", linewidth=0.8)
        axis.set(title=name, xlabel="share by the core's D, %", ylim=(0.8, 1.2))
    axes[0, 0].set_ylabel("facets / core")
    return save(figure, path)
