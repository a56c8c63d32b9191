#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Poses of glTF and FBX files, by morph targets, bones and animations, against the same written in numpy.

A tube of three bones: "root" stands turned and scaled by two in the file, "middle" and "end" follow each other along z. glTF
holds floats: positions within 4 have an error of 2e-7 in each of a few products, of which 5e-6 leaves ten times more
room; edges are 0.2 long, so that M is known to 5e-5, of which its derivatives leave less than half.
"""
import json
import pathlib
import re
import sys
import tempfile
import unittest
import unittest.mock

import numpy as np

import exr
import fbx
import gltf
from command import microfacet, musurf, strict

AROUND, UP = 16, 12
PLACE, SLOPE = 5e-6, 5e-5


def tube():
    u, v = (x.ravel() for x in np.meshgrid(np.arange(AROUND + 1) / AROUND, np.arange(UP + 1) / UP))
    angle = 2 * np.pi * (u % 1)
    positions = np.stack([0.6 * np.cos(angle), 0.6 * np.sin(angle), 3 * v], 1)
    faces = []
    for j in range(UP):
        for i in range(AROUND):
            a = j * (AROUND + 1) + i
            faces += [(a, a + 1, a + AROUND + 2), (a, a + AROUND + 2, a + AROUND + 1)]
    return positions.astype("<f4").astype(float), np.stack([u, v], 1), np.array(faces)


POSITIONS, UVS, FACES = tube()
SWELL = np.column_stack([POSITIONS[:, :2] * (np.sin(np.pi * UVS[:, 1]) * 0.8)[:, None], 0 * UVS[:, 0]]).astype("<f4").astype(float)
LEAN = np.stack([UVS[:, 1] ** 2, 0.3 * UVS[:, 1], 0 * UVS[:, 0]], 1).astype("<f4").astype(float)
HEIGHTS = (0, 1, 2)  # of the bones


def weights():
    """Smooth, of three bones; they are stored as floats, and are normalised."""
    w = np.exp(-4 * (POSITIONS[:, 2:] - np.array(HEIGHTS) - 0.5) ** 2).astype("<f4").astype(float)
    return w / w.sum(1, keepdims=True)


def quaternion(axis, angle):
    return np.array([*(np.array(axis) / np.linalg.norm(axis) * np.sin(angle / 2)), np.cos(angle / 2)])


def matrix(t=(0, 0, 0), q=(0, 0, 0, 1), s=(1, 1, 1)):
    x, y, z, w = q
    r = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                  [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                  [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])
    out = np.eye(4)
    out[:3, :3], out[:3, 3] = r * np.array(s), t
    return out


ARMATURE = dict(t=(0.3, -0.2, 0.1), q=quaternion((1, 2, 3), 0.4), s=(2, 2, 2))
TIMES = (0, 0.5, 1.5)
TURNS = [quaternion((1, 0.2, 0), a) for a in (0, 0.5, -0.7)]
TWISTS = [quaternion((0, 0.1, 1), a) for a in (0, 1.1, 0.2)]
MOVES = [(0, 0, 1), (0.1, 0, 1.2), (0, -0.1, 1.1)]
SWELLS = [(0, 0), (1, 0.2), (0.4, 0)]


def slerp(a, b, t):
    b = b if a @ b > 0 else -b
    angle = np.arccos(min(1, a @ b))
    return (np.sin((1 - t) * angle) * a + np.sin(t * angle) * b) / np.sin(angle) if angle > 1e-9 else a


def at(values, time, mix):
    k = int(np.clip(np.searchsorted(TIMES, time, "right") - 1, 0, len(TIMES) - 2))
    return mix(np.asarray(values[k], float), np.asarray(values[k + 1], float),
               np.clip((time - TIMES[k]) / (TIMES[k + 1] - TIMES[k]), 0, 1))


def linear(a, b, t):
    return (1 - t) * a + t * b


def skin_matrices(time):
    """World times inverse bind matrix of the bones; time None: as the file stands, which is bound."""
    local = [matrix(**ARMATURE), matrix(t=(0, 0, 1)), matrix(t=(0, 0, 1))]
    if time is not None:
        local[1] = matrix(t=at(MOVES, time, linear), q=at(TURNS, time, slerp))
        local[2] = matrix(t=(0, 0, 1), q=at(TWISTS, time, slerp))
    world = [local[0], local[0] @ local[1], local[0] @ local[1] @ local[2]]
    return [w @ matrix(t=(0, 0, -h)) for w, h in zip(world, HEIGHTS)]


def posed(swell=0, lean=0, time=None, matrices=skin_matrices):
    p = np.column_stack([POSITIONS + swell * SWELL + lean * LEAN, 0 * UVS[:, 0] + 1])
    return sum(w[:, None] * (p @ m.T)[:, :3] for w, m in zip(weights().T, matrices(time)))


def ripples():
    """Normals that are not the surface's, and what the first target adds to them."""
    u, v = UVS.T
    out = np.column_stack([POSITIONS[:, :2] / 0.6, 0.3 * np.sin(6 * np.pi * v)])
    more = np.stack([0.3 * np.sin(4 * np.pi * u), 0 * u, 0.4 * np.cos(3 * v)], 1)
    return (x.astype("<f4").astype(float) for x in (out / np.linalg.norm(out, axis=1, keepdims=True), more))


