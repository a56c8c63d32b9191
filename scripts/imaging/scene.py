# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Scenes of scenes/ibl as the study renders them: under another environment, in another size, spheres chosen or alone."""
import dataclasses
import json
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "scenes" / "ibl"


def absolute(value):
    """With the relative names of files replaced, for the scene will be written elsewhere."""
    if isinstance(value, dict):
        return {key: absolute(inner) for key, inner in value.items() if not key.startswith("$")}
    if isinstance(value, list):
        return [absolute(inner) for inner in value]
    return str((FOLDER / value).resolve()) if isinstance(value, str) and value.startswith("../") else value


def load(name):
    return absolute(json.loads((FOLDER / f"{name}.json").read_text()))


def environments(names):
    """[(name, light)] of those that are there; the studio if none is."""
    files = [(name, ROOT / "build" / "environments" / f"{name}.exr") for name in names]
    return [(name, {"type": "environment", "image": str(file)}) for name, file in files if file.exists()] or [("studio", {"type": "studio"})]


def under(scene, light, width=None, height=None):
    film = dict(scene["film"], pixels="float", filter="box", radius=0.5)
    if width:
        film.update(width=width, height=height)
    return {**scene, "lights": [light], "film": film}


def by(scene, integrator):
    return {**scene, "integrator": integrator}


@dataclasses.dataclass(frozen=True)
class Sphere:
    roughness: float   # alpha_lin
    anisotropy: float  # eta
    material: dict


class Spheres:
    """The cells of spheres.json, row by row."""

    def __init__(self, effort):
        self.scene, self.side = load("spheres"), effort.cell
        found = []
        for item in self.scene["objects"]:
            material = self.scene["materials"][item["material"]]
            x, y = material["alpha_x"], material["alpha_y"]
            found.append(Sphere(round(((x + y) / 2) ** 0.5, 4), round((x - y) / (x + y), 4), material))
        kept = [s for s in found if (not effort.roughness or s.roughness in effort.roughness) and (not effort.anisotropy or s.anisotropy in effort.anisotropy)]
        self.rows, self.columns = sorted({s.roughness for s in kept}), sorted({s.anisotropy for s in kept})
        self.cells = sorted(kept, key=lambda s: (s.roughness, s.anisotropy))
        if len(self.cells) != len(self.rows) * len(self.columns):
            raise ValueError("spheres.json is no grid of alpha_lin and eta")

    def place(self, k):
        """(row, column) of a cell."""
        return divmod(k, len(self.columns))

    def sheet(self, light):
        """All of them, of which none shades another in image-based lighting."""
        objects, height = [], 2.2 * len(self.rows)
        for k in range(len(self.cells)):
            row, column = self.place(k)
            at = [2.2 * (column - (len(self.columns) - 1) / 2), 0, 2.2 * ((len(self.rows) - 1) / 2 - row)]
            objects.append({"shape": "sphere", "radius": 1, "material": str(k), "transform": [{"translate": at}]})
        return under({"camera": dict(self.scene["camera"], height=height), "film": {}, "objects": objects,
                      "materials": {str(k): cell.material for k, cell in enumerate(self.cells)}}, light, self.side * len(self.columns), self.side * len(self.rows))

    def alone(self, k, light):
        """One that nothing shades, in the middle of its cell."""
        return under({"camera": dict(self.scene["camera"], height=2.2), "film": {}, "objects": [{"shape": "sphere", "radius": 1, "material": self.cells[k].material}]},
                     light, self.side, self.side)

    def of_sheet(self, picture, k):
        row, column = self.place(k)
        return picture[row * self.side:(row + 1) * self.side, column * self.side:(column + 1) * self.side]
