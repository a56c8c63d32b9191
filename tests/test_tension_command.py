#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf tension`: files in, numbers, PLY and SVG out, against the same definition written anew in numpy."""
import json
import math
import pathlib
import re
import struct
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import numpy as np

from command import musurf, strict
from tension_reference import reference


def sheet(n):
    """Positions, texture coordinates, triangles of a shaken square; cells are cut either way."""
    random = np.random.default_rng(5)
    x, y = np.meshgrid(np.arange(n + 1) / n, np.arange(n + 1) / n)
    flat = np.stack([x.ravel(), y.ravel()], 1) + random.uniform(-0.2 / n, 0.2 / n, ((n + 1) ** 2, 2))
    faces = []
    for j in range(n):
        for i in range(n):
            a, b, c, d = (k + j * (n + 1) + i for k in (0, 1, n + 1, n + 2))
            faces += [(a, b, c), (d, c, b)] if (i * 7 + j * 3) % 5 < 2 else [(a, b, d), (a, d, c)]
    return flat, np.array(faces)


def bend(p):
    x, y = p.T
    return np.stack([x + 0.3 * x * x, y + 0.2 * np.sin(2 * x + y), 0.4 * np.sin(3 * x) * np.cos(2 * y)], 1)


def obj(positions, uv, faces, extra=""):
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in np.asarray(positions).tolist()]
    lines += [f"vt {u!r} {v!r}" for u, v in np.asarray(uv).tolist()]
    return "\n".join(lines + ["f " + " ".join(f"{i + 1}/{i + 1}" for i in face) for face in faces]) + "\n" + extra


def ply(positions, uv, faces):
    rows = [" ".join(map(repr, [*p, *t])) for p, t in zip(np.asarray(positions).tolist(), np.asarray(uv).tolist())]
    rows += [" ".join(map(str, [len(face), *face])) for face in faces]
    return (f"ply\nformat ascii 1.0\nelement vertex {len(positions)}\n" +
            "".join(f"property float {name}\n" for name in "xyzst") +
            f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n" + "\n".join(rows) + "\n")


def glb(positions, uv, faces):
    """The node moves and scales what the buffers hold."""
    p, t, f = (np.ascontiguousarray(x, kind) for x, kind in ((positions, "<f4"), (uv, "<f4"), (faces, "<u4")))
    t = t * np.float32([1, -1]) + np.float32([0, 1])  # glTF's v grows downwards
    data = p.tobytes() + t.tobytes() + f.tobytes()
    views, at = [], 0
    for part in (p, t, f):
        views.append({"buffer": 0, "byteOffset": at, "byteLength": part.nbytes})
        at += part.nbytes
    text = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "translation": [3, 0, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2}]}],
        "buffers": [{"byteLength": len(data)}], "bufferViews": views,
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(p), "type": "VEC3",
                       "min": p.min(0).tolist(), "max": p.max(0).tolist()},
                      {"bufferView": 1, "componentType": 5126, "count": len(t), "type": "VEC2"},
                      {"bufferView": 2, "componentType": 5125, "count": f.size, "type": "SCALAR"}]}).encode()
    text += b" " * (-len(text) % 4)
    return (struct.pack("<5I", 0x46546c67, 2, 28 + len(text) + len(data), len(text), 0x4e4f534a) + text +
            struct.pack("<2I", len(data), 0x004e4942) + data)


