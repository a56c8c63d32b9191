#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
""""tension" of a scene's object: pictures of deformed meshes against pictures of what they amount to.

Both pictures of a pair use the same random numbers. Where M is handed over the same, they are equal bit by bit; where it
went through other roundings, but for those: half floats, and samples that fell on the other side of a boundary.
"""
import json
import math
import pathlib
import sys
import tempfile
import unittest

import numpy as np

import exr
from command import microfacet, musurf, strict

CORNERS = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float)
UVS = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
FACES = [(0, 1, 2), (0, 2, 3)]
T = np.array([[2, 0.25], [0, 0.5]])  # no rounding in the positions
FLIP = np.diag([1, -1])


def obj(points, uv=UVS, faces=FACES, normal=None):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points.tolist()] + [f"vt {u!r} {v!r}" for u, v in uv.tolist()]
    last = ""
    if normal:
        lines.append("vn %r %r %r" % normal)
        last = "/1"
    return "\n".join(lines + ["f " + " ".join(f"{i + 1}/{i + 1}{last}" for i in face) for face in faces]) + "\n"


def stretched(points):
    return np.column_stack([points[:, :2] @ T.T, points[:, 2]])


def bend(p):
    x, y = p[:, 0], p[:, 1]
    return np.stack([x + 0.2 * x * x, y, 0.5 * np.sin(2 * x) * np.cos(y)], 1)