def posed_normals(swell, time):
    """By the cofactors of the mean matrix of each vertex."""
    normals, more = ripples()
    matrices = np.einsum("bij,vb->vij", np.array(skin_matrices(time))[:, :3, :3], weights())
    turned = np.einsum("vij,vj->vi", np.linalg.inv(matrices).transpose(0, 2, 1), normals + swell * more)
    return turned / np.linalg.norm(turned, axis=1, keepdims=True)


def glb(normals=False):
    w = gltf.Writer()
    weight = np.column_stack([weights(), 0 * UVS[:, 0]])
    joints = np.tile(np.arange(4, dtype="<u2") % 3, (len(POSITIONS), 1))
    primitive = {"attributes": {"POSITION": w.add(POSITIONS, bounds=True), "TEXCOORD_0": w.add(UVS * [1, -1] + [0, 1]),
                                "JOINTS_0": w.add(joints, gltf.SHORT), "WEIGHTS_0": w.add(weight)},
                 "indices": w.add(FACES.ravel(), gltf.INT),
                 "targets": [{"POSITION": w.add(target, bounds=True)} for target in (SWELL, LEAN)]}
    if normals:
        own, more = ripples()
        primitive["attributes"]["NORMAL"] = w.add(own)
        primitive["targets"][0]["NORMAL"] = w.add(more)
        primitive["targets"][1]["NORMAL"] = w.add(0 * more)
    inverse = w.add([matrix(t=(0, 0, -h)).T for h in HEIGHTS])
    animations = [w.animation("Wave", [(2, "rotation", TIMES, TURNS), (2, "translation", TIMES, MOVES), (3, "rotation", TIMES, TWISTS)]),
                  w.animation("Breathe", [(0, "weights", TIMES, np.ravel(SWELLS))])]
    nodes = [{"name": "tube", "mesh": 0, "skin": 0},
             {"name": "root", "translation": ARMATURE["t"], "rotation": ARMATURE["q"].tolist(), "scale": ARMATURE["s"], "children": [2]},
             {"name": "middle", "translation": (0, 0, 1), "children": [3]}, {"name": "end", "translation": (0, 0, 1)}]
    return w.finish(scenes=[{"nodes": [0, 1]}], nodes=nodes, animations=animations,
                    meshes=[{"name": "skin", "primitives": [primitive], "weights": [0, 0], "extras": {"targetNames": ["Swell", "Lean"]}}],
                    skins=[{"joints": [1, 2, 3], "inverseBindMatrices": inverse}])


def obj(positions, normals=None):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in positions.tolist()] + [f"vt {u!r} {v!r}" for u, v in UVS.tolist()]
    corner = "{0}/{0}"
    if normals is not None:
        lines += [f"vn {x!r} {y!r} {z!r}" for x, y, z in normals.tolist()]
        corner = "{0}/{0}/{0}"
    return "\n".join(lines + ["f " + " ".join(corner.format(i + 1) for i in face) for face in FACES]) + "\n"


def positions_of(file):
    head, _, data = file.read_bytes().partition(b"end_header\n")
    count, width = int(re.search(rb"element vertex (\d+)", head)[1]), len(re.findall(rb"property double", head))
    return np.frombuffer(data, "<f8", count * width).reshape(count, width)[:, :3]


FBX_TURNS = [(0, 0, 0), (40, 0, 0), (-25, 0, 0)]  # degrees: one axis each, about which angles are linear between keys, too
FBX_TWISTS = [(0, 0, 0), (0, 0, 60), (0, 0, 10)]


