#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf surface mesh` and `musurf surface measure --bits`: files that others read, against numpy's own arithmetic."""
import os
import pathlib
import re
import resource
import sys
import tempfile
import unittest

import numpy as np

from command import ROOT, musurf, strict
from test_surface_command import MAPS, VIEWS, numbers, write_exr

sys.path.insert(0, str(ROOT / "scripts"))
import exact_caster  # noqa: E402
from crosscheck import heightfield, masking  # noqa: E402


def read_obj(file):
    lines = [line.split() for line in file.read_text().splitlines()]
    return (np.array([line[1:] for line in lines if line[0] == "v"], float),
            np.array([line[1:] for line in lines if line[0] == "f"], int) - 1)


def read_ply(file):
    head, _, data = file.read_bytes().partition(b"end_header\n")
    vertices, faces = (int(x) for x in re.findall(rb"element \w+ (\d+)\n", head))
    assert head.startswith(b"ply\nformat binary_little_endian 1.0\n") and head.count(b"property double") == 3
    points = np.frombuffer(data, "<f8", 3 * vertices).reshape(-1, 3)
    rows = np.frombuffer(data, [("n", "u1"), ("v", "<i4", 3)], offset=24 * vertices)
    assert len(rows) == faces and (rows["n"] == 3).all()
    return points, rows["v"]


def read_pov(file):
    """vertices and faces of the mesh2, and by how much its copies are moved."""
    text = file.read_text()
    lists = re.search(r"mesh2 \{\nvertex_vectors \{ (\d+),\n([^}]*)\}\nface_indices \{ (\d+),\n([^}]*)\}\n\}\n", text)

    def vectors(body, kind, count):
        rows = np.array(re.sub("[<>\n]", "", body).split(","), kind).reshape(-1, 3)
        assert len(rows) == int(count)
        return rows
    shifts = re.findall(r"translate <(.*)> \}", text)
    return (vectors(lists[2], float, lists[1]), vectors(lists[4], int, lists[3]),
            np.array([s.split(",") for s in shifts], float))


class Surface(unittest.TestCase):
    N = 16

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.h = heightfield.make(self.N, 0.5, 3.0, 7).astype(np.float32).astype(float)
        self.file = self.folder / "h.exr"
        write_exr(self.file, self.h)


