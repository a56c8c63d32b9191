# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Pictures of the cross-check: the surfaces lit from M v, what is masked, curves per bin with error bars, normals, albedos."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.transforms import Affine2D  # noqa: E402

from . import compare_masking, heightfield, maps, masking, mesh, verdicts  # noqa: E402

COLOURS = {verdicts.AGREES: "C2", verdicts.KNOWN: "C1", verdicts.FAILS: "C3"}


def save(figure, path):
    """Beside, then renamed: no half picture replaces a whole one. No date, so that the same run makes the same file."""
    fresh = path.with_suffix(".new.png")
    figure.savefig(fresh, dpi=100, bbox_inches="tight", metadata={"Software": None})
    plt.close(figure)
    fresh.replace(path)


def raster(values):
    """[i, j, L|U] as an image with two columns per cell, row 0 at y = 0."""
    return values.reshape(*values.shape[:2], 2).transpose(1, 0, 2).reshape(values.shape[1], -1)


def first_bits(run):
    """{map: bits [view, i, j, L|U, point]} of the first surface, the original's among them, and its heights."""
    spec, (look, views, names) = run.plan.surfaces[0], run.plan.looks[0]
    h, _ = heightfield.quantise(run.heights[spec.name, 0][0])
    found = {}
    for name in names:
        originals, jobs = run.needs["masking", spec, look, name]
        for title, key in (("original", originals[0]), (name, jobs[0])):
            total = len(views) * int(run.got(key)["total"])
            found.setdefault(title, compare_masking.unpacked(run.got(key))[:total].reshape(len(views), *h.shape, 2, -1))
    return h, spec, views, found


def surfaces(run, path, cells=96):
    """A corner of the first surface under every M from above in its own space, lit from M v: cos times visibility."""
    h, spec, views, bits = first_bits(run)
    cells, view = min(cells, *h.shape), min(1, len(views) - 1)
    figure, axes = plt.subplots(2, len(run.plan.maps), figsize=(3.4 * len(run.plan.maps), 7), squeeze=False)
    for (above, below), (name, m) in zip(axes.T, run.plan.maps.items()):
        m = m @ spec.base
        light, slopes = maps.carried(m, views[view]), mesh.baked_slopes(h, m)
        cosine = masking.facing(slopes, light) / np.sqrt(1 + slopes[0] ** 2 + slopes[1] ** 2)
        seen = masking.centre(bits[name])[..., 0]
        shade = raster((cosine * seen[view])[:cells, :cells])
        above.imshow(shade, cmap="gray", origin="lower", extent=(0, cells, 0, cells), vmin=0, vmax=max(shade.max(), 1e-9),
                     transform=Affine2D(np.array([[*m[0], 0], [*m[1], 0], [0, 0, 1]])) + above.transData)
        corners = np.array([[0, 0], [cells, 0], [cells, cells], [0, cells]]) @ m.T
        reach, middle = max(np.ptp(corners, 0)) / 2 * 1.05, (corners.min(0) + corners.max(0)) / 2
        above.set(xlim=(middle[0] - reach, middle[0] + reach), ylim=(middle[1] - reach, middle[1] + reach), aspect="equal",
                  title=name, facecolor="#8aa", xticks=[], yticks=[])
        different = bits[name] != bits["original"]
        colours = np.zeros((3, *raster(seen[0]).shape))
        colours[: len(seen)] = [raster(b) for b in seen]
        below.imshow(colours.transpose(1, 2, 0), origin="lower", extent=(0, len(h), 0, h.shape[1]))
        i, j, upper = np.nonzero(different.any((0, -1)))
        below.plot(i + 0.25 + 0.5 * upper, j + 0.5, "wx")
        below.set(title=f"{int(different.sum())} of {different.size} bits differ", xlim=(0, len(h)), ylim=(0, h.shape[1]), xticks=[], yticks=[])
    return save(figure, path)


def per_slope(rows, path):
    """G1 per slope along the view: every surface, all M on top of each other, Smith's value as a line."""
    rows = [r for r in rows if r["check"] == "G1 per slope"]
    names = list(dict.fromkeys(r["surface"] for r in rows))
    figure, axes = plt.subplots(1, len(names), figsize=(4 * len(names), 3.6), squeeze=False, sharey=True)
    for axis, name in zip(axes[0], names):
        chosen = [r for r in rows if r["surface"] == name]
        for k, view in enumerate(dict.fromkeys(r["view"] for r in chosen)):
            for number, m in enumerate(dict.fromkeys(r["map"] for r in chosen)):
                group = [r for r in chosen if r["view"] == view and r["map"] == m]
                x = [(max(r["low"], -1.5) + min(r["high"], 1.5)) / 2 + 0.02 * number for r in group]
                axis.errorbar(x, [r["measured"] for r in group], [r["standard_error"] for r in group], fmt=".", color=f"C{k}",
                              label=view if number == 0 else None)
            axis.plot(x, [r["predicted"] for r in group], "--", color=f"C{k}")
        axis.set(title=name, xlabel="slope along the view / alpha", ylim=(0, 1.05))
        axis.legend(fontsize=7)
    axes[0, 0].set_ylabel("G1: POV-Ray (dots, all M), Smith (dashed)")
    return save(figure, path)


def distributions(shares, path):
    """Measured over predicted share of each bin of normals, one panel per surface, one colour per M."""
    names = list(dict.fromkeys(surface for surface, _ in shares)) or ["one surface: no spread, no comparison"]
    figure, axes = plt.subplots(1, len(names), figsize=(4 * len(names), 3.2), sharey=True, squeeze=False)
    for axis, name in zip(axes[0], names):
        for (surface, m), t in shares.items():
            if surface == name:
                with np.errstate(divide="ignore", invalid="ignore"):
                    axis.errorbar(100 * t["predicted"], t["measured"] / t["predicted"], t["error"] / t["predicted"], fmt=".", label=m)
        axis.axhline(1, color="k", linewidth=0.8)
        axis.set(title=name, xlabel="share by the core's D under M, %", ylim=(0.8, 1.2))
    axes[0, 0].set_ylabel("facets / core")
    if shares:
        axes[0, 0].legend(fontsize=6)
    return save(figure, path)


def deviations(rows, path):
    """All numbers that have a deviation from Smith, with 99 % intervals, by verdict."""
    kinds = ["sigma", "G1 projected mean", "G2 / (G1 G1)", "albedo, one reflection", "energy, all reflections: compensation",
             "energy, all reflections: random walk"]
    figure, axes = plt.subplots(len(kinds), 1, figsize=(13, 2.4 * len(kinds)))
    for axis, check in zip(axes, kinds):
        for k, r in enumerate(r for r in rows if r["check"] == check):
            if r["predicted"]:
                axis.errorbar(k, 100 * r["deviation"], 100 * (r["measured"] - r["confidence"][0]) / r["predicted"], fmt=".",
                              color=COLOURS[r["verdict"]])
        axis.axhline(0, color="k", linewidth=0.8)
        axis.set(title=check, ylabel="deviation, %", xticks=[])
    return save(figure, path)
