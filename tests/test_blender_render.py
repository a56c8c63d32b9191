#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The render engine inside Blender. Two plates, one of which a shape key stretches while its microsurface follows, lit by a rectangle, a sun and the
world: the same picture as that of a scene file written by hand, in which the stretch is a transform, by `musurf render`: per pixel they
differ by noise alone, and to the eye not at all (FLIP below 0.02). And its own scene file, kept, gives the same pixels there bit by bit."""
import json
import math
import pathlib
import shutil
import sys
import unittest

import blender_host

HOSTS = blender_host.need()
import exr  # noqa: E402
import numpy as np  # noqa: E402
import pixel_test  # noqa: E402
from command import musurf  # noqa: E402
from picture_flip import flip  # noqa: E402

SIZE, SAMPLES, COUNT = ((96, 72), 256, 8) if blender_host.FULL else ((32, 24), 128, 8)


def pose(matrix, x):
    """Rotation about x by degrees, then a translation, as rows."""
    c, s = math.cos(math.radians(x)), math.sin(math.radians(x))
    return [[1, 0, 0, matrix[0]], [0, c, -s, matrix[1]], [0, s, c, matrix[2]]]


def by_hand(area):
    """blender_scene.py as a scene file. An area light of P watts shines with P / (area A) along its -z."""
    gloss = {"material": "musurf.microfacet", "ndf": "gtr", "alpha": 0.3, "gamma": 1.5}
    c40, s40, c15, s15 = (f(math.radians(a)) for a in (40, 15) for f in (math.cos, math.sin))
    radiance = 90 / (area * 1.5)
    return {
        "musurf": 1,
        "camera": {"type": "perspective", "position": [0, -4.2, 2.2], "up": [0, 0, 1],
                   "target": [0, -4.2 + math.sin(math.radians(65)), 2.2 - math.cos(math.radians(65))],
                   "fov": math.degrees(2 * math.atan(math.tan(math.radians(20)) * SIZE[1] / SIZE[0]))},
        "film": {"width": SIZE[0], "height": SIZE[1], "filter": "box", "pixels": "float"},
        "integrator": {"samples": SAMPLES, "depth": 4, "roulette": 100},
        "objects": [{"shape": "rectangle", "size": [4, 3], "material": {**gloss, "transform": [[1, 0.6], [-0.3, 1.4]]}, "two_sided": True},
                    {"shape": "rectangle", "size": [2, 2], "material": {**gloss, "transform": [[2, 0], [0, 1]]}, "two_sided": True,
                     "transform": pose((0.2, 1, 1), 50)}],
        "lights": [{"type": "rectangle", "size": [1.5, 1], "radiance": [radiance, radiance * 0.9, radiance * 0.8],
                    "transform": pose((0.3, 1.2, 2.5), 155)},
                   {"type": "directional", "direction": [s15 * c40, -s40, c15 * c40], "irradiance": [0.4] * 3},
                   {"type": "constant", "radiance": [0.15, 0.2, 0.25]}]}


def standalone(scene, out, seed):
    done = musurf("render", scene, "-o", out, "--seed", seed, "--progress", "none", "--threads", 2)
    assert done.returncode == 0, done.err
    channels = exr.read(out)[1]
    return np.stack([channels[c] for c in "RGB"], axis=-1)


class Render(blender_host.Installed):
    def inside(self, host, **task):
        out = pathlib.Path(self.folder.name, "out.npy")
        log = blender_host.do(host, self.scripts, {"do": "render", "size": SIZE, "samples": SAMPLES, "out": str(out), **task})
        return np.load(out), log

    def test_the_same_picture(self):
        file, out = pathlib.Path(self.folder.name, "hand.json"), pathlib.Path(self.folder.name, "hand.exr")
        for host in HOSTS:
            found, log = self.inside(host, seeds=list(range(COUNT)), keep=True)
            version = next(line.split()[-1] for line in log.splitlines() if line.startswith("TEST Blender"))
            file.write_text(json.dumps(by_hand(math.pi if version >= "4" else 4)))  # test_blender_cycles.py has it from Cycles
            hand = np.stack([standalone(file, out, 300 + i) for i in range(COUNT)]).astype(float)
            self.assertNotIn("Warning: musurf", log)
            kept = sorted({line.split()[-1] for line in log.splitlines() if "the scene is in" in line})
            self.assertEqual(len(kept), COUNT)
            mean, bound = pixel_test.judge(found.astype(float), hand)
            seen = flip(found.mean(axis=0), hand.mean(axis=0))
            print(f"{host[0]}: {SIZE}, {COUNT} times {SAMPLES} samples: mean |t| {mean:.3f}, at most {bound:.3f}; FLIP {seen:.4f}")
            self.assertLess(mean, bound)
            self.assertLess(seen, 0.02)

            seeds = [json.loads(pathlib.Path(path, "scene.json").read_text())["integrator"]["seed"] for path in kept]
            own = standalone(pathlib.Path(kept[0], "scene.json"), out, seeds[0])
            self.assertTrue(np.array_equal(own, found[seeds[0]]))

            # and it can fail: the material of a plate that does not stretch
            for path in kept:
                shutil.rmtree(path)
            other, _ = self.inside(host, seeds=list(range(COUNT)), tension=False)
            mean, bound = pixel_test.judge(other.astype(float), hand)
            self.assertGreater(mean, 1.2 * bound)

    def test_a_region_is_a_part(self):
        for host in HOSTS:
            whole = self.inside(host, seeds=[1], size=(16, 12), samples=4)[0][0]
            for crop in (False, True):
                part = self.inside(host, seeds=[1], size=(16, 12), samples=4, region=(0.25, 0.75, 0.5, 1.0), crop=crop)[0][0]
                self.assertEqual(part.shape[:2], (6, 8) if crop else (12, 16))
                self.assertTrue(np.array_equal(part if crop else part[:6, 4:12], whole[:6, 4:12]))


if __name__ == "__main__":
    sys.exit(unittest.main())
