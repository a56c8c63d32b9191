# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The scene pair: one plate, camera and environment, as explicit facets for POV-Ray and as a material for musurf.

Lengths are cells of the heightfield; z is up, the plate is a square around the origin at z = 0. For POV-Ray it is covered
by periods of the surface, baked under M, and cut to the square. Its parametrisation is the world's x and y: the material's
tangent is x, and its `transform` is the very M of the vertices (Eq. 9 of Microsurface Transformations).
"""
import dataclasses
import json

import numpy as np

EYE, AIM, FOV = (0.0, -0.64, 0.2), (0.0, -0.12, 0.0), 44.0  # in edges of the plate; the view is 47 to 80 degrees from the normal
FAR = 1e6  # beyond any height


@dataclasses.dataclass(frozen=True)
class Plate:
    name: str
    m: np.ndarray  # 2 x 2
    cells: int     # of one period
    length: float  # of an edge of the square

    @property
    def outline(self):
        """[2, 2]: maps the square to the plate: it is cut to the square, whatever M."""
        return np.eye(2)

    def periods(self):
        """([k, 2]: where the periods that reach into the square begin, M (cells i, cells j); which lie within)"""
        edges = self.cells * self.m.T  # the period's two edges
        corners = self.length / 2 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) @ np.linalg.inv(edges)
        low, high = np.floor(corners.min(0)).astype(int), np.ceil(corners.max(0)).astype(int)
        starts = np.stack(np.meshgrid(*(np.arange(a, b) for a, b in zip(low, high)), indexing="ij"), -1).reshape(-1, 2) @ edges
        box = np.array([(0, 0), edges[0], edges[1], edges[0] + edges[1]])
        reaches = (starts + box.min(0) < self.length / 2) & (starts + box.max(0) > -self.length / 2)
        within = (starts + box.min(0) > -self.length / 2) & (starts + box.max(0) < self.length / 2)
        return starts[reaches.all(1)], within.all(1)[reaches.all(1)]


class Camera:
    """A pinhole that looks along the unit vector `ahead`; width / height pixels, square."""

    def __init__(self, length, width, height, eye=EYE, aim=AIM, fov=FOV):
        self.eye, self.aim, self.fov = length * np.array(eye), length * np.array(aim), fov
        self.width, self.height = width, height
        ahead = self.aim - self.eye
        self.ahead = ahead / np.linalg.norm(ahead)
        right = np.cross(self.ahead, (0, 0, 1))
        self.right = right / np.linalg.norm(right)
        self.up = np.cross(self.right, self.ahead)
        self.tall = 2 * np.tan(np.radians(fov) / 2)
        self.wide = self.tall * width / height

    def rays(self, columns, rows):
        """Directions through image positions, pixels from the left and from the top."""
        x, y = self.wide * (columns / self.width - 0.5), self.tall * (0.5 - rows / self.height)
        return self.ahead + x[..., None] * self.right + y[..., None] * self.up

    def sees(self, plate, rise):
        """(which pixels see nothing but the plate, which nothing of it, the view's angle to the normal in degrees).

        Facets near the rim lack neighbours that would mask them, and stand out against the surrounding: as far as the
        range of heights, `rise`, reaches at the flattest view, pixels are neither.
        """
        corners = plate.length / 2 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) @ plate.outline.T
        back = np.linalg.inv(plate.outline)
        margin = rise * np.linalg.norm(corners - self.eye[:2], axis=1).max() / self.eye[2] * np.linalg.norm(back, 2)
        columns, rows = np.meshgrid(np.arange(self.width + 1.0), np.arange(self.height + 1.0))
        d = self.rays(columns, rows)
        down = d[..., 2] < 0
        t = -self.eye[2] / np.where(down, d[..., 2], -1)
        away = np.where(down, np.abs((self.eye[:2] + t[..., None] * d[..., :2]) @ back.T).max(-1) - plate.length / 2, np.inf)

        def all_corners(where):
            return where[:-1, :-1] & where[1:, :-1] & where[:-1, 1:] & where[1:, 1:]

        centre = self.rays(columns[:-1, :-1] + 0.5, rows[:-1, :-1] + 0.5)
        return all_corners(away < -margin), all_corners(away > margin), np.degrees(np.arccos(-centre[..., 2] / np.linalg.norm(centre, axis=-1)))


def vector(p):
    return "<" + ",".join(format(float(x), ".17g") for x in p) + ">"


def povray_sky(environment):
    """The path of an EXR or HDR image, or None for white, around the scene.

    POV-Ray's spherical map has its pole along y and starts elsewhere: two quarter turns bring it to musurf's convention
    (+z up, the middle column towards +x). That this is right is measured: where both see the sky, they agree.
    """
    sky = "rgb 1" if environment is None else f'image_map {{ {environment.suffix[1:]} "{environment}" map_type 1 interpolate 2 }} rotate x*90 rotate z*180'
    return f"sky_sphere {{ pigment {{ {sky} }} }}"


def povray_scene(plate, camera, mesh, around, bounces):
    """Text of the POV-Ray scene. `mesh` is the period's mesh2 file, `around` the text of what lights it. After `bounces` reflections light is lost."""
    text = [f"// musurf: {plate.name}, M = {plate.m.tolist()}", "#version 3.7;",
            f"global_settings {{ assumed_gamma 1 max_trace_level {bounces + 1} }}",
            f"camera {{ perspective location {vector(camera.eye)} direction {vector(camera.ahead)}",
            f"  right {vector(camera.right * camera.wide)} up {vector(camera.up * camera.tall)} }}",
            around,
            f'#declare Period = object {{ #include "{mesh}"',
            "  texture { pigment { rgb 0 } finish { ambient 0 emission 0 diffuse 0 reflection 1 } } }"]
    half = plate.length / 2
    cut = f"clipped_by {{ box {{ {vector((-half, -half, -FAR))} {vector((half, half, FAR))} }} }}"
    for start, within in zip(*plate.periods()):  # to cut costs POV-Ray its bounding: only those at the rim are
        text.append("object { Period translate %s%s }" % (vector([*start, 0]), "" if within else " " + cut))
    return "\n".join(text) + "\n"


def plate_obj(plate):
    """The plate as two triangles, texture coordinates along the world's x and y, facing up."""
    corners = plate.length / 2 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    lines = [f"v {x:.9g} {y:.9g} 0" for x, y in corners] + [f"vt {x / plate.length:.9g} {y / plate.length:.9g}" for x, y in corners]
    return "\n".join([*lines, "f 1/1 2/2 3/3", "f 1/1 3/3 4/4"]) + "\n"


def musurf_scene(plate, camera, mesh, environment, material):
    """The plate with the material of the surface before M; M comes last."""
    light = {"type": "constant", "radiance": 1} if environment is None else {"type": "environment", "image": str(environment)}
    return json.dumps({
        "musurf": 1,
        "camera": {"type": "perspective", "position": camera.eye.tolist(), "target": camera.aim.tolist(), "up": [0, 0, 1], "fov": camera.fov},
        "film": {"width": camera.width, "height": camera.height, "filter": "box", "pixels": "float"},
        "integrator": {"depth": 2},
        "meshes": {"plate": {"file": str(mesh)}}, "materials": {"plate": dict(material, transform=(plate.m @ material.get("transform", np.eye(2))).tolist())},
        "objects": [{"mesh": "plate", "material": "plate"}], "lights": [light]}, indent=1)