class Render(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.put("rest.obj", obj(CORNERS))
        self.put("deformed.obj", obj(stretched(CORNERS)))

    def put(self, name, text):
        (self.folder / name).write_text(text)

    def scene(self, item, mesh="deformed.obj", below=False):
        scene = {"camera": {"position": [0.5, -3, -3 if below else 3], "target": [0, 0, 0], "fov": 45},
                 "film": {"width": 48, "height": 32, "pixels": "float"}, "integrator": {"samples": 4},
                 "meshes": {"m": {"file": mesh}}, "objects": [item],
                 "lights": [{"type": "studio"}, {"type": "rectangle", "transform": [{"rotate": [1, 0, 0, 180 if not below else 0]},
                                                                                     {"translate": [2, 1, -3 if below else 3]}]}]}
        (self.folder / "scene.json").write_text(json.dumps(scene))
        return self.folder / "scene.json"

    def picture(self, item, mesh="deformed.obj", below=False):
        done = musurf("render", self.scene(item, mesh, below), "-o", self.folder / "out.exr", "--progress", "none")
        self.assertEqual(done.returncode, 0, done.err)
        channels = exr.read(self.folder / "out.exr")[1]
        picture = np.stack([channels[c] for c in "RGB"])
        self.assertGreater(picture.std(), 0.01)
        return picture

    def item(self, m=None, tension=False, **more):
        material = microfacet(alpha=0.25, fresnel={"conductor": "Ag"}, sampler="visible")  # else each map gets the sampler that suits it
        if m is not None:
            material["transform"] = np.asarray(m).tolist()
        return dict({"mesh": "m", "material": material}, **({"tension": {"rest": "rest.obj"}} if tension else {}), **more)

    def assert_alike(self, a, b):
        """But for rounding: nearly all values agree to 1e-4, and no more than 1 in 200 does not."""
        self.assertLess((np.abs(a - b) > 1e-4 * (1 + np.abs(a))).mean(), 0.005)

    def assert_differ(self, a, b):
        self.assertGreater((np.abs(a - b) > 1e-4 * (1 + np.abs(a))).mean(), 0.05)

    def test_constant_tension_is_the_transform(self):
        tense = self.picture(self.item(tension=True))
        np.testing.assert_array_equal(tense, self.picture(self.item(T)))
        self.assert_differ(tense, self.picture(self.item()))

    def test_the_material_acts_first(self):
        m = np.array([[1, 0.3], [0.2, 1.5]])
        tense = self.picture(self.item(m, tension=True))
        self.assert_alike(tense, self.picture(self.item(T @ m)))
        self.assert_differ(tense, self.picture(self.item(m @ T)))

    def test_a_map_of_the_texture_is_one_at_rest(self):
        """J of (u, v + u / 2) is [1 0; 1/2 1] of the square at rest, whatever became of the square."""
        m, j = np.array([[1.5, 0], [0.25, 1]]), np.array([[1, 0], [0.5, 1]])
        item = self.item(m, tension=True)
        item["material"]["jacobian"] = {"map": "power_shear", "amount": 0.5, "exponent": 1}
        tense = self.picture(item)
        self.assert_alike(tense, self.picture(self.item(T @ j @ m)))
        self.assert_differ(tense, self.picture(self.item(j @ T @ m)))

    def test_rigid_motions_change_nothing(self):
        """However bent; the mesh at rest is the one that is shown, turned away."""
        x, y = np.meshgrid(np.linspace(-1, 1, 12), np.linspace(-1, 1, 12))
        flat = np.stack([x.ravel(), y.ravel()], 1)
        faces = [f for j in range(11) for i in range(11) for k in [j * 12 + i] for f in ((k, k + 1, k + 13), (k, k + 13, k + 12))]
        c, s = math.cos(0.7), math.sin(0.7)
        turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
        self.put("bent.obj", obj(bend(flat), flat, faces))
        self.put("rest.obj", obj(bend(flat) @ turn.T + 3, flat, faces))
        m = [[2, 0.5], [0, 0.7]]
        tense, plain = (self.picture(self.item(m, tension=tension), "bent.obj") for tension in (True, False))
        self.assert_alike(tense, plain)
        self.put("rest.obj", obj(np.column_stack([flat, 0 * flat[:, 0]]), flat, faces))
        self.assert_differ(self.picture(self.item(m, tension=True), "bent.obj"), plain)

    def test_from_behind(self):
        """Two-sided, it looks like the sheet wound the other way: b is -b, seen from either side."""
        behind = self.picture(self.item(tension=True, two_sided=True), below=True)
        self.assert_alike(behind, self.picture(self.item(FLIP @ T @ FLIP, two_sided=True), below=True))
        self.put("rest.obj", obj(CORNERS, faces=[f[::-1] for f in FACES]))
        self.put("other.obj", obj(stretched(CORNERS), faces=[f[::-1] for f in FACES]))
        self.assert_alike(behind, self.picture(self.item(tension=True), "other.obj", below=True))
        self.assert_differ(behind, self.picture(self.item(T, two_sided=True), below=True))

    def test_a_mirrored_object(self):
        """As if its files were mirrored, corners turned so that the outside stays outside."""
        turned = [f[::-1] for f in FACES]
        mirrored = self.picture(self.item(tension=True, transform=[{"scale": [-1, 1, 1]}]))
        self.put("rest.obj", obj(CORNERS * [-1, 1, 1], faces=turned))
        self.put("other.obj", obj(stretched(CORNERS) * [-1, 1, 1], faces=turned))
        self.assert_alike(mirrored, self.picture(self.item(tension=True), "other.obj"))
        self.put("rest.obj", obj(CORNERS))
        self.assert_differ(mirrored, self.picture(self.item(T, transform=[{"scale": [-1, 1, 1]}])))

    def test_normals_against_the_winding(self):
        """They say where outside is; the triangles' order does not matter then."""
        turned = [f[::-1] for f in FACES]
        straight = self.picture(self.item(tension=True))
        self.put("rest.obj", obj(CORNERS, faces=turned, normal=(0, 0, 1)))
        self.put("other.obj", obj(stretched(CORNERS), faces=turned, normal=(0, 0, 1)))
        self.assert_alike(straight, self.picture(self.item(tension=True), "other.obj"))

    def test_only_what_deforms_varies(self):
        """One material on two objects: made twice, for the one with slots, for the other without."""
        plain = self.item()
        tense = self.item(tension=True)
        scene = json.loads(self.scene(plain).read_text())
        scene["materials"] = {"silver": plain["material"]}
        scene["objects"] = [dict(item, material="silver") for item in (plain, tense, plain, tense)]
        (self.folder / "scene.json").write_text(json.dumps(scene))
        told = strict(musurf("render", self.folder / "scene.json", "--explain").out)
        self.assertEqual([m["slot_floats"] > 0 for m in told["materials"]], [False, True])
        self.assertEqual([m["tension"] for m in told["meshes"]], [False, True])
        self.assertIn("tensions", told["features"])
        told = strict(musurf("render", self.scene(plain), "--explain").out)
        self.assertIn("tensions", told["left_out"])
        self.assertEqual([m["slot_floats"] for m in told["materials"]], [0])

    def test_refusals(self):
        self.put("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.put("fewer.obj", obj(CORNERS, faces=FACES[:1]))
        lambert = dict(self.item(), material={"material": "template.lambert"}, tension={"rest": "rest.obj"})
        cases = [(dict(self.item(), tension={"rest": "none.obj"}), "deformed.obj", r"\$.objects\[0\].tension.rest: .*No such file"),
                 (dict(self.item(), tension={"rest": "fewer.obj"}), "deformed.obj", "1 faces? .*2|2 faces .*1"),
                 (dict(self.item(), tension={"rest": "bare.obj"}), "bare.obj", "needs texture coordinates"),
                 (dict(self.item(), tension={}), "deformed.obj", "tension.rest: is missing"),
                 (dict(self.item(), tension=3), "deformed.obj", "tension: is 3; an object is needed"),
                 (dict(self.item(), tension={"file": "rest.obj"}), "deformed.obj", "this key is not known"),
                 (lambert, "deformed.obj", r"\$.objects\[0\].tension: template.lambert has no transform that may vary")]
        for item, mesh, pattern in cases:
            with self.subTest(pattern):
                done = musurf("render", self.scene(item, mesh), "--explain")
                self.assertEqual(done.returncode, 2)
                self.assertRegex(done.err, pattern)
                self.assertEqual(done.err.count("\n"), 1)
        self.put("point.obj", obj(CORNERS * 0))
        done = musurf("render", self.scene(dict(self.item(), tension={"rest": "point.obj"})), "--explain")
        self.assertEqual(done.returncode, 0)
        self.assertIn("of 2 triangles, 2 without area at rest", done.err)


if __name__ == "__main__":
    sys.exit(unittest.main())
