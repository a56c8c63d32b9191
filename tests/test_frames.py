#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Neither triangles nor seams of the texture show in anisotropic highlights: pictures of a coarse bent tube, close to its edges.

A view along an edge, which stands upright in its middle, as high as a share s of the edge; one parallel light near the mirror
direction, so that nothing is random but where in a pixel a sample falls. d(s) is the right half's mean minus the left's. Where
the picture is continuous, d(s) = a s + b s^2 + ...: the slope, and the kink that interpolation leaves at an edge; a jump stays
however close one looks. So (10 d(s) - d(10 s)) / 9 is the jump J but for 10 b s^2 and noise. With s = 0.001 the former is below 1e-4 of
the mean for b up to 10. 256 pixels of 16 samples each, independent within a half, leave a standard deviation of
2 a s sqrt(1/12 / 2048) = 1.3e-5 a of the mean per d(s), and as much per d(10 s) / 9: 2e-4 is above both for a of a few. Highlights here
are wider than a third of an edge, which is what keeps a and b there. A texture turned by a right angle at the seam must show there, by far.
"""
import json
import pathlib
import sys
import tempfile
import unittest

import numpy as np

import exr
from command import microfacet, musurf

AROUND, UP, NEAR, FAR = 14, 9, 0.001, 0.01
BOUND = 2e-4


def place(u, v, twist=0.0):
    """A tube of radius 1 along a quarter of a circle of radius 3."""
    around, along = -2 * np.pi * u + twist * v, np.pi / 2 * v  # u x v points outward
    r = 3 + np.cos(around)
    return np.stack([r * np.cos(along), r * np.sin(along), np.sin(around)], -1)



def tube():
    """Shaken parameters of the vertices, the last column being the first, and the triangles, cut either way."""
    random = np.random.default_rng(3)
    v, u = np.meshgrid(np.arange(UP + 1) / UP, np.arange(AROUND + 1) / AROUND, indexing="ij")
    u, v = u + random.uniform(-0.2, 0.2, u.shape) / AROUND, v + random.uniform(-0.2, 0.2, u.shape) / UP
    u[:, -1], v[:, -1] = u[:, 0] + 1, v[:, 0]
    faces = []
    for j in range(UP):
        for i in range(AROUND):
            a, b, c, d = (k + j * (AROUND + 1) + i for k in (0, 1, AROUND + 1, AROUND + 2))
            faces += [(a, b, d), (a, d, c)] if random.random() < 0.5 else [(a, b, c), (b, d, c)]
    return u.ravel(), v.ravel(), faces


U, V, FACES = tube()


def vertex(k):
    return k - AROUND if k % (AROUND + 1) == AROUND else k


def obj(positions, turned=False):
    """`turned`: the half of the tube behind the seam has a texture turned by a right angle."""
    lines = ["v %r %r %r" % tuple(p) for p in positions.tolist()]
    lines += [f"vt {float(u)!r} {float(v)!r}" for u, v in zip(U, V)] + [f"vt {float(v)!r} {float(-u)!r}" for u, v in zip(U, V)]
    for face in FACES:
        shift = len(U) if turned and min(k % (AROUND + 1) for k in face) >= AROUND // 2 else 0
        lines.append("f " + " ".join(f"{vertex(k) + 1}/{k + 1 + shift}" for k in face))
    return "\n".join(lines) + "\n"


def edges():
    """Some of each kind: (ends, whether it is on the seam), not at the tube's ends."""
    found = set()
    for face in FACES:
        for k in range(3):
            a, b = sorted((face[k], face[(k + 1) % 3]))
            rows = a // (AROUND + 1), b // (AROUND + 1)
            if not (rows[0] == rows[1] and rows[0] in (0, UP)) and a % (AROUND + 1) < AROUND:
                found.add((a, b))
    found = sorted(found)
    seam = [e for e in found if all(k % (AROUND + 1) == 0 for k in e)]
    others = [e for e in found if not any(k % (AROUND + 1) == 0 for k in e)]
    random = np.random.default_rng(4)
    return [seam[i] for i in random.permutation(len(seam))[:5]], [others[i] for i in random.permutation(len(others))[:12]]


