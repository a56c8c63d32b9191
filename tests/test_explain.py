#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf render --explain`: every feature can be needed and left out, and what it claims is true.

What is loaded is looked up in the running process from outside (/proc/PID/maps); bytes are compared with what the scene
must cost; the list of features is the one in features.h."""
import copy
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time
import unittest

import gltf
from command import MUSURF, ROOT, musurf, strict

LISTED = re.findall(r'^\s+X\([A-Z_]+,\s*"(\w+)",\s*"[^"]+"\)', (ROOT / "core/render/features.h").read_text(), re.M)
LAMBERT = {"material": "template.lambert"}
BALL = {"shape": "sphere", "material": LAMBERT}
MINIMAL = {"film": {"width": 8, "height": 8}, "integrator": {"samples": 1, "depth": 2, "roulette": 2},
           "objects": [BALL], "lights": [{"type": "constant"}]}
METAL = {"material": "musurf.microfacet", "alpha": 0.2}
TILE = {"mesh": "tile", "material": LAMBERT}


def with_material(**parameters):
    return {"objects": [{"shape": "sphere", "material": dict(METAL, **parameters)}]}


OF_NOTE = {"libembree3", "libassimp", "libjansson", "libOpenImageIO", "musurf_oiio", "musurf_material", "template_material"}

# feature -> what to change in MINIMAL to need it; None: no material of today offers it
NEEDS = {
    "orthographic": {"camera": {"type": "orthographic"}},
    "rectangles": {"objects": [{"shape": "rectangle", "material": LAMBERT}]},
    "spheres": {},
    "meshes": {"objects": [TILE]},
    "instances": {"objects": [TILE, TILE]},
    "mesh_tangents": {"objects": [{"mesh": "tile", "material": dict(METAL, transform=[[5, 1], [0, 1]])}]},
    "poses": {"objects": [{"mesh": "posed", "material": LAMBERT, "pose": {}}], "meshes": {"posed": {"file": "posed.glb"}}},
    "tensions": {"objects": [dict(TILE, material=METAL, tension={"rest": "tile.obj"})]},
    "grids": {"objects": [dict(BALL, grid={"material": LAMBERT})]},
    "two_sided": {"objects": [dict(BALL, two_sided=True)]},
    "jacobians": with_material(jacobian={"map": "power_shear", "amount": 2, "exponent": 5}),
    "textures": with_material(alpha={"texture": "sky.exr"}),
    "normal_maps": with_material(normal_map={"file": "sky.exr", "range": [1, 2]}),
    "attributes": {"objects": [{"mesh": "square", "material": {"material": "musurf.microfacet", "alpha": {"attribute": "age"}}}],
                   "meshes": {"square": {"file": "square.ply"}}},
    "expressions": with_material(alpha={"expression": "0.1 + u*u"}),
    "blends": with_material(ndf="gtr", gamma={"expression": "1 + u"}),
    "footprints": with_material(ndf="discrete_ggx"),
    "environment": {"lights": [{"type": "environment", "image": "sky.exr"}]},
    "studio": {"lights": [{"type": "studio"}]},
    "constant": {},
    "filtered_light": {"integrator": {"samples": 1, "depth": 2, "roulette": 2, "by": "split"},
                       "objects": [{"shape": "sphere", "material": METAL}]},
    "directional_lights": {"lights": [{"type": "directional"}]},
    "point_lights": {"lights": [{"type": "point", "position": [0, 0, 3]}]},
    "rectangle_lights": {"lights": [{"type": "rectangle"}]},
    "glossy_reflection": with_material(),
    "delta_reflection": with_material(alpha=0),
    "glossy_transmission": with_material(fresnel={"dielectric": 1.5}, transmission=True),
    "delta_transmission": with_material(fresnel={"dielectric": 1.5}, transmission=True, alpha=0),
    "diffuse_reflection": {},
    "diffuse_transmission": None,
    "material_tables": with_material(ndf="gtr", gamma=1.3),
    "roulette": {"integrator": {"samples": 1, "depth": 9, "roulette": 2}},
}


class Explain(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="musurf-explain-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "square.ply").write_text(
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float age\n"
            "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 .1\n1 0 0 .2\n0 1 0 .3\n3 0 1 2\n")
        w = gltf.Writer()
        corners = w.add([(0, 0, 0), (1, 0, 0), (0, 1, 0)], bounds=True)
        (self.folder / "posed.glb").write_bytes(w.finish(scenes=[{"nodes": [0]}], nodes=[{"mesh": 0}], meshes=[
            {"primitives": [{"attributes": {"POSITION": corners}, "indices": w.add([0, 1, 2], gltf.INT)}]}]))
        (self.folder / "tile.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n")

    def write(self, change, **more):
        scene = dict(copy.deepcopy(MINIMAL), meshes={"tile": {"file": "tile.obj"}}, **more)
        scene.update(copy.deepcopy(change))
        path = self.folder / "scene.json"
        path.write_text(json.dumps(scene))
        return path

    def make_sky(self):
        """A picture of 16 x 8 pixels."""
        path = self.write({"film": {"width": 16, "height": 8}})
        done = musurf("render", path, "-o", self.folder / "sky.exr", "--progress", "none")
        self.assertEqual(done.returncode, 0, done.err)

    def explain(self, change):
        done = musurf("render", self.write(change), "--explain")
        self.assertEqual(done.returncode, 0, done.err)
        return strict(done.out)

    def test_list_and_table_agree(self):
        self.assertEqual(LISTED, list(NEEDS))

    def test_each_feature_is_needed_or_left_out(self):
        self.make_sky()
        minimal = self.explain({})
        self.assertEqual(set(minimal["features"]), {"spheres", "constant", "diffuse_reflection"})
        self.assertEqual(set(minimal["features"]) | set(minimal["left_out"]), set(LISTED))
        for feature, change in NEEDS.items():
            if not change:
                continue
            with self.subTest(feature):
                told = self.explain(change)
                self.assertIn(feature, told["features"])
                self.assertEqual(len(told["features"]) + len(told["left_out"]), len(LISTED))

    def maps_while_rendering(self, change):
        """Names of the files mapped into a render that is under way."""
        scene = self.write(change)
        with subprocess.Popen([MUSURF, "render", scene, "-o", self.folder / "out.exr", "--time", "60", "--threads", "1",
                               "--progress", "json"], stderr=subprocess.PIPE, text=True) as process:
            for line in process.stderr:
                if '"progress"' in line:
                    break
            maps = pathlib.Path(f"/proc/{process.pid}/maps").read_text()
            names = {line.split("/")[-1] for line in maps.splitlines() if "/" in line}
            process.terminate()
            process.communicate(timeout=60)
        self.assertIn("musurf", names)
        return names

    def test_libraries_are_what_the_process_has(self):
        self.make_sky()
        for change, image in (({}, False), (NEEDS["environment"], True), (NEEDS["studio"], False)):
            with self.subTest(image=image):
                told, mapped = set(self.explain(change)["libraries"]), self.maps_while_rendering(change)
                for names in (told, mapped):
                    self.assertEqual(any(name.startswith("libOpenImageIO") for name in names), image)
                # by stem: links have shorter version numbers than the files they lead to
                stems = [{name.split(".so")[0] for name in names} & OF_NOTE for names in (told, mapped)]
                self.assertEqual(*stems)
                self.assertGreaterEqual(len(stems[0]), 3)

    def test_only_named_plugins_are_opened(self):
        lambert, metal = self.explain({}), self.explain(with_material())
        self.assertEqual([os.path.basename(p) for p in lambert["plugins"]], ["template_material.so"])
        self.assertNotIn("musurf_material.so", lambert["libraries"])
        self.assertNotIn("musurf_material.so", self.maps_while_rendering({}))
        self.assertEqual([os.path.basename(p) for p in metal["plugins"]], ["musurf_material.so"])
        self.assertIn("musurf_material.so", self.maps_while_rendering(with_material()))

    def test_tables_that_leave_directions_open_say_so(self):
        """And only those: total reflection of tilted glass begins along curves; a shear is smooth. Neither misses its error."""
        glass = dict(tilt=[0.03, 0.2], transform=[[1, 0], [0, 3000]], fresnel="dielectric", transmission=True)
        for parameters, open_ in ((glass, True), (dict(transform=[[1, 2], [0, 1]]), False)):
            with self.subTest(open_=open_):
                change = with_material(multiple_scattering="compensated", **dict(parameters, alpha=0.3))
                done = musurf("render", self.write(change), "--explain")
                self.assertEqual(done.returncode, 0, done.err)
                plan = strict(done.out)["materials"][0]["plan"]
                self.assertEqual("albedo integrated for 0." in plan, open_)
                self.assertEqual("tables of compensation leave 0." in done.err, open_)
                self.assertNotIn("albedo within", plan)

    def test_tables_are_built_only_for_what_is_drawn(self):
        self.make_sky()
        self.assertEqual(self.explain({})["lights"], {"filtered_bytes": 0, "table_bytes": 0, "image_bytes": 0})
        # a constant light's squares, the least there are: 2 log2 32 + 1 of 32 x 32 texels of 4 floats, each within a border
        self.assertEqual(self.explain(NEEDS["filtered_light"])["lights"]["filtered_bytes"], 11 * 34 * 34 * 4 * 4)
        sky = self.explain(NEEDS["environment"])["lights"]
        self.assertEqual(sky["image_bytes"], 16 * 8 * 3 * 4)
        self.assertGreater(sky["table_bytes"], 16 * 8 * 4)
        studio = self.explain(NEEDS["studio"])["lights"]
        self.assertEqual(studio["image_bytes"], 0)
        self.assertGreater(studio["table_bytes"], 0)

    def test_what_a_material_leaves_out(self):
        def one(**parameters):
            return self.explain(with_material(**parameters))["materials"][0]
        plain, turned, table = one(), one(transform=[[5, 1], [0, 1]]), one(ndf="gtr", gamma=1.3)
        self.assertNotEqual(plain["plan"], turned["plan"])
        self.assertFalse(plain["needs_tangent"])
        self.assertTrue(turned["needs_tangent"])
        self.assertEqual(plain["table_bytes"], 0)
        self.assertGreater(table["table_bytes"], 0)
        self.assertGreater(table["material_bytes"], plain["material_bytes"])
        for transform in ([[3, 0], [0, 3]], [[0, -1], [1, 0]], [[-1, 0], [0, 1]]):  # a scale, turn or mirror is no direction
            alike = one(transform=transform)
            self.assertFalse(alike["needs_tangent"])
            self.assertIn("matrices", alike["left_out"])
        self.assertNotIn("matrices", turned["left_out"])

    def test_the_sampler_and_why(self):
        def said(**parameters):
            return self.explain(with_material(**parameters))["materials"][0]["sampler"]
        self.assertRegex(said(ndf="gtr", gamma=0.1, alpha=0.3), r"^folded_uniform: least noise measured, 0\.\d\d of visible's")
        self.assertRegex(said(alpha=0.01), "^visible: least noise measured, 1.00 of")  # nothing is lost below the horizon
        self.assertEqual(said(ndf="gtr", gamma=0.1, sampler="ndf"), "ndf: as set, or by default")
        self.assertEqual(said(fresnel={"dielectric": 1.5}, transmission=True), "visible: no other serves this material")
        self.assertEqual(said(alpha=0), "none: a mirror")
        self.assertEqual(self.explain({})["materials"][0]["sampler"], "")  # a plugin that says nothing

    def test_page_and_info_list_the_same(self):
        listed = json.loads(musurf("info", "--json").out)["features"]
        self.assertEqual(list(listed), LISTED)
        block = (ROOT / "core/render/README.md").read_text().split("<!-- features: begin -->\n")[1].split("<!-- features: end -->")[0]
        self.assertEqual(re.findall(r"^\| (\w+) \| (.*) \|$", block, re.M)[1:], list(listed.items()))

    def test_unused_definitions_cost_nothing(self):
        unused = dict(METAL, ndf="gtr", gamma=1.3)
        told = self.explain({"materials": {"unused": unused}})
        self.assertEqual(len(told["materials"]), 1)
        self.assertEqual(told["meshes"], [])
        self.assertIn("material_tables", told["left_out"])

    def test_start_without_images_is_quick(self):
        """OpenImageIO alone takes some 400 ms to load; the best of several starts does not pay it."""
        scene, best = self.write({}), 1e9
        for _ in range(7):
            start = time.monotonic()
            self.assertEqual(musurf("render", scene, "--explain").returncode, 0)
            best = min(best, time.monotonic() - start)
        self.assertLess(best, 0.2)


if __name__ == "__main__":
    sys.exit(unittest.main())
