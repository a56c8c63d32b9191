#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""plugin/README.md keeps its word: its host is compiled as printed, against a staged installation alone (make install DESTDIR=), and says what
`musurf eval` says; its recipe for another plugin makes one that the installed renderer shades with."""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import exr

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = os.environ.get("BUILD", "build")
SANITIZE = os.environ.get("SANITIZE", "").split()
README = (ROOT / "plugin/README.md").read_text()


def blocks(language):
    return re.findall(rf"^```{language}\n(.*?)^```$", README, re.M | re.S)


def run(*command, **more):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, **more)


class Readme(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.stage = pathlib.Path(cls.folder.name, "stage")
        cls.work = pathlib.Path(cls.folder.name, "work")
        cls.work.mkdir()
        done = run("make", "install", f"BUILD={BUILD}", f"DESTDIR={cls.stage}", "PREFIX=/opt/musurf", cwd=ROOT)
        assert done.returncode == 0, done.stdout + done.stderr
        # pkg-config puts the stage before the paths that compilers see
        cls.env = dict(os.environ, PKG_CONFIG_PATH=f"{cls.stage}/opt/musurf/lib/pkgconfig", PKG_CONFIG_SYSROOT_DIR=str(cls.stage))
        cls.env.pop("MUSURF_PLUGIN_PATH", None)
        cls.plugins = cls.stage / "opt/musurf/lib/musurf"
        cls.musurf = cls.stage / "opt/musurf/bin/musurf"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def succeeds(self, *command, **more):
        done = run(*command, cwd=self.work, env=dict(self.env, **more.pop("env", {})), **more)
        self.assertEqual(done.returncode, 0, f"{command}: {done.stdout}{done.stderr}")
        return done.stdout

    def flags(self):
        return self.succeeds("pkg-config", "--cflags", "musurf").split()

    def test_the_host_as_printed(self):
        text, _ = blocks("c")
        self.assertLessEqual(len(text.splitlines()), 40)
        (self.work / "host.c").write_text(text)
        self.succeeds("cc", "-std=c17", "-Wall", "-Wextra", "-Werror", *SANITIZE, "host.c", *self.flags(), "-ldl", "-o", "host")
        said = self.succeeds("./host", self.plugins / "musurf_material.so", env={"ASAN_OPTIONS": "detect_leaks=0"})
        match = re.fullmatch(r"(.*): f cos ([\d.]+), pdf ([\d.]+)\n", said)
        self.assertTrue(match, said)
        line = {"material": {"material": "musurf.microfacet", "alpha": 0.3, "transform": [[1, 2], [0, 1]]}, "wo": [0.6, 0, 0.8], "wi": [-0.48, 0.36, 0.8]}
        answer = json.loads(self.succeeds(self.musurf, "eval", input=json.dumps(line)))
        self.assertAlmostEqual(float(match[2]), answer["f"][0] * 0.8, delta=2e-6)
        self.assertAlmostEqual(float(match[3]), answer["pdf"], delta=2e-6)
        missing = run("./host", self.plugins / "no.so", cwd=self.work)
        self.assertEqual((missing.returncode, missing.stderr.count("\n")), (2, 1))
        self.assertIn("no.so", missing.stderr)

    @unittest.skipIf(SANITIZE, "a sanitized library needs its runtime in the program")
    def test_the_renderer_as_a_library(self):
        """Nothing is told of where plugins are: they are beside the library."""
        _, text = blocks("c")
        (self.work / "ball.c").write_text(text)
        commands = next(block for block in blocks("sh") if "ball.c" in block)
        said = self.succeeds("sh", "-c", commands)
        match = re.fullmatch(r"([\d.]+) ([\d.]+) ([\d.]+), coverage 1\n", said)
        self.assertTrue(match, said)
        scene = json.loads(re.search(r"scene\[\] = (.*?);", text, re.S)[1].replace('"\n', "").replace('\\"', "\0").replace('"', "").replace("\0", '"'))
        (self.work / "ball.json").write_text(json.dumps(scene))
        self.succeeds(self.musurf, "render", "ball.json", "-o", "ball.exr", "--progress", "none")
        middle = [exr.read(self.work / "ball.exr")[1][c][24, 32] for c in "RGB"]
        for found, wanted in zip(match.groups(), middle):
            self.assertAlmostEqual(float(found), float(wanted), delta=1e-3 * float(wanted))  # halves, of 11 bits

    def test_another_plugin_as_told(self):
        commands = [block for block in blocks("sh") if "export.map" in block]
        self.assertEqual(len(commands), 1)
        text = (ROOT / "plugin/template.c").read_text()
        for old, new in (('#include "plugin/musurf_plugin.h"', "#include <musurf/musurf_plugin.h>"), ('.id = "template.lambert"', '.id = "acme.lambert"')):
            self.assertEqual(text.count(old), 1)
            text = text.replace(old, new)
        (self.work / "template.c").write_text(text)
        lines = commands[0].splitlines()
        for line in lines[:2]:
            self.succeeds("sh", "-c", line.replace(" -shared ", f" -shared {' '.join(SANITIZE)} "))
        answer = json.loads(self.succeeds("sh", "-c", f"MUSURF_PLUGIN_PATH=. {self.musurf} info --json"))
        self.assertTrue(answer)
        scene = {"musurf": 1, "film": {"width": 4, "height": 4}, "integrator": {"samples": 4, "depth": 1},
                 "objects": [{"shape": "rectangle", "size": [99, 99], "material": {"material": "acme.lambert", "reflectance": 0.5}}],
                 "camera": {"position": [0, 0, 2], "target": [0, 0, 0], "up": [0, 1, 0]}, "lights": [{"type": "constant", "radiance": 1}]}
        (self.work / "scene.json").write_text(json.dumps(scene))
        self.assertTrue(lines[2].startswith("MUSURF_PLUGIN_PATH=. musurf render scene.json -o scene.exr"))
        self.succeeds("sh", "-c", lines[2].split("#")[0].replace(" musurf ", f" {self.musurf} "))
        self.assertTrue((self.work / "scene.exr").exists())

    def test_links_and_tests_exist(self):
        for target in re.findall(r"\]\(([^)#:]+)\)", README):
            self.assertTrue((ROOT / "plugin" / target).exists(), target)
        for test in re.findall(r"`(tests/\S+?)`", README):
            self.assertTrue((ROOT / test).exists(), test)


if __name__ == "__main__":
    sys.exit(unittest.main())