SEAM, INSIDE = edges()
ANISOTROPIC = microfacet(alpha_x=0.5, alpha_y=0.15, rotation=0.5)


class Frames(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = pathlib.Path(temporary.name)
        for name, text in (("tube.obj", obj(place(U, V))), ("turned.obj", obj(place(U, V), turned=True)),
                           ("twisted.obj", obj(place(U, V, 1.5) * [1.4, 1, 1]))):
            (cls.folder / name).write_text(text)

    def halves(self, item, mesh, camera, light):
        scene = {"camera": camera, "film": {"width": 16, "height": 16, "pixels": "float"}, "integrator": {"samples": 16, "depth": 1},
                 "meshes": {"m": {"file": mesh}}, "objects": [dict(item, mesh="m", two_sided=True)],
                 "lights": [{"type": "directional", "direction": list(light)}]}
        (self.folder / "scene.json").write_text(json.dumps(scene))
        done = musurf("render", self.folder / "scene.json", "-o", self.folder / "out.exr", "--quiet", "--threads", 1)
        self.assertEqual((done.returncode, done.err), (0, ""))
        picture = np.asarray(exr.read(self.folder / "out.exr")[1]["G"], float)
        return picture[:, :8].mean(), picture[:, 8:].mean()

    def jump(self, item, mesh, positions, edge):
        """J across the edge, as a share of the mean."""
        a, b = positions[vertex(edge[0])], positions[vertex(edge[1])]
        along, middle = b - a, 0.6 * a + 0.4 * b
        u, v = 0.6 * U[edge[0]] + 0.4 * U[edge[1]], 0.6 * V[edge[0]] + 0.4 * V[edge[1]]
        step = 1e-4
        out = np.cross(self.shape(u + step, v) - self.shape(u, v), self.shape(u, v + step) - self.shape(u, v))
        n = out / np.linalg.norm(out)
        view = n + 0.35 * np.array([0.3, -0.8, 0.5])
        view /= np.linalg.norm(view)
        light = 2 * (n @ view) * n - view + 0.3 * n + [0.15, 0.1, -0.1]
        differences = []
        for share in (NEAR, FAR):
            camera = {"type": "orthographic", "position": (middle + view).tolist(), "target": middle.tolist(),
                      "up": along.tolist(), "height": share * np.linalg.norm(along)}
            left, right = self.halves(item, mesh, camera, light)
            self.assertGreater(left + right, 0)
            differences.append(2 * (right - left) / (left + right))
        return (10 * differences[0] - differences[1]) / 9

    def worst(self, edges, item, mesh, positions, shape=place):
        self.shape = shape
        return max(abs(self.jump(item, mesh, positions, edge)) for edge in edges)

    def test_edges_and_seams(self):
        item = {"material": ANISOTROPIC}
        inside = self.worst(INSIDE, item, "tube.obj", place(U, V))
        seam = self.worst(SEAM, item, "tube.obj", place(U, V))
        print(f"tube: jumps across edges {inside:.1e}, the seam {seam:.1e} of the mean")
        self.assertLess(inside, BOUND)
        self.assertLess(seam, BOUND)

    def test_tension(self):
        """The same of a tube that was twisted and stretched."""
        def shape(u, v):
            return place(u, v, 1.5) * [1.4, 1, 1]
        item = {"material": microfacet(alpha=0.25), "tension": {"rest": "tube.obj"}}
        inside = self.worst(INSIDE, item, "twisted.obj", shape(U, V), shape)
        seam = self.worst(SEAM, item, "twisted.obj", shape(U, V), shape)
        print(f"twisted tube: jumps across edges {inside:.1e}, the seam {seam:.1e} of the mean")
        self.assertLess(inside, BOUND)
        self.assertLess(seam, BOUND)

    def test_a_turned_texture_shows(self):
        seam = self.worst(SEAM, {"material": ANISOTROPIC}, "turned.obj", place(U, V))
        print(f"texture turned at the seam: jumps {seam:.1e} of the mean")
        self.assertGreater(seam, 250 * BOUND)


if __name__ == "__main__":
    sys.exit(unittest.main())
