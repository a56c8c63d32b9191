#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Material files travel: the files of scenes/materials, each used as it is by `musurf render`, by Mitsuba and by Blender, give the same picture. The three
are compared with each other: per pixel they differ by noise alone (pixel_test.py), and to the eye not at all (FLIP below 0.02). All three
are needed; FULL=1 (make test-mitsuba, make test-blender, which run it, too): larger, and with less noise."""
import itertools
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import blender_host
import mitsuba_host

mitsuba_host.need()
HOSTS = blender_host.need()
import exr  # noqa: E402
import numpy as np  # noqa: E402
import pixel_test  # noqa: E402
import three_hosts  # noqa: E402
from command import musurf  # noqa: E402
from picture_flip import flip  # noqa: E402

SIZE, SAMPLES, COUNT = ((64, 48), 192, 8) if os.environ.get("FULL") else ((32, 24), 192, 8)
MATERIALS = blender_host.ROOT / "scenes/materials"


def standalone(job):
    file, out = three_hosts.scene_file(job), job["out"] + ".exr"
    found = []
    for seed in job["seeds"]:
        done = musurf("render", file, "-o", out, "--seed", seed, "--progress", "none", "--threads", 2)
        assert done.returncode == 0 and "warning" not in done.err, done.err
        channels = exr.read(pathlib.Path(out))[1]
        found.append(np.stack([channels[c] for c in "RGB"], axis=-1))
    return np.stack(found)


def mitsuba(job):
    subprocess.run([mitsuba_host.PYTHON, mitsuba_host.ROOT / "tests/three_hosts.py", json.dumps(job)], env=mitsuba_host.environment(), check=True)
    return np.load(job["out"])


class ThreeHosts(blender_host.Installed):
    def inside(self, host):
        def blender(job):
            log = blender_host.do(host, self.scripts, {**job, "do": "three_hosts.blender"})
            self.assertNotIn("Warning: musurf", log)
            return np.load(job["out"])
        return blender

    def pictures(self, render, seed, materials=MATERIALS):
        with tempfile.TemporaryDirectory() as folder:
            job = {"folder": folder, "out": str(pathlib.Path(folder, "out.npy")), "materials": str(materials), "size": SIZE, "samples": SAMPLES,
                   "seeds": list(range(seed, seed + COUNT))}
            return render(job).astype(float)

    def test_the_same_picture(self):
        found = {"musurf render": self.pictures(standalone, 300), "Mitsuba": self.pictures(mitsuba, 500)}
        found |= {host[0]: self.pictures(self.inside(host), 700 + 100 * i) for i, host in enumerate(HOSTS)}
        np.savez(mitsuba_host.BUILD / "three-hosts.npz", **{name: x.mean(axis=0) for name, x in found.items()})
        for a, b in itertools.combinations(found, 2):
            mean, bound = pixel_test.judge(found[a], found[b])
            seen = flip(found[a].mean(axis=0), found[b].mean(axis=0))
            print(f"{a}, {b}: {SIZE}, {COUNT} times {SAMPLES} samples: mean |t| {mean:.3f}, at most {bound:.3f}; FLIP {seen:.4f}")
            self.assertLess(mean, bound, (a, b))
            self.assertLess(seen, 0.02, (a, b))

        # and it can fail, in each: one file changed (the floor skewed the other way, gold's tail shorter, glass rougher)
        other = pathlib.Path(self.folder.name, "materials")
        for render, file, change in ((standalone, "brushed", {"transform": [[1, -2], [0, 1]]}), (mitsuba, "gold", {"gamma": 2.5}),
                                     (self.inside(HOSTS[0]), "frosted", {"alpha_x": 0.6})):
            shutil.rmtree(other, ignore_errors=True)
            shutil.copytree(MATERIALS, other)
            (other / f"{file}.json").write_text(json.dumps({**json.loads((MATERIALS / f"{file}.json").read_text()), **change}))
            changed = self.pictures(render, 1100, other)
            for name in found:
                mean, bound = pixel_test.judge(changed, found[name])
                self.assertGreater(mean, 1.2 * bound, (file, name))


if __name__ == "__main__":
    sys.exit(unittest.main())
