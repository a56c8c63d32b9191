# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The studies as curves (the form of scripts/reporting/measure.py) and pictures: maps over roughness and anisotropy, sweeps."""
import numpy as np

from . import effort as efforts
from . import techniques, verdicts

WHERE = {"below": "α_lin < 0.5", "above": "α_lin > 0.5"}
WHAT = {"flip": "mean FLIP", "relative": "relative error"}


def curves(found, noise, command):
    """Errors against time, a series for each technique, a point for each N."""
    for number, (key, what) in enumerate(WHAT.items(), 1):
        for place, where in WHERE.items():
            series = []
            for name in dict.fromkeys(entry["label"].split(", N")[0] for entry in found):
                of = [entry for entry in found if entry["label"].split(", N")[0] == name and entry[f"{key}_means"][place] is not None]
                points = [{"x": e["frame"], "y": e[f"{key}_means"][place], "label": f"N {e['integrator']['reads']}" if "reads" in e["integrator"] else ""} for e in of]
                series.append({"name": name, "line": len(points) > 1, "points": points})
            yield f"{number}-{key}-{place}", {
                "title": f"Environment lighting: {what} against the time of a frame, {where}", "command": command, "series": [s for s in series if s["points"]],
                "text": f"Mean over spheres of {where} and all environments, against path tracing, whose own two halves differ by {noise[key][place]:.2g} ({what}). "
                        "Time of one thread for the whole frame, camera rays included, in the same run.",
                "x": {"label": "time of a frame (bent normal = 1)", "log": True}, "y": {"label": what, "log": True}}


def save(plt, figure, path):
    """PNG and SVG; beside, then renamed."""
    for suffix in ("png", "svg"):
        fresh = path.with_suffix(f".new.{suffix}")
        figure.savefig(fresh, dpi=110, bbox_inches="tight")
        fresh.replace(path.with_suffix(f".{suffix}"))
    plt.close(figure)


def shown(found):
    """Bent normal, the paper's form, and the default."""
    return [verdicts.of(found, by=techniques.BASELINE), verdicts.of(found, by=techniques.SEED, reads=efforts.SEED), verdicts.of(found, **techniques.DEFAULT)]


def maps(plt, grid, noise, found, path):
    """Figure 19: FLIP times 1000 over alpha_lin and eta, mean over the environments."""
    panels = [(entry["label"], np.mean(list(entry["flip"].values()), 0)) for entry in shown(found)] + [("two halves of the truth", np.mean(list(noise["flip"].values()), 0))]
    top = max(values.max() for _, values in panels)
    figure, axes = plt.subplots(1, len(panels), figsize=(3.1 * len(panels), 3.6), squeeze=False, sharey=True)
    for axis, (title, values) in zip(axes[0], panels):
        axis.imshow(values, origin="lower", vmin=0, vmax=top, cmap="magma", aspect="auto")
        for (row, column), value in np.ndenumerate(values):
            axis.text(column, row, f"{1000 * value:.0f}", ha="center", va="center", fontsize=8, color="white" if value < 0.6 * top else "black")
        axis.set(title=title, xlabel="η", xticks=range(len(grid.columns)), xticklabels=[f"{x:g}" for x in grid.columns], yticks=range(len(grid.rows)),
                 yticklabels=[f"{x:g}" for x in grid.rows])
        axis.title.set_fontsize(9)
    axes[0][0].set_ylabel("α_lin")
    save(plt, figure, path)


FIGURE = {"k": (14, 1.0, 0.8), "beta": (13, 0.8, 0.95)}  # of the paper: number, alpha_lin, eta


def of_figure(grid, entry, key):
    """FLIP of the paper's sphere, or of the nearest that there is, under the first environment."""
    _, alpha, eta = FIGURE[key]
    row, column = (min(range(len(axis)), key=lambda i: abs(axis[i] - value)) for axis, value in ((grid.rows, alpha), (grid.columns, eta)))
    return next(iter(entry["flip"].values()))[row][column]


def sweeps(plt, grid, swept, path):
    """Figures 13 and 14: FLIP over beta and k."""
    figure, axes = plt.subplots(1, len(swept), figsize=(4.6 * len(swept), 3.4), squeeze=False)
    for axis, (key, entries) in zip(axes[0], swept.items()):
        x, (number, alpha, eta) = [entry["value"] for entry in entries], FIGURE[key]
        for name, values in ((f"α_lin {alpha:g}, η {eta:g} (Figure {number})", [of_figure(grid, e, key) for e in entries]),
                             *((f"mean over {where}", [e["flip_means"][place] for e in entries]) for place, where in WHERE.items())):
            axis.plot(x, values, marker="o", markersize=4, label=name)
        axis.set(xlabel={"k": "k", "beta": "β"}[key], ylabel="mean FLIP", xscale="log", xticks=x, xticklabels=[f"{v:g}" for v in x])
        axis.minorticks_off()
        axis.grid(alpha=0.3)
        axis.legend(fontsize=8)
    save(plt, figure, path)