def fbx_matrices(time):
    """Both as skin_matrices; the first bone is scaled by two and turned about y, and the mesh was bound there."""
    local = [matrix((0.3, -0.2, 0.1), quaternion((0, 1, 0), np.radians(30)), (2, 2, 2)), matrix((0, 0, 1)), matrix((0, 0, 1))]
    bound = [local[0] @ matrix((0, 0, h)) for h in HEIGHTS]
    if time is not None:
        turn, twist = (np.radians(at(x, time, linear)) for x in (FBX_TURNS, FBX_TWISTS))
        local[1] = matrix(at(MOVES, time, linear), quaternion((1, 0, 0), turn[0]))
        local[2] = matrix((0, 0, 1), quaternion((0, 0, 1), twist[2]))
    world = [local[0], local[0] @ local[1], local[0] @ local[1] @ local[2]]
    return bound, [w @ np.linalg.inv(b) for w, b in zip(world, bound)]


def fbx_file():
    w, bound = fbx.Writer(), fbx_matrices(None)[0]
    w.mesh("tube", POSITIONS, UVS, FACES)
    w.shape("Swell", SWELL)
    w.shape("Lean", LEAN)
    turns = (0, 30, 0), (0, 0, 0), (0, 0, 0)
    moves, scales = ((0.3, -0.2, 0.1), (0, 0, 1), (0, 0, 1)), ((2, 2, 2), (1, 1, 1), (1, 1, 1))
    models = w.bones(list(zip(("root", "middle", "end"), moves, turns, scales, bound)), weights())
    w.animation("Wave", TIMES, [(models[1], "Lcl Rotation", FBX_TURNS), (models[1], "Lcl Translation", MOVES), (models[2], "Lcl Rotation", FBX_TWISTS)])
    return w.finish()


CASES = [({"morph": {"Swell": 0.7}}, dict(swell=0.7)), ({"morph": {"Swell": 1.5, "Lean": -0.4}}, dict(swell=1.5, lean=-0.4)),
         ({"animation": "Wave", "time": 0.2}, dict(time=0.2)), ({"animation": "Wave", "time": 1.25}, dict(time=1.25)),
         ({"animation": "Wave", "time": 99}, dict(time=1.5)), ({"animation": "Breathe", "time": 0.25}, dict(swell=0.5, lean=0.1)),
         ({"animation": "Wave", "time": 0.8, "morph": {"Lean": 0.5}}, dict(time=0.8, lean=0.5)),
         ({"animation": "Breathe", "time": 0.5, "morph": {"Lean": 0}}, dict(swell=1)), ({}, {})]