class Tension(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def put(self, name, content):
        (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return self.folder / name

    def ask(self, rest, deformed, *more, warns=None):
        done = musurf("tension", rest, deformed, "--json", *more)
        self.assertEqual(done.returncode, 0, done.err)
        if warns is None:
            self.assertEqual(done.err, "")
        else:
            self.assertRegex(done.err, warns)
            self.assertEqual(done.err.count("\n"), 1)
        return strict(done.out)

    def refuse(self, rest, deformed, pattern, *more):
        done = musurf("tension", rest, deformed, *more)
        self.assertEqual((done.returncode, done.out), (2, ""))
        self.assertRegex(done.err, pattern)
        self.assertEqual(done.err.count("\n"), 1)

    def assert_matrices(self, found, expected, within):
        found = np.array(found).reshape(-1, 2, 2)
        self.assertEqual(found.shape, expected.shape)
        self.assertLess(np.abs(found - expected).max(), within)

    def test_files_of_all_kinds(self):
        """OBJ holds doubles; the others floats: edges of 0.1 are known to 1e-6 and M with them, twice that for worst angles."""
        flat, faces = sheet(9)
        rest, uv = np.column_stack([flat, 0 * flat[:, 0]]), flat @ np.array([[0.8, 0.3], [-0.2, 0.7]])
        expected = reference(rest, bend(flat), uv, faces)
        for write, name, within in ((obj, "obj", 1e-12), (ply, "ply", 5e-6), (glb, "glb", 5e-6)):
            found = self.ask(self.put("rest." + name, write(rest, uv, faces)),
                             self.put("deformed." + name, write(bend(flat), uv, faces)))
            self.assert_matrices(found["faces"], expected[0], within)
            self.assert_matrices(found["vertices"], expected[1], within)
            self.assertEqual(found["seams"], [])
            self.assertEqual(found["summary"]["points_without"], 0)

    def test_order_is_the_files(self):
        """Groups, materials that return, unused vertices, negative indices, continued lines: nothing changes the order."""
        flat, faces = sheet(3)
        rest, uv = np.column_stack([flat, 0 * flat[:, 0]]), flat
        expected = reference(rest, bend(flat), uv, faces)

        def tangled(positions):
            lines = obj(positions, uv, faces).splitlines()
            out, count = ["mtllib none.mtl # nothing", "v 9 9 9"], len(flat)
            for i, line in enumerate(line for line in lines if line[0] == "v"):
                out.append(line)
            for i, face in enumerate(faces):
                out += [f"usemtl {'abc'[i % 3]}", f"g part{i % 4}", f"o thing{i % 2}"]
                out.append("f  " + " ".join(f"{k - count}/{k - count}/" for k in face[:2]) + f" \\\n {face[2] - count}/{face[2] - count}")
            return "\r\n".join(out) + "\n"
        found = self.ask(self.put("a.obj", tangled(rest)), self.put("b.obj", tangled(bend(flat))), warns="1 vert")
        self.assert_matrices(found["faces"], expected[0], 1e-12)
        self.assert_matrices(found["vertices"][1:], expected[1], 1e-12)
        self.assertEqual(found["vertices"][0], [1, 0, 0, 1])

    def test_polygons_have_one_matrix_each(self):
        """A concave pentagon and a square under an affine map: that map, however they are cut."""
        square = [(0, 0, 0), (2, 0, 0), (2, 2, 0), (1, 0.5, 0), (0, 2, 0), (3, 0, 0), (3, 2, 0)]
        m = np.array([[1.5, 0.4], [0, 0.6]])
        moved = [(*(m @ p[:2]), 1) for p in square]
        faces = [(0, 1, 2, 3, 4), (1, 5, 6, 2)]
        uv = np.array(square)[:, :2]
        found = self.ask(self.put("a.obj", obj(square, uv, faces)), self.put("b.obj", obj(moved, uv, faces)))
        self.assert_matrices(found["faces"], np.array([m, m]), 1e-14)
        self.assert_matrices(found["vertices"], np.array([m] * 7), 1e-14)
        self.assertEqual(found["summary"]["triangles"], 5)

    def roof(self, height):
        """Two squares that meet in the ridge x = 1, where the texture has a seam; the right one is 1 + height wide."""
        points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2 + height, 0, 0), (2 + height, 1, 0)]
        return ("".join("v %r %r %r\n" % p for p in points) + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 5 5\nvt 5 6\nvt 4 6\nvt 4 5\n"
                "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\nf 2/8 5/5 6/6\nf 2/8 6/6 3/7\n")

    def test_seams(self):
        """Left of the seam nothing is stretched, right of it u by 2. At the seam both charts see the mean of the logarithms, by
        area and angle, in JSON and PLY: on the left two triangles of angles 45 degrees meet its ends, on the right, too."""
        output = self.folder / "out.ply"
        found = self.ask(self.put("a.obj", self.roof(0)), self.put("b.obj", self.roof(1)), "-o", output)
        middle = math.sqrt(2)
        np.testing.assert_allclose(found["vertices"], [[x, 0, 0, 1] for x in (1, middle, middle, 1, 2, 2)], atol=1e-14)
        self.assertEqual([(seam["vertex"], seam["uv"]) for seam in found["seams"]], [(1, [4, 5]), (2, [4, 6])])
        np.testing.assert_allclose([seam["m"] for seam in found["seams"]], [[middle, 0, 0, 1]] * 2, atol=1e-14)
        head, _, data = output.read_bytes().partition(b"end_header\n")
        names = re.findall(rb"property double (\w+)", head)
        self.assertEqual(names, [b"x", b"y", b"z", b"s", b"t", b"m00", b"m01", b"m10", b"m11"])
        vertices = np.frombuffer(data, "<f8", 8 * 9).reshape(8, 9)
        rows = np.frombuffer(data, [("n", "u1"), ("v", "<i4", 3)], offset=8 * 8 * 9)
        self.assertEqual(rows["v"].tolist(), [[0, 1, 2], [0, 2, 3], [6, 4, 5], [6, 5, 7]])
        self.assertEqual(vertices[:, 0].tolist(), [0, 1, 1, 0, 3, 3, 1, 1])
        np.testing.assert_allclose(vertices[:, 5], [1, middle, middle, 1, 2, 2, middle, middle], atol=1e-14)
        self.assertEqual(vertices[6:, 3:5].tolist(), [[4, 5], [4, 6]])
        again = self.ask(output, output)  # it is a mesh that this program reads
        self.assertEqual(again["summary"]["vertices"], 8)

    def test_coincident_vertices_are_one_point(self):
        """What an exporter split for its normals is joined where places and texture agree."""
        one = obj([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 0), (1, 0), (0, 1), (1, 1)], [(0, 1, 2), (3, 2, 1)])
        split = obj([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0), (0, 1, 0)],
                    [(0, 0), (1, 0), (0, 1), (1, 1), (1, 0), (0, 1)], [(0, 1, 2), (3, 5, 4)])
        moved = [text.replace("v 1 1 0", "v 2 1.5 1") for text in (one, split)]
        a = self.ask(self.put("a.obj", one), self.put("b.obj", moved[0]))
        b = self.ask(self.put("c.obj", split), self.put("d.obj", moved[1]))
        self.assertEqual(b["vertices"], a["vertices"] + a["vertices"][1:3])
        self.assertEqual(b["seams"], [])

    def test_what_is_counted(self):
        points, uv = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 0), (1, 0), (0, 1), (1, 1)]
        faces = [(0, 1, 2), (3, 2, 1)]
        good = self.put("good.obj", obj(points, uv, faces))
        turned = self.put("turned.obj", obj([(-y, x, 3) for x, y, z in points], uv, faces))
        cases = [
            ("flat uv", obj(points, [(0, 0)] * 4, faces), good, "uv_once", 2, "one file only"),
            ("none", obj(points, uv, []) + "f 1 2 3\nf 4 3 2\n", good, "uv_once", 2, "one file only"),
            ("changed", obj(points, [(v, -u) for u, v in uv], faces), good, "uv_changed", 2, "contains the turn"),
            ("deformed flat", good, obj(points[:3] + [(0.5, 0.5, 0)], uv, faces), "deformed_flat", 1, "without area deformed"),
            ("rest flat", obj(points[:3] + [(0.5, 0.5, 0)], uv, faces), good, "rest_flat", 1, "without area at rest"),
        ]
        for name, rest, deformed, count, expected, words in cases:
            with self.subTest(name):
                rest, deformed = (self.put(f"{i}.obj", x) if isinstance(x, str) else x for i, x in enumerate((rest, deformed)))
                found = self.ask(rest, deformed, warns=words)
                self.assertEqual(found["summary"][count], expected)
                self.assertTrue(np.isfinite(found["faces"]).all() and np.linalg.det(np.array(found["vertices"]).reshape(-1, 2, 2)).min() > 0)
                if count == "uv_once":
                    np.testing.assert_allclose(found["faces"], [[1, 0, 0, 1]] * 2, atol=1e-15)
                if count == "uv_changed":  # u runs along y at rest, along x deformed: y goes from (1, 0) to (0, 1)
                    np.testing.assert_allclose(found["faces"], [[0, -1, 1, 0]] * 2, atol=1e-15)
                    np.testing.assert_allclose(found["vertices"], [[0, -1, 1, 0]] * 4, atol=1e-15)
        double = obj([(2 * x, 2 * y, z) for x, y, z in points[:3] + [(0.5, 0.5, 0)]], uv, faces)
        found = self.ask(good, self.put("double.obj", double), warns="1 without area deformed")
        self.assertEqual(found["faces"], [[2, 0, 0, 2]] * 2)  # the second takes that of its corners
        self.assertEqual(found["vertices"], [[2, 0, 0, 2]] * 3 + [[1, 0, 0, 1]])
        bare = [self.put(f"bare{i}.obj", re.sub(r"/\d+", "", file.read_text())) for i, file in enumerate((good, turned))]
        found = self.ask(*bare, warns="2 without texture coordinates")
        np.testing.assert_allclose(found["faces"] + found["vertices"], [[1, 0, 0, 1]] * 6, atol=1e-15)
        flat = [self.put(f"flat{i}.obj", re.sub(r"vt .*", "vt 0.5 0.5", file.read_text())) for i, file in enumerate((good, turned))]
        found = self.ask(*flat, warns="2 without area in the texture")
        np.testing.assert_allclose(found["faces"] + found["vertices"], [[1, 0, 0, 1]] * 6, atol=1e-15)
        mirrored = [self.put(f"mirror{i}.obj", re.sub(r"vt (\S+)", r"vt -\1", file.read_text())) for i, file in enumerate((good, turned))]
        found = self.ask(*mirrored)
        self.assertEqual(found["summary"]["uv_mirrored"], 2)
        np.testing.assert_allclose(found["faces"] + found["vertices"], [[1, 0, 0, 1]] * 6, atol=1e-15)

    def test_mirrored_textures(self):
        """Mirrored at rest only: u and b point the other way there. Folded at the diagonal: there each side has its own chart."""
        points, uv, faces = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 0), (1, 0), (0, 1), (1, 1)], [(0, 1, 2), (3, 2, 1)]
        rest = self.put("rest.obj", obj(points, [(-u, v) for u, v in uv], faces))
        found = self.ask(rest, self.put("same.obj", obj(points, uv, faces)), warns="contains the turn")
        np.testing.assert_allclose(found["faces"] + found["vertices"], [[-1, 0, 0, -1]] * 6, atol=1e-15)
        folded = uv[:3] + [(0, 0)]  # u is along x in the first triangle, along -y in the second
        wide = [(2 * x, y, z) for x, y, z in points]
        found = self.ask(self.put("a.obj", obj(points, folded, faces)), self.put("b.obj", obj(wide, folded, faces)))
        self.assertEqual(found["faces"], [[2, 0, 0, 1], [1, 0, 0, 2]])
        np.testing.assert_allclose(found["vertices"], [[2, 0, 0, 1]] * 3 + [[1, 0, 0, 2]], atol=1e-14)
        self.assertEqual([(seam["vertex"], seam["uv"]) for seam in found["seams"]], [(2, [0, 1]), (1, [1, 0])])
        np.testing.assert_allclose([seam["m"] for seam in found["seams"]], [[1, 0, 0, 2]] * 2, atol=1e-14)

    def test_folds_are_counted(self):
        """One vertex of a fine sheet pushed across its neighbours turns some of its triangles over."""
        flat, faces = sheet(6)
        rest = np.column_stack([flat, 0 * flat[:, 0]])
        moved = rest.copy()
        moved[24] += (1.4 / 6, 0, 0)

        def double_area(p):
            return np.cross(p[faces[:, 1]] - p[faces[:, 0]], p[faces[:, 2]] - p[faces[:, 0]])[:, 2]
        turned = int((double_area(moved) < 0).sum())
        self.assertGreater(turned, 0)
        found = self.ask(self.put("a.obj", obj(rest, flat, faces)), self.put("b.obj", obj(moved, flat, faces)),
                         warns=f"{turned} turned over")
        self.assertEqual(found["summary"]["inverted"], turned)

    def test_refusals(self):
        points, uv, faces = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 0), (1, 0), (0, 1), (1, 1)], [(0, 1, 2), (3, 2, 1)]
        good = self.put("good.obj", obj(points, uv, faces))
        for name, text, pattern in (
                ("fewer.obj", obj(points, uv, faces[:1]), "1 faces .*2: both must be one mesh"),
                ("more.obj", obj(points + [(2, 2, 2)], uv, faces), "5 vertices .*4"),
                ("other.obj", obj(points, uv, [(0, 1, 2), (3, 1, 2)]), "corner 1 of face 1"),
                ("turned.obj", obj(points, uv, [(0, 1, 2), (1, 2, 3)]), "face 1 .from 0. runs the other way round"),
                ("quad.obj", obj(points, uv, [(0, 1, 2, 3), (3, 2, 1)]), "face 0 has 4 vertices"),
                ("nan.obj", obj(points[:3] + [(math.nan, 0, 0)], uv, faces), r"nan.obj:4: .*nan"),
                ("inf.ply", ply(points[:3] + [(math.inf, 0, 0)], uv, faces), "vertex 3 .*inf"),
                ("index.obj", obj(points, uv, [(0, 1, 9)]), "index.obj:9: a face names vertex 10 of 4"),
                ("zero.obj", "v 0 0 0\nf 0 1 1\n", "names vertex 0"),
                ("word.obj", "v 0 zero 0\n", "word.obj:1: 3 numbers"),
                ("line.obj", obj(points, uv, [(0, 1)]), "a face of 2 vertices"),
                ("empty.obj", "", "empty"),
                ("cut.ply", ply(points, uv, faces)[:-6], "truncated"),
                ("mesh.stl", "", "not a mesh file")):
            with self.subTest(name):
                self.refuse(good, self.put(name, text), pattern)
        self.refuse(good, self.folder / "missing.obj", "No such file")
        self.refuse(good, good, "no/such/folder|No such file", "-o", self.folder / "no/such/folder.ply")
        self.refuse(good, good, "-o is .*m.obj.*ends in .ply", "-o", self.folder / "m.obj")
        self.refuse(good, good, "--picture is .*p.png.*ends in .svg", "--picture", self.folder / "p.png")
        same = self.put("same.ply", ply(points, uv, faces))
        self.refuse(same, good, "same.ply: would replace a mesh", "-o", same)
        self.refuse(good, same, "same.ply: would replace a mesh", "-o", same)
        bare = self.put("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        done = musurf("tension", bare, bare, "--picture", self.folder / "no.svg")
        self.assertEqual((done.returncode, done.out), (2, ""))
        self.assertIn("no texture coordinates", done.err)
        self.assertFalse((self.folder / "no.svg").exists())
        self.assertEqual(musurf("tension", good).returncode, 2)
        self.assertEqual(musurf("tension", good, good, good).returncode, 2)

    def test_picture(self):
        """An ellipse in each triangle: its axes in the ratio of the stretches, along the stretched direction."""
        points, uv = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], [(0, 0), (1, 0), (0, 1), (1, 1)]
        m = np.array([[1.2, 0.7], [0, 0.9]])
        left, values, _ = np.linalg.svd(m)
        picture = self.folder / "p.svg"
        self.ask(self.put("a.obj", obj(points, uv, [(0, 1, 2), (3, 2, 1)])),
                 self.put("b.obj", obj([(*(m @ p[:2]), 0) for p in points], uv, [(0, 1, 2), (3, 2, 1)])), "--picture", picture)
        ellipses = [e for e in xml.etree.ElementTree.parse(picture).iter() if e.tag.endswith("ellipse")]
        self.assertEqual(len(ellipses), 2)
        for e in ellipses:
            self.assertAlmostEqual(float(e.get("rx")) / float(e.get("ry")), values[0] / values[1], delta=1e-4)
            turn = -float(e.get("transform")[7:].split()[0])  # y points down
            expected = math.degrees(math.atan2(left[1, 0], left[0, 0]))
            self.assertAlmostEqual((turn - expected + 90) % 180, 90, delta=1e-3)


if __name__ == "__main__":
    sys.exit(unittest.main())
