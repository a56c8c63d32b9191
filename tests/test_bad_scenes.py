#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Bad scene files: each gets one line with file, line, column and JSON path, exit code 2, and the image that was there
stays as it was. The place expected is found in the text by this test, not by the program."""
import os
import pathlib
import re
import sys
import tempfile
import unittest
import unittest.mock

import exr
from command import LEAKS, musurf

GOOD = """{
 "musurf": 1,
 "camera": {"position": [0, -4, 2], "target": [0, 0, 0]},
 "film": {"width": 8, "height": 8},
 "integrator": {"samples": 1},
 "materials": {
  "clay": {"material": "template.lambert", "reflectance": 0.6},
  "metal": {"material": "musurf.microfacet", "ndf": "ggx", "alpha": 0.2, "transform": [[5, 0], [0, 1]]}
 },
 "meshes": {"tile": {"file": "tile.obj"}},
 "objects": [
  {"shape": "sphere", "radius": 0.5, "material": "clay", "transform": [{"translate": [0, 0, 1]}, {"scale": 1}]},
  {"shape": "rectangle", "size": [2, 2], "material": "metal", "grid": {"lines": 10, "material": "clay"}},
  {"mesh": "tile", "material": "clay", "two_sided": true}
 ],
 "lights": [
  {"type": "constant", "radiance": 1},
  {"type": "directional", "direction": [0, 0, 1], "irradiance": [1, 2, 3]},
  {"type": "rectangle", "size": [1, 1], "radiance": 2, "transform": [[1,0,0,0],[0,1,0,0],[0,0,1,3]]}
 ]
}
"""
OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"

# old text, new text, where the error points: a piece of the new text that stands once in the file, path, words to say
CASES = [
    ('"film"', '"flim"', '"flim"', "$.flim", ["film"]),
    ('"radius": 0.5', '"raduis": 0.5', '"raduis"', "$.objects[0].raduis", ["radius"]),
    ('"radius": 0.5', '"radius": "big"', '"big"', "$.objects[0].radius", ["number"]),
    ('"radius": 0.5', '"radius": -0.5', "-0.5", "$.objects[0].radius", ["1e-09"]),
    ('"radius": 0.5', '"radius": 1e300', "1e300", "$.objects[0].radius", ["1000000000"]),
    ('"size": [2, 2]', '"size": [2, 0]', "0], \"material\": \"metal\"", "$.objects[1].size[1]", ["1e-09"]),
    ('"size": [2, 2]', '"size": [2, 2, 2]', "[2, 2, 2]", "$.objects[1].size", ["2 numbers"]),
    ('"width": 8', '"width": 0', '0, "height"', "$.film.width", ["1 to 32768"]),
    ('"width": 8', '"width": 8.5', "8.5", "$.film.width", ["whole"]),
    ('"width": 8, "height": 8', '"width": 32768, "height": 32768', '{"width"', "$.film", ["too many"]),
    ('"samples": 1', '"samples": true', "true},\n \"mat", "$.integrator.samples", ["whole number"]),
    ('"samples": 1', '"reads": "often"', "\"often\"},\n", "$.integrator.reads", ["whole number", "auto"]),
    ('"musurf": 1', '"musurf": 2', "2,\n \"camera\"", "$.musurf", ["1"]),
    ('"type": "constant"', '"type": "constan"', '"constan"', "$.lights[0].type", ["constant"]),
    ('"shape": "sphere"', '"shape": "spere"', '"spere"', "$.objects[0].shape", ["sphere"]),
    ('"material": "clay", "transform"', '"material": "clya", "transform"', '"clya"', "$.objects[0].material", ["clay"]),
    ('"mesh": "tile"', '"mesh": "tyle"', '"tyle"', "$.objects[2].mesh", ["tile"]),
    ('"file": "tile.obj"', '"file": "tiles.obj"', '"tiles.obj"', "$.meshes.tile.file", ["No such file"]),
    ('"target": [0, 0, 0]', '"target": [0, -4, 2]', '{"position"', "$.camera", ["same point"]),
    ('{"scale": 1}', '{"scale": [1, 0, 1]}', '[{"translate"', "$.objects[0].transform", ["singular"]),
    ('{"scale": 1}', '{"scale": 1, "translate": [0, 0, 0]}', '{"scale"', "$.objects[0].transform[1]", ["exactly one"]),
    ('{"scale": 1}', '{"rotate": [0, 0, 0, 90]}', "[0, 0, 0, 90]", "$.objects[0].transform[1].rotate", ["axis"]),
    ('{"scale": 1}', '{"scael": 1}', '"scael"', "$.objects[0].transform[1].scael", ["scale"]),
    ("[0,0,1,3]]", "[0,0,1,3],[0,0,1,1]]", "[0,0,1,1]", "$.lights[2].transform[3]", ["[0, 0, 0, 1]"]),
    ('"direction": [0, 0, 1]', '"direction": [0, 0, 0]', '[0, 0, 0], "irr', "$.lights[1].direction", ["zero"]),
    ('"lights": [', '"lights": [\n  {"type": "point", "angle": 400},', '400', "$.lights[0].angle", ["360"]),
    ('"lights": [', '"lights": [\n  {"type": "point", "direction": [0.0, 0, 0]},', '[0.0, 0, 0]},', "$.lights[0].direction", ["zero"]),
    ('"irradiance": [1, 2, 3]', '"irradiance": [1, -2, 3]', "-2", "$.lights[1].irradiance[1]", ["0"]),
    ('"lights": [', '"lights": [\n  {"type": "studio"},', '{"type": "constant"', "$.lights[1]", ["at most one"]),
    ('"transform": [[5, 0], [0, 1]]', '"transform": [[5, 0], [5, 0]]', '[[5, 0], [5, 0]]', "$.materials.metal.transform",
     ["singular"]),
    ('"alpha": 0.2', '"alpah": 0.2', '"alpah"', "$.materials.metal.alpah", ["alpha"]),
    ('"alpha": 0.2', '"alpha": -1', "-1", "$.materials.metal.alpha", []),
    ('"two_sided": true', '"two_sided": 1', '1}\n ],', "$.objects[2].two_sided", ["true or false"]),
    ('"lines": 10', '"lines": 0', '0, "material": "clay"}}', "$.objects[1].grid.lines", ["1 to"]),
]


class BadScenes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="musurf-bad-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene, self.image = self.folder / "scene.json", self.folder / "out.exr"
        self.image.write_bytes(b"what was there")
        (self.folder / "tile.obj").write_text(OBJ)

    def render(self, text):
        self.scene.write_bytes(text if isinstance(text, bytes) else text.encode())
        return musurf("render", self.scene, "-o", self.image, "--progress", "none")

    def refused(self, text, place="", words=(), path=None):
        done = self.render(text)
        self.assertEqual(done.returncode, 2, done.err)
        self.assertEqual(done.out, "")
        self.assertEqual(done.err.count("\n"), 1, done.err)
        self.assertTrue(done.err.endswith("\n"))
        self.assertIn(str(self.scene), done.err)
        self.assertEqual(self.image.read_bytes(), b"what was there")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir() if p.name not in ("tile.obj", "cut.exr", "cut.png")),
                         ["out.exr", "scene.json"])
        if path:
            self.assertEqual(text.count(place), 1, place)
            at = text.index(place)
            line, column = text.count("\n", 0, at) + 1, at - text.rfind("\n", 0, at)
            self.assertIn(f"{self.scene}:{line}:{column}: {path}: ", done.err)
        for word in words:
            self.assertIn(word, done.err)
        return done.err

    def test_the_good_scene_is_rendered(self):
        done = self.render(GOOD)
        self.assertEqual(done.returncode, 0, done.err)
        self.assertNotEqual(self.image.read_bytes(), b"what was there")

    def test_each_mistake_has_its_place(self):
        for old, new, place, path, words in CASES:
            with self.subTest(new):
                self.assertEqual(GOOD.count(old), 1, old)
                self.refused(GOOD.replace(old, new), place, words, path)

    def test_numbers_that_are_none(self):
        for number in ("NaN", "Infinity", "-Infinity", "1e999", "0x10", ".5", "nan"):
            with self.subTest(number):
                error = self.refused(GOOD.replace('"radius": 0.5', f'"radius": {number}'))
                self.assertRegex(error, r"scene\.json:12:\d+: ")

    def test_empty_lists_and_missing_parts(self):
        self.refused("{}", "{}", ["object"])
        self.refused('{"objects": []}', "[]", ["at least one"], "$.objects")
        self.refused('{"objects": {}}', "{}", [], "$.objects")
        self.refused('{"objects": [{"shape": "sphere"}]}', words=["material", "missing"])
        self.refused('{"objects": [{"material": "x"}]}', '{"mat', ["shape"], "$.objects[0]")
        self.refused('{"objects": [3]}', "3", ["object"], "$.objects[0]")
        self.refused("[]", "[]")
        self.refused("", "")

    def test_material_files(self):
        """What is wrong with a file is said where it is named; what is wrong in it, with its own name, line and column."""
        apart = self.folder.parent / f"{self.folder.name}.json"  # beside the folder: this one is looked through
        self.addCleanup(apart.unlink, missing_ok=True)
        named = f'{{"file": "../{apart.name}"}}'
        scene = GOOD.replace('{"material": "template.lambert", "reflectance": 0.6}', named)
        self.refused(scene, f'"../{apart.name}"', ["cannot be opened", "No such file"], "$.materials.clay.file")
        self.refused(scene.replace('.json"}', '.json", "reflectance": 1}'), '"reflectance"', ["reflectance"], "$.materials.clay.reflectance")
        for text, where in (("{", ":1:"), ('{"ndf": "ggx"}', ":1:1: $"), ("[]", ":1:1: $: "), ('{"file": "x.json"}', ":1:10: $.file: "),
                            ('{"material": "template.lambert",\n "reflectance": 2}', ":2:17: $.reflectance: ")):
            apart.write_text(text)
            done = self.render(scene)
            self.assertEqual((done.returncode, done.err.count("\n")), (2, 1), done.err)
            self.assertIn(apart.name + where, done.err)
        apart.write_text('{"$schema": "x", "description": "clay", "material": "template.lambert", "reflectance": 0.6}')
        self.assertEqual(self.render(scene).returncode, 0)
        channels = exr.read(self.image)[1]
        self.assertEqual(self.render(GOOD).returncode, 0)
        for name, pixels in exr.read(self.image)[1].items():
            self.assertTrue((pixels == channels[name]).all(), name)

    def test_meshes(self):
        for text, word in (("", "tile.obj"), ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "tile.obj"),
                           ("v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "vertex 1"),
                           ("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "empty")):
            with self.subTest(text):
                (self.folder / "tile.obj").write_text(text)
                self.refused(GOOD, '"tile.obj"', [word], "$.meshes.tile.file")

    def test_a_mesh_that_nothing_uses(self):
        unused = GOOD.replace('"tile": {"file": "tile.obj"}', '"tile": {"file": "tile.obj"}, "other": {"file": "."}')
        self.refused(unused, '"."', ["not a regular file"], "$.meshes.other.file")

    def test_maps_need_texture_coordinates(self):
        scene = GOOD.replace('"two_sided": true', '"grid": {"material": "clay", "width": 0.5}')
        self.refused(scene, '{"material": "clay", "width"', ["texture coordinates"], "$.objects[2].grid")
        scene = GOOD.replace('"alpha": 0.2', '"alpha": 0.2, "jacobian": {"map": "power_shear", "amount": 2, "exponent": 5}')
        scene = scene.replace('"mesh": "tile", "material": "clay"', '"mesh": "tile", "material": "metal"')
        self.refused(scene, '"metal", "two', ["texture coordinates"], "$.objects[2].material")

    def test_environments(self):
        light = '{"type": "environment", "image": "cut.exr"}'
        scene = GOOD.replace('{"type": "constant", "radiance": 1}', light)
        self.refused(scene, '"cut.exr"', ["No such file"], "$.lights[0].image")
        whole = self.folder / "whole.exr"
        done = musurf("render", self.write_good(), "-o", whole, "--progress", "none")
        self.assertEqual(done.returncode, 0, done.err)
        data = whole.read_bytes()
        whole.unlink()
        for size in (0, 4, 100, len(data) // 2, len(data) - 40):
            with self.subTest(size):
                (self.folder / "cut.exr").write_bytes(data[:size])
                self.refused(scene, '"cut.exr"', ["cut.exr"], "$.lights[0].image")

    def test_a_cut_png(self):
        """libpng speaks on stderr for itself; there is to be one line, with its place."""
        whole = (pathlib.Path(__file__).resolve().parent.parent / "scenes/figure1.png").read_bytes()
        (self.folder / "cut.png").write_bytes(whole[:len(whole) // 2])
        scene = GOOD.replace('{"type": "constant", "radiance": 1}', '{"type": "environment", "image": "cut.png"}')
        with unittest.mock.patch.dict(os.environ, LEAKS):
            self.refused(scene, '"cut.png"', ["truncated"], "$.lights[0].image")

    def write_good(self):
        self.scene.write_text(GOOD)
        return self.scene

    def test_missing_environment_falls_back_once(self):
        light = '{"type": "environment", "image": "cut.exr", "fallback": "studio"}'
        done = self.render(GOOD.replace('{"type": "constant", "radiance": 1}', light))
        self.assertEqual(done.returncode, 0, done.err)
        warnings = [line for line in done.err.splitlines() if "warning" in line]
        self.assertEqual(len(warnings), 1, done.err)
        self.assertRegex(warnings[0], r"scene\.json:17:\d+: \$\.lights\[0\]\.image: .*cut\.exr is missing")

    def test_a_mesh_without_texture_coordinates_has_no_direction(self):
        """Said once for each mesh, and only where a material asks for one."""
        tile = '{"mesh": "tile", "material": "clay", "two_sided": true}'
        for count in (0, 2):
            done = self.render(GOOD.replace(tile, ", ".join([tile] + count * [tile.replace("clay", "metal")])))
            self.assertEqual(done.returncode, 0, done.err)
            warnings = [line for line in done.err.splitlines() if "warning" in line]
            self.assertEqual(len(warnings), min(count, 1), done.err)
        self.assertRegex(warnings[0], r'scene\.json:14:\d+: \$\.objects\[3\]: its material has a direction, and the mesh "tile" no texture coordinates')

    def test_brackets_without_end(self):
        for text in (b"[" * 100_000_000, b"[" * 1_000_000, b'{"objects":' * 100_000):
            error = self.refused(text)
            self.assertLess(len(error), 1200)
            self.assertRegex(error, r"scene\.json:1:\d+: ")

    def test_cut_anywhere(self):
        for size in range(0, len(GOOD) - 2, 41):
            with self.subTest(size):
                self.refused(GOOD[:size])

    def test_bytes_that_are_no_text(self):
        for text in (b"\xff\xfe{}", GOOD.encode().replace(b"clay", b"cl\xc3(y"), GOOD.encode().replace(b"clay", b"cl\0y"),
                     GOOD.encode().replace(b'"tile.obj"', b'"tile\\n\\u0007.obj"')):
            error = self.refused(text)
            self.assertTrue(re.fullmatch(r"[^\x00-\x09\x0b-\x1f]*", error), repr(error))


if __name__ == "__main__":
    sys.exit(unittest.main())
