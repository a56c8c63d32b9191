# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Contact sheets: the truth beside the techniques, and where FLIP sees a difference."""
import matplotlib
import numpy as np

from figuring import pictures

from . import draw, errors, techniques
from . import effort as efforts


def image(rgb, scale=1):
    shown = pictures.Image.fromarray(np.round(255 * errors.picture_flip.display(rgb)).astype(np.uint8))
    return shown.resize((shown.width * scale, shown.height * scale), pictures.Image.Resampling.NEAREST) if scale > 1 else shown


def difference(truth, picture, scale=1):
    colours = matplotlib.colormaps["magma"](errors.flip_map(truth, picture, np.ones(truth.shape[:2], bool)))[..., :3]
    shown = pictures.Image.fromarray(np.round(255 * colours).astype(np.uint8))
    return shown.resize((shown.width * scale, shown.height * scale), pictures.Image.Resampling.NEAREST) if scale > 1 else shown


def compared(made, name, entries, scale=1, maps=True):
    """The truth and each technique's picture; below each its FLIP map."""
    truth = made[name, "truth"]
    rows = [("truth (paths)", image(truth, scale), image(0 * truth, scale))]
    rows += [(entry["label"], image(made[name, entry["label"]], scale), difference(truth, made[name, entry["label"]], scale)) for entry in entries]
    cells = [(label, picture) for label, picture, _ in rows] + ([("", below) for *_, below in rows] if maps else [])
    return pictures.sheet(cells, len(rows))


def spheres(made, environments, entries, folder):
    """A file for each environment."""
    for name in environments:
        scale = max(1, 256 // made[name, "truth"].shape[1])
        pictures.save(compared(made, name, entries, scale), folder / f"spheres-{name}.png")
        yield f"spheres-{name}.png"


def one(grid, made, environment, entries, roughness, anisotropy, path, scale):
    """A sphere of the grid, the nearest to these."""
    k = min(range(len(grid.cells)), key=lambda i: (abs(grid.cells[i].roughness - roughness), abs(grid.cells[i].anisotropy - anisotropy)))
    cut = {(environment, label): grid.of_sheet(made[environment, label], k) for label in ("truth", *(e["label"] for e in entries))}
    pictures.save(compared(cut, environment, entries, scale), path)
    return grid.cells[k]


def figure_21(found):
    """What Figure 21 compares, the paper's form and filtered sampling of 25 reads, and the default here."""
    return [*draw.shown(found)[1:], *(e for e in found if e["integrator"] == {"by": techniques.FILTERED, "reads": efforts.FILTERED})]
