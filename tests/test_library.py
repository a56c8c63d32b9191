#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""libmusurf_render.so as hosts load it, through the Blender add-on's ctypes, which needs no Blender: its records are the header's, its pixels those of
`musurf render` bit by bit, it can be watched and stopped, an older host's shorter request serves, and what is refused is said."""
import ctypes
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import exr
import numpy as np
from command import BUILD, ROOT, musurf

LEFT_OUT = 77
if BUILD.name in ("asan", "ubsan", "tsan"):
    print("a sanitized shared object cannot be loaded into Python")
    sys.exit(LEFT_OUT)
os.environ["MUSURF_PLUGIN_PATH"] = str(BUILD)
spec = importlib.util.spec_from_file_location("library", ROOT / "plugin/blender/musurf_blender/library.py")
library = importlib.util.module_from_spec(spec)
spec.loader.exec_module(library)

WIDTH, HEIGHT, SAMPLES = 24, 16, 16
SCENE = {"musurf": 1, "film": {"width": WIDTH, "height": HEIGHT, "filter": "box", "pixels": "float"}, "integrator": {"samples": SAMPLES, "seed": 7},
         "objects": [{"shape": "sphere", "material": {"material": "musurf.microfacet", "alpha": 0.3, "transform": [[1, 2], [0, 1]]}}]}


class Watch:
    def __init__(self, enough=1 << 30):
        self.enough, self.fractions, self.pictures, self.said = enough, [], 0, []

    def stop(self):
        return min(len(self.fractions), self.pictures) >= self.enough

    def progress(self, fraction, remaining, samples):
        self.fractions.append(fraction)

    def picture(self):
        self.pictures += 1

    def message(self, severity, text):
        self.said.append((severity, text))


def buffers(count=WIDTH * HEIGHT):
    return tuple(np.full((count, channels), -1, dtype=np.float32) for channels in (4, 3, 3))


class Library(unittest.TestCase):
    def render(self, scene=SCENE, watch=None, into=None, **more):
        into, watch = into or buffers(), watch or Watch()
        return library.render(json.dumps(scene), "scene.json", into, watch, threads=2, **more), into, watch

    def test_records_are_the_header_s(self):
        fields = [field[0] for field in library.Request._fields_]
        prints = "".join(f'printf("%zu %zu\\n", offsetof(musurf_render_request, {f}), sizeof((musurf_render_request *)0)->{f});\n' for f in fields)
        prints = prints.replace("sizeof((musurf_render_request *)0)->", "sizeof ((musurf_render_request *)0)->")
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder, "offsets.c")
            source.write_text('#include "core/render/musurf_render.h"\n#include <stdio.h>\nint main(void) {\n' + prints
                              + 'printf("%zu %d\\n", sizeof(musurf_render_request), MUSURF_RENDER_MAJOR); return 0; }\n')
            for compiler in (["cc", "-std=c99", "-pedantic", "-Werror"], ["c++", "-std=c++11", "-x", "c++", "-pedantic", "-Werror"]):
                subprocess.run([*compiler, f"-I{ROOT}", source, "-o", source.with_suffix("")], check=True)
                lines = subprocess.run([source.with_suffix("")], capture_output=True, text=True, check=True).stdout.splitlines()
                wanted = [f"{getattr(library.Request, f).offset} {getattr(library.Request, f).size}" for f in fields]
                self.assertEqual(lines, wanted + [f"{ctypes.sizeof(library.Request)} {library.MAJOR}"])

    def test_pixels_are_those_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            file, out = pathlib.Path(folder, "scene.json"), pathlib.Path(folder, "out.exr")
            file.write_text(json.dumps(SCENE))
            done = musurf("render", file, "-o", out, "--progress", "none")
            self.assertEqual(done.returncode, 0, done.err)
            channels = exr.read(out)[1]
        end, (pixels, albedo, normal), watch = self.render()
        self.assertEqual((end, watch.said), (library.DONE, []))
        found = pixels.reshape(HEIGHT, WIDTH, 4)
        for i, name in enumerate("RGBA"):
            self.assertTrue(np.array_equal(found[..., i], channels[name]), name)
        inside = found[..., 3] == 1
        self.assertTrue(inside.any() and not inside.all())
        self.assertLess(np.abs(np.linalg.norm(normal.reshape(HEIGHT, WIDTH, 3)[inside], axis=-1) - 1).max(), 0.05)
        self.assertGreater(albedo.reshape(HEIGHT, WIDTH, 3)[inside].min(), 0)

    def test_it_is_watched_and_stops(self):
        endless = {**SCENE, "integrator": {"samples": 1 << 24}}
        end, (pixels, _, _), watch = self.render(endless, Watch(enough=3), interval=0.1)
        self.assertEqual(end, library.STOPPED)
        self.assertLess(watch.fractions[-1], 1)
        self.assertEqual(watch.fractions, sorted(watch.fractions))
        self.assertTrue(np.isfinite(pixels).all() and pixels[:, :3].max() > 0)

    def test_no_more_threads_than_can_be_used(self):
        class Counting(Watch):
            most = 0

            def stop(self):
                self.most = max(self.most, len(os.listdir("/proc/self/task")))
                return self.most > 1100

        watch = Counting()
        self.assertEqual(library.render(json.dumps({**SCENE, "integrator": {"samples": 1}}), "scene.json", buffers(), watch, threads=1 << 20), library.DONE)
        self.assertLess(watch.most, 1100)

    def test_what_is_raised_comes_back(self):
        class Angry(Watch):
            def progress(self, *arguments):
                raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            self.render({**SCENE, "integrator": {"samples": 1 << 24}}, Angry())

    def test_refusals(self):
        for scene, count, wanted in (({**SCENE, "objects": []}, WIDTH * HEIGHT, "scene.json:1:"), (SCENE, 5, "but the host's buffer 5"),
                                     ({**SCENE, "lights": [{"type": "environment", "image": "/none.exr"}]}, WIDTH * HEIGHT, "/none.exr")):
            end, _, watch = self.render(scene, into=buffers(count))
            self.assertEqual(end, library.FAILED)
            self.assertEqual([s for s, _ in watch.said], [library.ERROR])
            self.assertIn(wanted, watch.said[0][1])

    def test_a_shorter_request(self):
        """Of a host that knows no callbacks."""
        shared, (pixels, _, _) = library.open_library(), buffers()
        request = library.Request(library.Request.stop.offset, 2, json.dumps(SCENE).encode(), b"x", library.pointer(pixels), len(pixels))
        self.assertEqual(shared.musurf_render_run(ctypes.byref(request)), library.DONE)
        self.assertTrue(np.array_equal(pixels, self.render()[1][0]))

    def test_the_parameter_table(self):
        table = library.parameters("musurf.microfacet")
        self.assertEqual(table, json.loads(musurf("info", "--json").out)["material"])
        with self.assertRaisesRegex(library.LibraryError, "acme_material.so"):
            library.parameters("acme.velvet")


if __name__ == "__main__":
    sys.exit(unittest.main())
