#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What of a scene of Blender's goes to the renderer: each mesh once, under whatever object; text, curves and metaballs as meshes; what geometry nodes and
collections instance, as what it is. What the renderer would refuse a whole scene for (objects scaled to nothing, meshes without area, numbers that
are not finite, negative light) is left out by name, as an animation needs that."""
import json
import pathlib
import re
import shutil
import sys
import unittest

import blender_host

HOSTS = blender_host.need()


class Export(blender_host.Installed):
    def setUp(self):
        super().setUp()
        self.cases = {}

    def read(self, host):
        log = blender_host.do(host, self.scripts, {"do": "blender_export.cases"}, codes=(0, 1))
        for name, said in re.findall(r"TEST case (\w+)\n(.*?)TEST alive \w+\n", log, re.S):
            self.assertNotIn("raised:", said)
            folder = pathlib.Path(re.search(r"the scene is in (\S+)", said)[1])
            self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
            self.cases[name] = json.loads((folder / "scene.json").read_text()), said

    def objects(self, name):
        """The number of faces of each object but the floor, by mesh."""
        scene = self.cases[name][0]
        counts = {key: pathlib.Path(mesh["file"]).read_text().count("\nf ") for key, mesh in scene["meshes"].items()}
        return sorted((thing["mesh"], counts[thing["mesh"]]) for thing in scene["objects"] if thing["mesh"] != "floor 0")

    def test_cases(self):
        for host in HOSTS:
            with self.subTest(host=host[0]):
                self.read(host)
                found = [name for name, count in self.objects("no_meshes")]
                self.assertEqual(found, ["drop 0", "ring 0", "surface 0", "text 0"])
                self.assertEqual(self.objects("nodes"), [("grown 0", 1)] + 4 * [("grown' 0", 6)])
                self.assertEqual(self.objects("instances"), 3 * [("ball 0", 8 * (3 + 2 * 4 + 3))])
                for name, words in (("scaled_to_nothing", '"ball" is scaled to nothing along an axis; it is left out'),
                                    ("without_area", '"flat" has no face with an area; it is left out'),
                                    ("not_finite", '"ball" has vertices that are not finite, or too far away; it is left out'),
                                    ("bright", 'the light "lamp" is negative or too bright; it is left out'),
                                    ("bright", "the world is negative or too bright; it is left out"),
                                    ("painted_on", 'the image "painted" has been painted on since it was saved: what was saved is rendered')):
                    self.assertEqual(self.objects(name), [])
                    self.assertIn(words, self.cases[name][1])
                self.assertEqual(self.cases["bright"][0]["lights"], [])
                self.assertEqual([count for _, count in self.objects("slivers")], [2])
                for name in ("no_meshes", "nodes", "instances", "slivers", "packed"):
                    self.assertNotIn("left out", self.cases[name][1].replace("triangles without area were left out", ""))


if __name__ == "__main__":
    sys.exit(unittest.main())