class Mesh(Surface):
    def write(self, name, m, *more):
        done = musurf("surface", "mesh", self.file, f"--transform={numbers(m)}", "-o", self.folder / name, *more)
        self.assertEqual((done.returncode, done.err), (0, ""))
        return strict(done.out)

    def expected(self, m, tiles=0):
        """Vertices by the same two products and one sum, and triangles by their definition."""
        n, first = self.N, -tiles * self.N
        side = (2 * tiles + 1) * n + 1
        i, j = np.meshgrid(np.arange(side) + first, np.arange(side) + first, indexing="ij")
        points = np.stack([m[0, 0] * i + m[0, 1] * j, m[1, 0] * i + m[1, 1] * j, self.h[i % n, j % n]], -1)
        at = np.arange(side * side).reshape(side, side)
        p00, p10, p01, p11 = at[:-1, :-1], at[1:, :-1], at[:-1, 1:], at[1:, 1:]
        lower, upper = np.stack([p00, p10, p01], -1), np.stack([p11, p01, p10], -1)
        faces = np.stack([lower, upper], 2).reshape(-1, 3)
        return points.reshape(-1, 3), faces[:, ::-1] if np.linalg.det(m) < 0 else faces

    def assert_triangles(self, points, faces, expected):
        np.testing.assert_array_equal(points, expected[0])  # the very doubles
        first = faces.argmin(1), expected[1].argmin(1)      # a triangle may begin at any of its corners
        turn = lambda f, k: np.take_along_axis(f, (k[:, None] + np.arange(3)) % 3, 1)
        np.testing.assert_array_equal(turn(faces, first[0]), turn(expected[1], first[1]))
        a, b, c = (points[faces[:, k]] for k in range(3))
        self.assertGreater(np.cross(b - a, c - a)[:, 2].min(), 0)  # normals point up

    def test_ply_and_obj_hold_the_baked_triangles(self):
        for name, m in {"identity": np.eye(2), **MAPS}.items():
            for tiles in (0, 1):
                expected = self.expected(m, tiles)
                for ending, read in (("ply", read_ply), ("obj", read_obj)):
                    with self.subTest(map=name, tiles=tiles, format=ending):
                        said = self.write(f"m.{ending}", m, f"--tiles={tiles}")
                        points, faces = read(self.folder / f"m.{ending}")
                        self.assert_triangles(points, faces, expected)
                        self.assertEqual(said, {"file": str(self.folder / f"m.{ending}"), "format": ending,
                                                "vertices": len(points), "triangles": len(faces)})

    def test_pov_holds_one_period_and_where_its_copies_stand(self):
        for name, m in MAPS.items():
            with self.subTest(map=name):
                self.write("m.inc", m)
                points, faces, shifts = read_pov(self.folder / "m.inc")
                self.assert_triangles(points, faces, self.expected(m))
                self.assertEqual(len(shifts), 0)
                self.write("m", m, "--tiles=2", "--format=pov")
                points, faces, shifts = read_pov(self.folder / "m")
                self.assert_triangles(points, faces, self.expected(m))
                steps = np.arange(-2, 3) * self.N
                want = {(m[0, 0] * x + m[0, 1] * y, m[1, 0] * x + m[1, 1] * y, 0.0) for x in steps for y in steps}
                self.assertEqual({tuple(s) for s in shifts.tolist()}, want)

    def test_refusals_leave_nothing(self):
        out = self.folder / "m.ply"
        for arguments, words in [((self.file,), "-o FILE is needed"), (("-o", out), "FILE is needed"),
                                 ((self.file, "-o", self.folder / "m.stl"), "--format pov, ply or obj is needed"),
                                 ((self.file, "-o", out, "--transform=1,2,2,4"), "singular"),
                                 ((self.file, "-o", out, "--tiles=-1"), "--tiles"),
                                 ((self.file, "-o", out, "--format=stl"), "pov, ply, obj"),
                                 ((self.file, "-o", "/nonexistent/m.ply"), "No such file"),
                                 ((self.folder / "none.exr", "-o", out), "No such file"),
                                 ((self.file, "-o", out, "--tiles=1024", "--format=obj"), "2^31")]:
            if "2^31" in words:
                write_exr(self.file, np.zeros((64, 64)))
            with self.subTest(arguments=arguments):
                done = musurf("surface", "mesh", *arguments)
                self.assertEqual((done.returncode, done.out), (2, ""))
                self.assertRegex(done.err, r"^musurf surface mesh: [^\n]*\n$")
                self.assertIn(words, done.err)
                self.assertEqual(os.listdir(self.folder), ["h.exr"])

    def test_old_file_survives_failure(self):
        for ending in ("obj", "ply", "pov"):
            out = self.folder / f"m.{ending}"
            out.write_bytes(b"precious")
            done = musurf("surface", "mesh", self.file, "-o", out, restore_signals=False,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)))
            self.assertEqual((done.returncode, done.out), (2, ""))
            self.assertRegex(done.err, r"^musurf surface mesh: [^\n]*: cannot be written[^\n]*\n$")
            self.assertEqual(out.read_bytes(), b"precious")
            self.assertFalse([name for name in os.listdir(self.folder) if name.endswith(".tmp")])


class Bits(Surface):
    def test_bits_are_the_exact_casters(self):
        out = self.folder / "bits.npy"
        done = musurf("surface", "measure", self.file, *[f"--view={numbers(v)}" for v in VIEWS], "--bits", out)
        self.assertEqual((done.returncode, done.err), (0, ""))
        raw, bits = out.read_bytes(), np.load(out)
        self.assertEqual((raw[:8], (len(raw) - bits.size) % 64), (b"\x93NUMPY\x01\x00", 0))
        self.assertEqual((bits.dtype, bits.shape, bits.flags.c_contiguous), (np.uint8, (3, 2, self.N, self.N), True))
        slopes = heightfield.slopes(self.h)
        i, j = np.meshgrid(np.arange(self.N), np.arange(self.N), indexing="ij")
        for v, seen, view in zip(VIEWS, bits, strict(done.out)["views"]):
            exact = exact_caster.visible(self.h, np.stack([i + 0.25, i + 0.75], 2), np.stack([j + 0.5, j + 0.5], 2),
                                         masking.facing(slopes, v) > 0, v)
            np.testing.assert_array_equal(seen, exact.transpose(2, 0, 1))
            self.assertEqual(seen.sum(), view["visible"])

    def test_unwritable_is_said_before_the_work(self):
        done = musurf("surface", "measure", self.file, "--view=1,0,1", "--bits=/nonexistent/b.npy")
        self.assertEqual((done.returncode, done.out), (2, ""))
        self.assertRegex(done.err, r"^musurf surface measure: [^\n]*No such file[^\n]*\n$")


if __name__ == "__main__":
    unittest.main()
