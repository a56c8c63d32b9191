#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""scenes/scene.schema.json against scenes/*.json and against the reader: what one takes the other takes.

Scenes spoilt at random are shown to both; jsonschema, which is not our code, judges by the schema. The few rules that a
schema cannot state (names that must exist, maps that must not be singular, ...) are told by the reader's words."""
import copy
import json
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

import jsonschema

from command import ROOT, musurf, strict

SCHEMA = json.loads((ROOT / "scenes/scene.schema.json").read_text())
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)
SCENES = sorted(path for path in (ROOT / "scenes").glob("**/*.json") if path.name != "scene.schema.json" and path.parent.name != "materials")
BEYOND_A_SCHEMA = ("there is no", "singular", "zero vector", "same point", "line of sight", "at most one light",
                   "must not be zero", "too many", "No such file", "last row", "is missing; the studio", "within 1e+09",
                   "needs texture coordinates", "is no formula", "no such file", "no transform that may vary", "not a mesh file")
# Every kind of object, each key at least once.
FULL = {
    "$schema": "x", "musurf": 1, "description": "all there is",
    "camera": {"type": "orthographic", "position": [1, -4, 2], "target": [0, 0, 0], "up": [0, 0, 1], "height": 3},
    "film": {"width": 4, "height": 4, "filter": "box", "radius": 0.5, "exposure": 1, "pixels": "float"},
    "integrator": {"samples": 1, "depth": 2, "roulette": 3, "seed": 4, "light_sampling": True, "light_candidates": 9},
    "materials": {"clay": {"material": "template.lambert", "reflectance": 0.6}, "apart": {"file": "apart.json"}},
    "meshes": {"tile": {"file": "tile.obj"}},
    "objects": [
        {"shape": "sphere", "radius": 0.5, "material": "clay", "two_sided": True,
         "transform": [{"translate": [0, 0, 1]}, {"rotate": [0, 0, 1, 30]}, {"scale": 2}, {"scale": [1, 2, 3]},
                       {"matrix": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]}],
         "grid": {"lines": 10, "width": 0.01, "material": {"material": "template.lambert"}}},
        {"shape": "rectangle", "size": [2, 2], "material": "clay", "transform": [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]},
        {"mesh": "tile", "material": "clay"},
        {"mesh": "tile", "material": {"material": "musurf.microfacet"}, "tension": {"rest": "tile.obj"}}],
    "lights": [{"type": "constant", "radiance": [1, 1, 1]},
               {"type": "directional", "direction": [0, 0, 1], "irradiance": 1},
               {"type": "rectangle", "size": [1, 1], "radiance": 2, "transform": [{"translate": [0, 0, 3]}]}],
}
LIGHTS = [{"type": "studio", "rotation": 10, "scale": 2}, {"type": "environment", "image": "none.exr", "rotation": 3,
                                                           "scale": [1, 1, 1], "fallback": "studio"}]
VALUES = [0, 1, -1, 0.5, 2.5, 1e12, -1e12, 40000, True, None, "", "clay", "box", [], {}, [1], [0, 0, 1], [1, 1], "sphere",
          [1, 2, 3, 4], [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]], {"material": "template.lambert"}]


def places(value):
    """Every container with every key or index in it."""
    for key in (list(value) if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ()):
        yield value, key
        yield from places(value[key])


def spoil(rng):
    scene = copy.deepcopy(FULL)
    scene["lights"][0] = copy.deepcopy(rng.choice([scene["lights"][0]] + LIGHTS))
    if rng.random() < 0.3:
        scene["camera"] = {"type": "perspective", "position": [0, -4, 2], "fov": 30}
    container, key = rng.choice([(c, k) for c, k in places(scene) if not within_material(c)])
    kind = rng.randrange(4)
    if kind == 0 or isinstance(container, list):
        container[key] = rng.choice(VALUES)
    elif kind == 1:
        del container[key]
    elif kind == 2:
        container[key + rng.choice("sx_")] = container.pop(key)
    else:
        container[rng.choice(["radius", "size", "type", "fov", "height", "lines", "image"])] = rng.choice(VALUES)
    return scene


def within_material(container):
    return isinstance(container, dict) and "template.lambert" in container.values()


class Scenes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        subprocess.run([sys.executable, str(ROOT / "scripts" / "meshes")], check=True, stdout=subprocess.DEVNULL)  # of scenes/figures

    def test_the_schema_is_one(self):
        jsonschema.Draft202012Validator.check_schema(SCHEMA)

    def test_every_scene_fits_the_schema(self):
        self.assertGreaterEqual(len(SCENES), 6)
        for path in SCENES:
            with self.subTest(path.name):
                VALIDATOR.validate(json.loads(path.read_text()))

    def test_every_scene_is_read(self):
        for path in SCENES:
            with self.subTest(path.name):
                done = musurf("render", path, "--explain")
                self.assertEqual(done.returncode, 0, done.err)
                strict(done.out)

    def test_schema_and_reader_judge_alike(self):
        rng = random.Random(20221)
        verdicts = {True: 0, False: 0}
        with tempfile.TemporaryDirectory(prefix="musurf-scenes-") as folder:
            scene_file = pathlib.Path(folder) / "scene.json"
            (pathlib.Path(folder) / "tile.obj").write_text(
                "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n")
            (pathlib.Path(folder) / "apart.json").write_text('{"description": "apart", "material": "template.lambert"}')
            for number in range(250):
                scene = spoil(rng)
                if number == 0:
                    scene = FULL
                scene_file.write_text(json.dumps(scene, indent=1))
                done = musurf("render", scene_file, "--explain")
                self.assertIn(done.returncode, (0, 2), done.err)
                fits = VALIDATOR.is_valid(scene)
                verdicts[fits] += 1
                if fits and done.returncode == 2 and any(word in done.err for word in BEYOND_A_SCHEMA):
                    continue
                self.assertEqual(done.returncode == 0, fits, f"{number}: {done.err}\n{json.dumps(scene)}")
        self.assertGreater(min(verdicts.values()), 40, verdicts)


if __name__ == "__main__":
    sys.exit(unittest.main())
