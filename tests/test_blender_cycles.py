#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""GGX under M has an equal in Cycles: the add-on writes it as nodes, and Cycles, a renderer with a code of its own, makes the same picture of one
and the same scene in Blender: camera, area light, sun, world and its picture, skew, and the tension of a plate, given to Cycles as its map. Direct light:
per pixel they differ by noise alone, and to the eye not at all (FLIP below 0.02).

Lamps are solid here, and Cycles adds what is behind them, so each kind of light has a render of its own. Points and spots have no radius. Blender 3.4's
Cycles darkens spots by the cosine of the angle to their middle, which later ones do not: they are compared in those. Cycles' masking is separable before Blender
3.5 and height-correlated since."""
import math
import pathlib
import sys
import unittest

import blender_host

HOSTS = blender_host.need()
import numpy as np  # noqa: E402
import pixel_test  # noqa: E402
from picture_flip import flip  # noqa: E402

SIZE, SAMPLES, COUNT = ((64, 48), 256, 8) if blender_host.FULL else ((32, 24), 96, 8)
MAP = (2.0, 0.0, 0.0, 1.0)


class Cycles(blender_host.Installed):
    def inside(self, host, **task):
        out = pathlib.Path(self.folder.name, "out.npy")
        log = blender_host.do(host, self.scripts, {"do": "render", "size": SIZE, "samples": SAMPLES, "out": str(out), "ndf": "ggx", "depth": 1,
                                                   "seeds": list(range(COUNT)), **task})
        version = next(line.split()[-1] for line in log.splitlines() if line.startswith("TEST Blender"))
        return np.load(out).astype(float), tuple(map(int, version.split(".")))

    def test_the_same_picture(self):
        for host in HOSTS:
            for lights in (["area"], ["sun", "world"], ["point"], ["spot"], ["picture"]):
                if lights == ["spot"] and version < (4, 0, 0):
                    continue
                theirs, version = self.inside(host, engine="CYCLES", map=MAP, lights=lights)
                masking = "separable" if version < (3, 5, 0) else "height_correlated"
                ours, _ = self.inside(host, masking=masking, lights=lights)
                mean, bound = pixel_test.judge(ours, theirs)
                seen = flip(ours.mean(axis=0), theirs.mean(axis=0))
                print(f"{host[0]}, {' and '.join(lights)}: {SIZE}, {COUNT} times {SAMPLES} samples: mean |t| {mean:.3f}, at most {bound:.3f}; FLIP {seen:.4f}")
                self.assertLess(mean, bound)
                self.assertLess(seen, 0.02)
            # and it can fail: the plate stretched the other way
            theirs, _ = self.inside(host, engine="CYCLES", map=(1.0, 0.0, 0.0, 2.0), lights=["sun", "world"])
            mean, bound = pixel_test.judge(ours, theirs)
            self.assertGreater(mean, 1.2 * bound)


class Parameters(unittest.TestCase):
    def test_axes_are_those_of_the_slopes(self):
        """(alpha_x, alpha_y, rotation) of the nodes, put together again, is the covariance of slopes that M makes."""
        cycles = load("cycles")
        rng = np.random.default_rng(5)
        for _ in range(200):
            m, alpha = rng.normal(size=(2, 2)), rng.uniform(0.05, 0.8)
            try:
                roughness, a, turns = cycles.parameters(alpha, m)
            except cycles.NotThere:
                self.assertGreater(np.linalg.cond(m), 1 / (1 - cycles.MOST) ** 2 * (1 - 1e-9))
                continue
            x, y = roughness ** 2 * (1 - a), roughness ** 2 / (1 - a)
            c, s = math.cos(2 * math.pi * turns), math.sin(2 * math.pi * turns)
            turn = np.array([[c, -s], [s, c]])
            made, wanted = turn @ np.diag([x * x, y * y]) @ turn.T, alpha ** 2 * np.linalg.inv(m @ m.T)
            self.assertLess(np.abs(made - wanted).max() / np.abs(wanted).max(), 1e-9)


def load(name):
    """A module of the add-on that needs no Blender, without its package's others."""
    import importlib.util
    import types
    package = types.ModuleType("musurf_blender")
    package.__path__ = [str(blender_host.ROOT / "plugin/blender/musurf_blender")]
    sys.modules.setdefault("musurf_blender", package)
    sys.modules.setdefault("musurf_blender.material", types.ModuleType("musurf_blender.material"))
    sys.modules["musurf_blender"].material = sys.modules["musurf_blender.material"]
    return importlib.import_module("musurf_blender." + name)


if __name__ == "__main__":
    sys.exit(unittest.main())
