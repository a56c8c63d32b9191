# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Pictures of the comparison: facets, material, difference and FLIP side by side; deviation over the view's angle."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from . import errors  # noqa: E402


def save(figure, path):
    """Beside, then renamed: no half picture replaces a whole one."""
    fresh = path.with_suffix(".new.png")
    figure.savefig(fresh, dpi=110, bbox_inches="tight")
    plt.close(figure)
    fresh.replace(path)
    return path.name


def strip(entries, path):
    """A row for each {"title", "geometry", "material", "flip", "exposure"}; differences in units of white."""
    figure, axes = plt.subplots(len(entries), 4, figsize=(15, 2.95 * len(entries)), squeeze=False)
    for row, entry in zip(axes, entries):
        row[0].imshow(errors.display(entry["geometry"], entry["exposure"]))
        row[1].imshow(errors.display(entry["material"], entry["exposure"]))
        difference = (entry["material"] - entry["geometry"]) @ errors.LUMINANCE * entry["exposure"]
        shown = row[2].imshow(difference, cmap="RdBu_r", vmin=-0.25, vmax=0.25)
        figure.colorbar(shown, ax=row[2], shrink=0.8)
        figure.colorbar(row[3].imshow(entry["flip"], cmap="magma", vmin=0, vmax=0.5), ax=row[3], shrink=0.8)
        row[0].set_ylabel(entry["title"])
        for axis in row:
            axis.set(xticks=[], yticks=[])
    for axis, title in zip(axes[0], ("facets, POV-Ray", "material, musurf", "material − facets (white = 1)", "FLIP")):
        axis.set_title(title, fontsize=10)
    return save(figure, path)


def angles(curves, path):
    """One panel for each M; in it a line with error bars for each comparison. Positive: the facets are brighter."""
    figure, axes = plt.subplots(1, len(curves), figsize=(15, 3.6), squeeze=False, sharey=True)
    for axis, (title, lines) in zip(axes[0], curves):
        for k, (name, rows) in enumerate(lines):
            at = np.array([(row["from"] + row["to"]) / 2 for row in rows]) + 0.3 * k
            axis.errorbar(at, [100 * row["deviation"] for row in rows], [100 * row["error"] for row in rows], marker="o", markersize=3, capsize=2, label=name)
        axis.axhline(0, color="0.5", linewidth=0.8)
        axis.set(title=title, xlabel="angle of the view to the normal, degrees")
        axis.grid(alpha=0.3)
    axes[0, 0].set_ylabel("facets / material − 1, %")
    axes[0, 0].legend(fontsize=8)
    return save(figure, path)
