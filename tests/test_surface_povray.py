#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf surface measure --tracer povray`: the same bits from another program, and what happens when it fails.

POV-Ray is given vertices that M has moved. Of the facets of all maps and views together at most 1e-4 may be seen otherwise
than by the exact caster on the untransformed surface (a float vertex is off by up to 2^-25 of a patch's extent, and shadows
have borders); so many of one view's few thousand facets is none, so one is granted to each.
"""
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
import time
import unittest

import numpy as np

from command import MUSURF, musurf, strict
from test_surface_command import MAPS, VIEWS, heightfield, maps, numbers, write_exr


class Folder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.place = self.folder / "place"  # where POV-Ray's folders come and go
        self.place.mkdir()
        self.file = self.folder / "h.exr"

    def write(self, shape, alpha=0.5):
        h = heightfield.make(max(shape), alpha, 5.0, 7)[:shape[0], :shape[1]]
        write_exr(self.file, h)

    def measure(self, views, m, tracer, *more, **env):
        done = musurf("surface", "measure", self.file, f"--transform={numbers(m)}", "--tracer", tracer, "--bits",
                      self.folder / "b.npy", *[f"--view={numbers(maps.carried(m, v))}" for v in views], *more,
                      env={"TMPDIR": str(self.place), **env})
        self.assertEqual((done.returncode, done.err), (0, ""))
        self.assertEqual(os.listdir(self.place), [])
        return strict(done.out), np.load(self.folder / "b.npy")


@unittest.skipUnless(shutil.which("povray"), "POV-Ray is not installed")
class Traced(Folder):
    def compare(self, views, chosen, *more):
        exact, bits = self.measure(views, np.eye(2), "own", *more)
        different = every = 0
        for name, m in chosen.items():
            with self.subTest(map=name):
                answer, seen = self.measure(views, m, "povray", *more)
                self.assertRegex(answer["tracer"], r"^POV-Ray \d")
                wrong = (seen != bits).reshape(len(views), -1).sum(1)
                self.assertLessEqual(wrong.max(), 1)
                different, every = different + wrong.sum(), every + bits.size
                for a, b in zip(exact["views"], answer["views"]):
                    self.assertAlmostEqual(a["G1_projected"], b["G1_projected"], delta=1e-4)
        self.assertLessEqual(different, 1 + 1e-4 * every)

    def test_bits_under_all_maps(self):
        self.write((64, 64))
        self.compare(VIEWS, {"identity": np.eye(2), **MAPS, "small": 1e-3 * maps.rotation(0.4), "large": 500 * np.eye(2)})

    def test_many_views_of_a_rectangle(self):
        """Two images of views, of patches that are not whole; 16 points have no middle one, which is another image."""
        self.write((70, 40))
        self.compare([*VIEWS, maps.direction(0, 0), maps.direction(80, 10)], {"skew": MAPS["skew"]}, "--subsamples=16")

    def test_wrong_direction_is_noticed(self):
        self.write((64, 64))
        exact, _ = self.measure(VIEWS[:1], np.eye(2), "own")
        turned, _ = self.measure([maps.direction(60, 110)], np.eye(2), "povray")
        self.assertGreater(abs(exact["views"][0]["visible"] - turned["views"][0]["visible"]), 30)


class Failing(Folder):
    """Programs that are called povray and are not."""

    def setUp(self):
        super().setUp()
        self.write((16, 16))

    def fake(self, body):
        program = self.folder / "fake"
        program.write_text('#!/bin/sh\n[ "$1" = --version ] && { echo "POV-Ray 9.9" >&2; exit 0; }\n' + body)
        program.chmod(0o755)
        return {"POVRAY": str(program), "TMPDIR": str(self.place)}

    def refused(self, words, env):
        done = musurf("surface", "measure", self.file, "--view=1,0,1", "--tracer=povray", env=env)
        self.assertEqual((done.returncode, done.out), (2, ""))
        self.assertRegex(done.err, r"^musurf surface measure: [^\n]*\n$")
        self.assertIn(words, done.err)
        self.assertEqual(os.listdir(self.place), [])

    def test_failures_are_explained(self):
        self.refused("POV-Ray cannot be started", {"POVRAY": "/nonexistent/povray", "TMPDIR": str(self.place)})
        self.refused("no temporary folder", {"POVRAY": "true", "TMPDIR": "/nonexistent"})
        self.refused("does not say that it is POV-Ray", {"POVRAY": "true", "TMPDIR": str(self.place)})
        self.refused("Parse Error: no such thing",
                     self.fake("echo; echo 'File: scene.pov  Line: 3'; echo 'Parse Error: no such thing' >&2; exit 1"))
        self.refused("ended by signal 9", self.fake("kill -9 $$"))
        self.refused("wrote no image of 96 x 48", self.fake("true"))
        self.refused("wrote no image of 96 x 48", self.fake("printf 'P6\\n1 1\\n255\\nabc' > image.ppm"))
        self.refused("truncated", self.fake("printf 'P6\\n# by POV\\n96 48\\n255\\nabc' > image.ppm"))
        self.refused("between dark and lit",
                     self.fake("{ printf 'P6\\n96 48\\n255\\n'; head -c 13824 /dev/zero | tr '\\0' 7; } > image.ppm"))

    def test_signals_clean_up(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            env = dict(os.environ, **self.fake("echo $$ > ../../pid; exec sleep 60"))
            process = subprocess.Popen([MUSURF, "surface", "measure", self.file, "--view=1,0,1", "--tracer=povray"], env=env,
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            pid = self.folder / "pid"
            for _ in range(600):
                if pid.exists() and pid.read_text().strip():
                    break
                time.sleep(0.05)
            process.send_signal(number)
            out, err = process.communicate(timeout=30)
            self.assertEqual((process.returncode, out, err), (130, b"", b""))
            self.assertEqual(os.listdir(self.place), [])
            with self.assertRaises(ProcessLookupError):
                os.kill(int(pid.read_text()), 0)
            pid.unlink()


if __name__ == "__main__":
    unittest.main()
