#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""One scene by two renderers, `musurf render` and Mitsuba, through the same shared object and the same material files: per pixel they
differ by noise alone, and to the eye not at all (FLIP below 0.02 at the same exposure). FULL=1: larger, and with less noise."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import mitsuba_host

mitsuba_host.need()
import exr  # noqa: E402
import numpy as np  # noqa: E402
import pixel_test  # noqa: E402
from command import musurf  # noqa: E402
from picture_flip import flip  # noqa: E402

FULL = bool(os.environ.get("FULL"))
SIZE, SAMPLES, COUNT = ("96x72", 512, 8) if FULL else ("32x24", 256, 8)
SCENE = mitsuba_host.ROOT / "scenes/hosts.json"


def ours(scene, folder):
    pictures = []
    for i in range(COUNT):
        out = pathlib.Path(folder, "out.exr")
        done = musurf("render", scene, "-o", out, "--size", SIZE, "--spp", SAMPLES, "--seed", 300 + i, "--progress", "none")
        assert done.returncode == 0, done.err
        channels = exr.read(out)[1]
        pictures.append(np.stack([channels[c] for c in "RGB"], axis=-1).astype(float))
    return np.stack(pictures)


def theirs(scene, folder):
    out = pathlib.Path(folder, "out.npy")
    subprocess.run([mitsuba_host.PYTHON, mitsuba_host.ROOT / "tests/mitsuba_scene.py", scene, out, SIZE, str(SAMPLES), str(COUNT), "500"],
                   env=mitsuba_host.environment(), check=True)
    return np.load(out).astype(float)


class Render(unittest.TestCase):
    def test_the_same_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            a, b = ours(SCENE, folder), theirs(SCENE, folder)
            found, bound = pixel_test.judge(a, b)
            seen = flip(a.mean(axis=0), b.mean(axis=0))
            print(f"{SIZE}, {COUNT} times {SAMPLES} samples: mean |t| {found:.3f}, at most {bound:.3f}; FLIP {seen:.4f}")
            np.savez(mitsuba_host.BUILD / "mitsuba-render.npz", ours=a.mean(axis=0), theirs=b.mean(axis=0), t=pixel_test.t_of(a, b))
            self.assertLess(found, bound)
            self.assertLess(seen, 0.02)

            # and it can fail: the plate skewed the other way
            other = pathlib.Path(folder, "materials")
            other.mkdir()
            for file in (mitsuba_host.ROOT / "scenes/materials").glob("*.json"):
                material = json.loads(file.read_text())
                if file.stem == "brushed":
                    material["transform"] = [[1, -2], [0, 1]]
                (other / file.name).write_text(json.dumps(material))
            changed = pathlib.Path(folder, "hosts.json")
            changed.write_text(SCENE.read_text())
            found, bound = pixel_test.judge(ours(changed, folder), b)
            self.assertGreater(found, 1.5 * bound)


if __name__ == "__main__":
    sys.exit(unittest.main())