class Pose(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        (cls.folder / "tube.glb").write_bytes(glb())
        (cls.folder / "rest.obj").write_text(obj(posed()))

    def tension(self, *arguments):
        done = musurf("tension", *arguments, "--json", "-o", self.folder / "out.ply")
        self.assertEqual((done.returncode, done.err), (0, ""))
        return strict(done.out)

    def expected(self, **moment):
        (self.folder / "posed.obj").write_text(obj(posed(**moment)))
        return self.tension(self.folder / "rest.obj", self.folder / "posed.obj")

    def test_places_and_tension(self):
        for pose, moment in CASES:
            with self.subTest(pose):
                expected = self.expected(**moment)
                found = self.tension(self.folder / "tube.glb", "--pose", json.dumps(pose))
                self.assertLess(np.abs(positions_of(self.folder / "out.ply")[:len(POSITIONS)] - posed(**moment)).max(), PLACE)
                self.assertLess(np.abs(np.subtract(found["faces"], expected["faces"])).max(), SLOPE)
                self.assertLess(np.abs(np.subtract(found["vertices"], expected["vertices"])).max(), SLOPE)

    def test_other_rest(self):
        """A pose against another file at rest."""
        found = self.tension(self.folder / "rest.obj", self.folder / "tube.glb", "--pose", '{"morph": {"Swell": 0.7}}')
        self.assertLess(np.abs(np.subtract(found["faces"], self.expected(swell=0.7)["faces"])).max(), SLOPE)

    def test_fbx(self):
        """The same of an FBX, whose vertices are corners, bound where its first bone stands."""
        file = self.folder / "tube.fbx"
        file.write_text(fbx_file())
        rest = obj(POSITIONS)
        (self.folder / "bound.obj").write_text(rest)
        for pose, moment in (({"morph": {"Swell": 0.7}}, dict(swell=0.7)), ({"animation": "Wave", "time": 0.2}, dict(time=0.2)),
                             ({"animation": "Wave", "time": 1.25, "morph": {"Lean": 0.5}}, dict(time=1.25, lean=0.5)), ({}, {})):
            with self.subTest(pose):
                found = self.tension(file, "--pose", json.dumps(pose))
                places = positions_of(self.folder / "out.ply")[:FACES.size]
                expected = posed(**moment, matrices=lambda time: fbx_matrices(time)[1])
                self.assertLess(np.abs(places - expected[FACES.ravel()]).max(), PLACE)
                (self.folder / "moved.obj").write_text(obj(expected))
                expected = self.tension(self.folder / "bound.obj", self.folder / "moved.obj")
                self.assertLess(np.abs(np.subtract(found["faces"], expected["faces"])).max(), SLOPE)

    def test_rigid_poses_are_none(self):
        """All bones turned as one leave M = 1, however bent the tube is."""
        found = self.tension(self.folder / "tube.glb", "--pose", "{}")
        np.testing.assert_allclose(found["faces"], [[1, 0, 0, 1]] * len(FACES), atol=1e-6)

    def picture(self, mesh, *options, **item):
        material = microfacet(alpha=0.2, fresnel={"conductor": "Ag"}, sampler="visible")
        scene = {"camera": {"position": [7, -6, 6], "target": [1, 0, 3], "up": [0, 0, 1], "fov": 50},
                 "film": {"width": 48, "height": 48, "pixels": "float"}, "integrator": {"samples": 4},
                 "meshes": {"m": {"file": mesh}}, "lights": [{"type": "studio"}],
                 "objects": [dict({"mesh": "m", "material": material}, **item)]}
        (self.folder / "scene.json").write_text(json.dumps(scene))
        done = musurf("render", self.folder / "scene.json", "-o", self.folder / "out.exr", "--quiet", *options)
        self.assertEqual((done.returncode, done.err), (0, ""))
        channels = exr.read(self.folder / "out.exr")[1]
        return np.stack([channels[c] for c in "RGB"])

    def test_pictures(self):
        """With tension and without, as of the same shape written out."""
        pose, moment = {"animation": "Wave", "time": 1.25, "morph": {"Swell": 0.7}}, dict(time=1.25, swell=0.7)
        (self.folder / "posed.obj").write_text(obj(posed(**moment)))
        plain = self.picture("tube.glb", pose=pose)
        tense = self.picture("tube.glb", pose=pose, tension="bind")
        for found, expected in ((plain, self.picture("posed.obj")),
                                (tense, self.picture("posed.obj", tension={"rest": "rest.obj"}))):
            self.assertGreater(expected.std(), 0.01)
            self.assertLess((np.abs(found - expected) > 1e-3 * (1 + expected)).mean(), 0.01)
        self.assertGreater((np.abs(plain - tense) > 1e-3 * (1 + plain)).mean(), 0.05)

    def test_normals(self):
        """The file's own, which targets and bones change."""
        (self.folder / "rippled.glb").write_bytes(glb(normals=True))
        pose, time, swell = {"animation": "Wave", "time": 1.25, "morph": {"Swell": 0.7}}, 1.25, 0.7
        (self.folder / "rippled.obj").write_text(obj(posed(swell, time=time), posed_normals(swell, time)))
        found, expected = self.picture("rippled.glb", pose=pose), self.picture("rippled.obj")
        self.assertLess((np.abs(found - expected) > 1e-3 * (1 + expected)).mean(), 0.01)
        (self.folder / "rippled.obj").write_text(obj(posed(swell, time=time), posed_normals(0, time)))
        self.assertGreater((np.abs(found - self.picture("rippled.obj")) > 1e-3 * (1 + found)).mean(), 0.05)

    def test_moments_from_the_command_line(self):
        """--frame of a numbered sequence, the first without; --pose-time."""
        for frame, swell in ((7, 0.2), (12, 0.9), (1000, 0.5)):
            (self.folder / f"tube_{frame:03}.obj").write_text(obj(posed(swell=swell)))
        (self.folder / "tube_0012.obj").write_text("another sequence")
        (self.folder / "tube_1.obj").write_text("another sequence")
        for options, file in (([], "tube_007.obj"), (["--frame", 12], "tube_012.obj"), (["--frame", 1000], "tube_1000.obj")):
            np.testing.assert_array_equal(self.picture("tube_###.obj", *options), self.picture(file))
        wave = {"animation": "Wave", "time": 0.3}
        at = self.picture("tube.glb", "--pose-time", 1.25, pose=wave)
        np.testing.assert_array_equal(at, self.picture("tube.glb", pose={"animation": "Wave", "time": 1.25}))
        self.assertTrue((at != self.picture("tube.glb", pose=wave)).any())
        for mesh, options, pattern in (("tube_###.obj", ["--frame", 8], r'\$.meshes.m.file: .*tube_008.obj: No such file'),
                                       ("none_#.obj", [], "there is no file of this sequence"),
                                       ("rest.obj", ["--frame", 8], "has no numbered meshes"),
                                       ("rest.obj", ["--pose-time", 8], 'has no "pose" with an animation')):
            scene = {"meshes": {"m": {"file": mesh}}, "objects": [{"mesh": "m", "material": {"material": "template.lambert"}}]}
            (self.folder / "bad.json").write_text(json.dumps(scene))
            done = musurf("render", self.folder / "bad.json", "--explain", *options)
            self.assertEqual(done.returncode, 2)
            self.assertRegex(done.err, pattern)

    def test_tension_of_sequences(self):
        swells = {3: 0.25, 5: 0.5, 10: 1.0}
        for frame, swell in swells.items():
            (self.folder / f"seq_{frame:04}.obj").write_text(obj(posed(swell=swell)))
        rest = self.folder / "rest.obj"
        done = musurf("tension", rest, self.folder / "seq_####.obj", "-o", self.folder / "t_##.ply", "--json")
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.err, r"^musurf: warning: .*seq_####.obj: of the numbers from 3 to 10, 5 have no file\n$")
        told = [strict(line) for line in done.out.splitlines()]
        self.assertEqual([line["frame"] for line in told], [3, 5, 10])
        for line in told:
            expected = self.tension(rest, self.folder / f"seq_{line['frame']:04}.obj")
            self.assertEqual({k: v for k, v in line.items() if k != "frame"}, expected)
            self.assertEqual((self.folder / f"t_{line['frame']:02}.ply").read_bytes(), (self.folder / "out.ply").read_bytes())
        one = musurf("tension", rest, self.folder / "seq_####.obj", "--frame", 5, "--json")
        self.assertEqual(strict(one.out), told[1])
        done = musurf("tension", rest, self.folder / "seq_####.obj", "-o", self.folder / "one.ply")
        self.assertEqual((done.returncode, done.out), (2, ""))
        self.assertIn("one file for a sequence", done.err)

    def test_refusals(self):
        tube, rest = self.folder / "tube.glb", self.folder / "rest.obj"
        for arguments, pattern in (
                ([tube, "--pose", '{"morph": {"Grow": 1}}'], 'no morph target "Grow"; the file has "Swell", "Lean"'),
                ([tube, "--pose", '{"animation": "Walk"}'], 'no animation "Walk"; the file has "Wave", "Breathe"'),
                ([tube, "--pose", '{"time": 1}'], r'--pose.*\$.time: is the time of an "animation", which is not named'),
                ([tube, "--pose", '{"morf": {}}'], 'not known.*"morph"'),
                ([tube, "--pose", '{"morph": {"Swell": "much"}}'], r"\$.morph.Swell: "),
                ([tube, "--pose", "walk"], "--pose"),
                ([rest, "--pose", "{}"], "rest.obj: holds no poses"),
                ([tube], "two mesh files are needed"),
                ([rest, rest, "--frame", "3"], "--frame is of a sequence")):
            with self.subTest(pattern):
                done = musurf("tension", *arguments)
                self.assertEqual((done.returncode, done.out), (2, ""))
                self.assertRegex(done.err, pattern)
                self.assertEqual(done.err.count("\n"), 1)


    def test_turns_that_are_no_numbers(self):
        """A rotation of NaN is refused as a place of NaN is, not taken for none."""
        broken = self.folder / "broken.glb"
        with unittest.mock.patch.dict(globals(), TURNS=np.full_like(TURNS, np.nan)):
            broken.write_bytes(glb())
        done = musurf("tension", broken, "--pose", '{"animation": "Wave", "time": 0.5}')
        self.assertEqual((done.returncode, done.out), (2, ""))
        self.assertRegex(done.err, "broken.glb: vertex 0 has a position of .*nan.*must be within")


if __name__ == "__main__":
    sys.exit(unittest.main())
