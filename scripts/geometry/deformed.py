# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The other scene pair: a plate that is deformed as a whole, lit by a small lamp, whose highlight is compared.

Lengths are cells of the heightfield; z is up. At rest the plate is a square of whole periods around the origin; F, 2 x 2, takes all of it
along: outline and facets, heights stay. For POV-Ray those are the baked vertices. musurf gets two meshes of a few quads, the plate at rest
and deformed, and the material of the surface at rest: that M is F, in whatever frame the texture has on the deformed plate, is its own
finding ("tension"). Camera and lamp stand at the same angle on opposite sides, so that the highlight lies around the origin.
"""
import dataclasses
import json

import numpy as np

from . import pair

ANGLE, DISTANCE, LAMP, FOV = 35.0, 0.6, 0.1, 62.0  # degrees from the normal; in edges of the plate at rest: to camera and lamp, the lamp's edge
QUADS = 8  # along the plate's edge
RADIANCE = 10.0


@dataclasses.dataclass(frozen=True)
class Deformed(pair.Plate):
    """m is F; length that of the edge at rest."""

    @property
    def outline(self):
        return self.m

    def periods(self):
        count = round(self.length / self.cells)
        k = (np.arange(count) - count / 2) * self.cells
        starts = np.stack(np.meshgrid(k, k, indexing="ij"), -1).reshape(-1, 2) @ self.m.T
        return starts, np.ones(len(starts), bool)


def away(side):
    """From the origin to camera (-1) and lamp (1), in edges."""
    theta = np.radians(ANGLE)
    return DISTANCE * np.array((0, side * np.sin(theta), np.cos(theta)))


def camera(length, width, height):
    return pair.Camera(length, width, height, eye=away(-1), aim=(0, 0, 0), fov=FOV)


def lamp(length):
    """[3, 4]: from the lamp's own square of edge 1, which shines along +z, to the world; it faces the origin."""
    ahead = -away(1) / DISTANCE
    x = np.array((1.0, 0, 0))
    edge = length * LAMP
    return np.column_stack([edge * x, edge * np.cross(ahead, x), edge * ahead, length * away(1)])


def povray_lamp(length):
    corners = np.array([(-1, -1, 0, 2), (1, -1, 0, 2), (1, 1, 0, 2), (-1, 1, 0, 2)]) / 2 @ lamp(length).T
    return ("polygon { 5, " + ", ".join(pair.vector(p) for p in (*corners, corners[0]))
            + f" pigment {{ rgb {RADIANCE} }} finish {{ ambient 0 diffuse 0 emission 1 }} }}")


def plate_obj(plate, deformed):
    """The plate, texture coordinates along the edges."""
    u = np.arange(QUADS + 1) / QUADS
    uv = np.stack(np.meshgrid(u, u), -1).reshape(-1, 2)
    points = plate.length * (uv - 0.5) @ (plate.m if deformed else np.eye(2)).T
    lines = [f"v {x!r} {y!r} 0" for x, y in points.tolist()] + [f"vt {x!r} {y!r}" for x, y in uv.tolist()]
    for j in range(QUADS):
        for i in range(QUADS):
            k = j * (QUADS + 1) + i + 1
            corners = (k, k + 1, k + QUADS + 2, k + QUADS + 1)
            lines.append("f " + " ".join(f"{c}/{c}" for c in corners))
    return "\n".join(lines) + "\n"


def musurf_scene(plate, eye, meshes, material, tension=True):
    """`meshes`: files of the plate at rest and deformed. Without tension the material stays as it was."""
    item = {"mesh": "plate", "material": "plate", **({"tension": {"rest": str(meshes[0])}} if tension else {})}
    square = lamp(plate.length)
    edge = plate.length * LAMP
    rows = np.column_stack([square[:, :3] / edge, square[:, 3]])
    return json.dumps({
        "musurf": 1,
        "camera": {"type": "perspective", "position": eye.eye.tolist(), "target": eye.aim.tolist(), "up": [0, 0, 1], "fov": eye.fov},
        "film": {"width": eye.width, "height": eye.height, "filter": "box", "pixels": "float"}, "integrator": {"depth": 1},
        "meshes": {"plate": {"file": str(meshes[1])}}, "materials": {"plate": material}, "objects": [item],
        "lights": [{"type": "rectangle", "size": [edge, edge], "radiance": RADIANCE, "transform": rows.tolist()}]}, indent=1)
