#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Parameters with sources: textures, direction maps, vertex attributes, formulas.

Pictures of a pair use the same random numbers. Where the same M is handed to the material, they are equal bit by bit.
"""
import json
import math
import pathlib
import struct
import sys
import tempfile
import unittest
import zlib

import numpy as np

import exr
from command import microfacet, musurf, strict

M = [[1, 2], [-0.5, 1.5]]
FLAT = {"u": "u", "v": "v"}  # the Jacobian of the identity: M goes through slots


def write_png(file, codes):
    """8-bit, grey or RGB."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    rows, columns = codes.shape[:2]
    raw = b"".join(b"\0" + row.tobytes() for row in codes.astype(np.uint8))
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 2 * (codes.ndim == 3), 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


class Pictures(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def texture(self, name, planes):
        exr.write(self.folder / name, {c: np.asarray(p, np.float32) for c, p in planes.items()})
        return {"texture": name}

    def scene(self, material, samples=4, size=(40, 30), **item):
        item = item or {"shape": "rectangle", "size": [2, 2]}
        scene = {"camera": {"position": [0.5, -2.5, 2], "target": [0, 0, 0], "fov": 40},
                 "film": {"width": size[0], "height": size[1], "pixels": "float"}, "integrator": {"samples": samples, "depth": 2},
                 "meshes": {"m": {"file": "m.ply"}} if "mesh" in item else {},
                 "objects": [dict(item, material=material)],
                 "lights": [{"type": "studio"}, {"type": "rectangle", "transform": [{"rotate": [1, 0, 0, 180]}, {"translate": [1, 2, 3]}]}]}
        (self.folder / "scene.json").write_text(json.dumps(scene))
        return self.folder / "scene.json"

    def picture(self, material, *more, **scene):
        done = musurf("render", self.scene(material, **scene), "-o", self.folder / "out.exr", "--progress", "none", *more)
        self.assertEqual(done.returncode, 0, done.err)
        channels = exr.read(self.folder / "out.exr")[1]
        picture = np.stack([channels[c] for c in "RGB"])
        self.assertGreater(picture.std(), 0.01)
        return picture

    def metal(self, **parameters):
        return microfacet(sampler="visible", fresnel={"conductor": "Ag"}, **parameters)

    def refused(self, material, *words, **scene):
        done = musurf("render", self.scene(material, **scene), "-o", self.folder / "out.exr", "--progress", "none")
        self.assertEqual(done.returncode, 2, done.err)
        line = done.err.strip()
        self.assertEqual(len(line.splitlines()), 1, line)
        for word in words:
            self.assertIn(word, line)
        return line


class Textures(Pictures):
    def test_constant_texture_is_the_constant(self):
        planes = {f"m{k // 2}{k % 2}": np.full((8, 16), np.ravel(M)[k]) for k in range(4)}
        alone = self.picture(self.metal(alpha=0.25, transform=M))
        self.assertTrue(np.array_equal(alone, self.picture(self.metal(alpha=0.25, transform=self.texture("m.exr", planes)))))
        self.assertTrue(np.array_equal(self.picture(self.metal(alpha=0.25, stretch=0.5)),
                                       self.picture(self.metal(alpha=self.texture("a.exr", {"Y": np.full((4, 4), 0.25)}),
                                                               stretch=self.texture("s.exr", {"Y": np.full((1, 1), 0.5)})))))

    def test_constant_where_it_is_seen(self):
        """Varying, but not in what any pixel covers: the same M from the texture as from the constant, on the way that what
        varies takes, bit by bit; both its parts, composed by the plugin, and filtered or not."""
        planes = {f"m{k // 2}{k % 2}": np.full((64, 64), np.ravel(M)[k]) for k in range(4)}
        for plane in planes.values():
            plane[-8:, :8] += 1
        away = {"wrap": "clamp", "scale": [0.25, 0.25], "offset": [0.7, 0.7]}
        constant = self.picture(self.metal(alpha=0.25, transform=M, jacobian=FLAT))
        for how in ("covariance", "none"):
            texture = self.texture("m.exr", planes) | away | {"filter": how}
            with self.subTest(filter=how):
                self.assertTrue(np.array_equal(constant, self.picture(self.metal(alpha=0.25, transform=texture))))
                self.assertTrue(np.array_equal(constant, self.picture(self.metal(alpha=0.25, transform=texture, jacobian=FLAT))))

    def test_parts_compose_as_constants_do(self):
        """One texel more makes each a texture. Rounding of M moves what is seen by some 1e-6 of it (test_varying.c); a sample
        of a thousand falls on the other side of a light's edge, and counts with its whole weight, 1/4 of a pixel."""
        def spread(value, name):
            plane = np.full((64, 64), value)
            plane[-8:, :8] *= 1.5
            return self.texture(name, {"Y": plane}) | {"wrap": "clamp", "scale": [0.25, 0.25], "offset": [0.7, 0.7]}
        parts = {"alpha_x": 0.125, "alpha_y": 0.5, "rotation": 0.75, "stretch": 0.375}
        constant = self.picture(self.metal(transform=M, **parts))
        varying = self.picture(self.metal(transform=M, **{name: spread(value, name + ".exr") for name, value in parts.items()}))
        off = np.abs(constant - varying) > 1e-4 * constant
        self.assertLess(off.mean(), 0.01)

    def test_files(self):
        """Where a picture's texels lie, and what its codes mean: patches, some of another roughness, by an 8-bit picture, raw
        and decoded, against a formula of the texture coordinates."""
        codes = np.array([[51, 102], [153, 204]])  # top left, top right, bottom left, bottom right
        write_png(self.folder / "p.png", np.repeat(np.repeat(codes, 8, 0), 8, 1))
        for name, decode in (("raw", lambda x: x), ("srgb", lambda x: ((x + 0.055) / 1.055)**2.4)):
            a = [decode(c / 255) for c in codes.ravel()]
            formula = ("%.17g + (%.17g - %.17g) * floor(2*u)" % (a[2], a[3], a[2]), "%.17g + (%.17g - %.17g) * floor(2*u)" % (a[0], a[1], a[0]))
            expected = self.picture(self.metal(alpha={"expression": f"({formula[0]}) * (1 - floor(2*v)) + ({formula[1]}) * floor(2*v)"}), size=(80, 60))
            got = self.picture(self.metal(alpha={"texture": "p.png", "colour_space": name, "wrap": "clamp", "filter": "none"}), size=(80, 60))
            off = np.abs(got - expected) > 1e-3 * expected
            # there is something between the texels where patches meet: in 1/16 of u and of v, and a pixel of 40 beside it
            self.assertLess(off.mean(), 2 * (1 / 16 + 2 / 40))
            self.assertGreater(off.mean(), 0)

    def test_threads(self):
        rng = np.random.default_rng(7)
        texture = self.texture("a.exr", {"Y": rng.uniform(0.05, 0.6, (50, 70))}) | {"scale": [9, 9]}
        one = self.picture(self.metal(alpha=texture), "--threads", "1")
        self.assertTrue(np.array_equal(one, self.picture(self.metal(alpha=texture), "--threads", "5")))

    def test_colour_of_another_plugin(self):
        green = {"R": np.full((4, 4), 0.1), "G": np.full((4, 4), 0.5), "B": np.full((4, 4), 0.25)}
        constant = self.picture({"material": "template.lambert", "reflectance": [0.1, 0.5, 0.25]})
        green["R"][0, 0] = 0.9
        got = self.picture({"material": "template.lambert", "reflectance": self.texture("c.exr", green)
                            | {"wrap": "clamp", "scale": [0.25, 0.25], "offset": [0.74, 0], "filter": "none"}})
        self.assertTrue(np.array_equal(constant, got))

    def test_tiled_and_with_levels(self):
        """What a tiled file with levels of its own gives is its finest level."""
        import shutil
        import subprocess
        tool = shutil.which("oiiotool")
        if not tool:
            self.skipTest("no oiiotool to make one")
        rng = np.random.default_rng(8)
        texture = self.texture("a.exr", {"Y": rng.uniform(0.05, 0.6, (64, 64))})
        subprocess.run([tool, self.folder / "a.exr", "--compression", "zip", "-otex:filtername=box", self.folder / "t.exr"], check=True,
                       capture_output=True)
        self.assertTrue(np.array_equal(self.picture(self.metal(alpha=texture)), self.picture(self.metal(alpha={"texture": "t.exr"}))))


class Directions(Pictures):
    def test_direction_map_is_a_rotation(self):
        """A brushed disc: vectors along circles, against the angle as a formula; where they are fine, and not at the centre."""
        n = 512
        y, x = np.mgrid[0:n, 0:n]
        u, v = (x + 0.5) / n - 0.5, 0.5 - (y + 0.5) / n
        self.texture("d.exr", {"X": -v, "Y": u})
        brushed = dict(alpha_x=0.05, alpha_y=0.3)
        got = self.picture(self.metal(rotation={"direction_map": "d.exr", "channels": ["X", "Y"], "filter": "none"}, **brushed))
        want = self.picture(self.metal(rotation={"expression": "atan2(u - 0.5, 0.5 - v)"}, **brushed))
        off = np.abs(got - want) > 0.01 * want
        self.assertLess(off.mean(), 0.02)

    def test_seams_of_angles_filter(self):
        """theta and theta + pi are one direction: a map that jumps between them is as good as one that does not."""
        n, far = 64, {"scale": [40, 40]}
        sign = np.where(np.add.outer(np.arange(n), np.arange(n)) % 2, 1, -1)
        self.texture("d.exr", {"X": sign * 0.6, "Y": sign * 0.8})
        brushed = dict(alpha_x=0.05, alpha_y=0.3)
        got = self.picture(self.metal(rotation={"direction_map": "d.exr"} | far, **brushed))
        want = self.picture(self.metal(rotation=math.atan2(0.8, 0.6), jacobian=FLAT, **brushed))
        off = np.abs(got - want) > 1e-3 * want
        self.assertLess(off.mean(), 0.01)


class Maps(Pictures):
    def test_formula_is_the_named_map(self):
        for transform in ([[1, 0], [0, 1]], M):
            named, formula = {"map": "power_shear", "amount": 2, "exponent": 5}, {"u": "u", "v": "v + 2*u^5"}
            self.assertTrue(np.array_equal(*(self.picture(self.metal(alpha=0.25, transform=transform, jacobian=j)) for j in (named, formula))))

    def test_displacement_is_its_formula(self):
        """A spline through the texels of 2 u^5, whose derivative is off by h^2/6 of its third one: 2e-4 for u = 1."""
        u = (np.arange(256) + 0.5) / 256
        self.texture("d.exr", {"X": np.zeros((4, 256)), "Y": np.tile(2 * u**5, (4, 1))})
        formula = self.picture(self.metal(alpha=0.25, jacobian={"u": "u", "v": "v + 2*u^5"}))
        got = self.picture(self.metal(alpha=0.25, jacobian={"displacement": "d.exr", "channels": ["X", "Y"], "wrap": "clamp"}))
        off = np.abs(got - formula) > 0.01 * formula
        self.assertLess(off.mean(), 0.02)
        ramp = np.add.outer(-np.arange(64), 2 * np.arange(64)) / 64  # v grows upwards
        self.texture("r.exr", {"X": ramp, "Y": -ramp})
        linear = self.picture(self.metal(alpha=0.25, jacobian={"u": "u + 0.25*(2*u + v)", "v": "v - 0.25*(2*u + v)"}))
        got = self.picture(self.metal(alpha=0.25, jacobian={"displacement": "r.exr", "channels": ["X", "Y"], "scale": 0.25, "wrap": "clamp"}))
        off = np.abs(got - linear) > 1e-3 * linear
        self.assertLess(off.mean(), 2 * 4 / 64)  # but for two texels at each edge, where the ramp ends


class Filtering(Pictures):
    """A plate under a sun alone, so that nothing but the texture is sampled; a pixel sees some 45 texels in a row."""

    def plate(self, material, samples):
        scene = {"camera": {"position": [0, -3, 2.6], "target": [0, 0, 0], "fov": 34},
                 "film": {"width": 20, "height": 15, "pixels": "float", "filter": "box"}, "integrator": {"samples": samples, "depth": 1},
                 "objects": [{"shape": "rectangle", "material": material}],
                 "lights": [{"type": "directional", "direction": [0.1, 3, 2.7], "irradiance": [1, 1, 1]}]}
        (self.folder / "plate.json").write_text(json.dumps(scene))
        done = musurf("render", self.folder / "plate.json", "-o", self.folder / "plate.exr", "--progress", "none")
        self.assertEqual(done.returncode, 0, done.err)
        return exr.read(self.folder / "plate.exr")[1]["G"].astype(float)

    def test_few_samples_do_not_alias_and_many_converge(self):
        """Against 4096 unfiltered samples: one filtered sample is nearer than one unfiltered; where roughness varies, by far,
        once what one sample does to a plate without texture is taken off; of 16 neither kind is worse than the other by more
        than scatter; and of 1024 both are the same, for neighbours differ by more than 1/1024."""
        rng = np.random.default_rng(3)
        angle = rng.uniform(-0.6, 0.6, (128, 128))
        strong, mild = np.where(rng.random((128, 128)) < 0.5, 0.1, 0.4), rng.uniform(0.2, 0.3, (128, 128))
        self.texture("turned.exr", {"X": np.cos(angle), "Y": np.sin(angle)})
        cases = [("alpha", self.texture(name, {"Y": plane}), {}, math.sqrt(np.mean(plane**2)))
                 for name, plane in (("strong.exr", strong), ("mild.exr", mild))]
        cases.append(("rotation", {"direction_map": "turned.exr", "channels": ["X", "Y"]}, dict(alpha_x=0.08, alpha_y=0.4), None))
        for parameter, source, others, level in cases:
            def made(samples, value=None, **how):
                value = value or source | {"scale": [5, 5]} | how
                return self.plate(microfacet(ndf="beckmann", sampler="visible", **others, **{parameter: value}), samples)

            def error(picture, of):
                return math.sqrt(np.mean((picture - of)**2) / np.mean(of**2))
            truth = made(4096, filter="none")
            with self.subTest(source):
                one, point = error(made(1), truth), error(made(1, filter="none"), truth)
                floor = error(made(1, level), made(256, level)) if level else 0
                self.assertLess(one**2 - floor**2, (point**2 - floor**2) / (4 if level else 1))
                self.assertLess(error(made(16), truth), 1.1 * error(made(16, filter="none"), truth))
                self.assertLess(error(made(1024), made(1024, filter="none")), 1e-4)


class Attributes(Pictures):
    def ply(self, name, vertices, faces, properties):
        columns = [x for x in properties]
        head = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}"]
        head += [f"property float {c}" for c in ["x", "y", "z", "s", "t"] + columns] + [f"element face {len(faces)}",
                                                                                        "property list uchar int vertex_indices", "end_header"]
        rows = [" ".join(repr(float(x)) for x in list(v) + [properties[c][i] for c in columns]) for i, v in enumerate(vertices)]
        (self.folder / name).write_text("\n".join(head + rows + [f"{len(f)} " + " ".join(map(str, f)) for f in faces]) + "\n")

    def grid(self, n=6):
        vertices = [(2 * i / n - 1, 2 * j / n - 1, 0, i / n, j / n) for j in range(n + 1) for i in range(n + 1)]
        cells = [j * (n + 1) + i for j in range(n) for i in range(n)]
        return vertices, [f for c in cells for f in ((c, c + 1, c + n + 2), (c, c + n + 2, c + n + 1))]

    def test_linear_attribute_is_a_formula(self):
        vertices, faces = self.grid()
        self.ply("m.ply", vertices, faces, {"age": [0.1 + 0.4 * v[3] + 0.2 * v[4] for v in vertices]})
        got = self.picture(self.metal(alpha={"attribute": "age"}), mesh="m")
        want = self.picture(self.metal(alpha={"expression": "0.1 + 0.4*u + 0.2*v"}), mesh="m")
        off = np.abs(got - want) > 1e-3 * want
        self.assertLess(off.mean(), 0.01)

    def test_equal_attributes_are_the_constant(self):
        vertices, faces = self.grid()
        self.ply("m.ply", vertices, faces, {f"m{k // 2}{k % 2}": [np.ravel(M)[k]] * len(vertices) for k in range(4)})
        got = self.picture(self.metal(alpha=0.25, transform={"attribute": ["m00", "m01", "m10", "m11"]}), mesh="m")
        self.assertTrue(np.array_equal(got, self.picture(self.metal(alpha=0.25, transform=M, jacobian=FLAT), mesh="m")))

    def test_tension_by_a_file(self):
        """What `musurf tension -o` writes, read as attributes, is the tension that the scene computes."""
        vertices, faces = self.grid()
        obj = ["vt %r %r" % v[3:] for v in vertices] + ["f " + " ".join(f"{i + 1}/{i + 1}" for i in f) for f in faces]
        bent = [(x + 0.2 * x * x, y, 0.25 * math.sin(2 * x) * math.cos(y)) for x, y, *_ in vertices]
        for name, points in (("rest.obj", [v[:3] for v in vertices]), ("bent.obj", bent)):
            (self.folder / name).write_text("\n".join(["v %r %r %r" % tuple(map(float, p)) for p in points] + obj) + "\n")
        done = musurf("tension", self.folder / "rest.obj", self.folder / "bent.obj", "-o", self.folder / "m.ply")
        self.assertEqual(done.returncode, 0, done.err)
        got = self.picture(self.metal(alpha=0.25, transform={"attribute": ["m00", "m01", "m10", "m11"]}), mesh="m")
        scene = json.loads(self.scene(self.metal(alpha=0.25), mesh="m", tension={"rest": "rest.obj"}).read_text())
        scene["meshes"]["m"]["file"] = "bent.obj"
        (self.folder / "scene.json").write_text(json.dumps(scene))
        done = musurf("render", self.folder / "scene.json", "-o", self.folder / "out.exr", "--progress", "none")
        self.assertEqual(done.returncode, 0, done.err)
        channels = exr.read(self.folder / "out.exr")[1]
        want = np.stack([channels[c] for c in "RGB"])
        off = np.abs(got - want) > 1e-3 * want
        self.assertLess(off.mean(), 0.01)

    def test_transform_of_vertices_before_a_picture(self):
        vertices, faces = self.grid()
        self.ply("m.ply", vertices, faces, {f"m{k // 2}{k % 2}": [np.ravel(M)[k]] * len(vertices) for k in range(4)})
        plane = np.full((64, 64), 0.25)
        plane[-8:, :8] = 0.5
        alpha = self.texture("a.exr", {"Y": plane}) | {"wrap": "clamp", "scale": [0.25, 0.25], "offset": [0.7, 0.7]}
        got = self.picture(self.metal(alpha=alpha, transform={"attribute": ["m00", "m01", "m10", "m11"]}), mesh="m")
        want = self.picture(self.metal(alpha=0.25, transform=M), mesh="m")
        off = np.abs(got - want) > 1e-3 * want
        self.assertLess(off.mean(), 0.01)


class Refusals(Pictures):
    def test_broken_inputs_give_one_clear_line(self):
        good = np.full((4, 6), 0.25)
        bad = good.copy()
        bad[2, 3] = -0.5
        nan = good.copy()
        nan[1, 4] = math.nan
        for name, plane in (("good.exr", good), ("bad.exr", bad), ("nan.exr", nan)):
            self.texture(name, {"Y": plane})
        self.texture("flat.exr", {c: good for c in ("m00", "m01", "m10")} | {"m11": np.where(np.arange(6) == 2, 0.25, 3) + 0 * good})
        (self.folder / "cut.exr").write_bytes((self.folder / "good.exr").read_bytes()[:420])
        (self.folder / "text.png").write_text("no picture")
        cases = [
            (dict(alpha={"texture": "none.exr"}), "$.objects[0].material.alpha.texture", "no such file"),
            (dict(alpha={"texture": "bad.exr"}), "$.objects[0].material.alpha.texture", "pixel 3 of line 2", "-0.5", "at least 0"),
            (dict(alpha={"texture": "nan.exr"}), "pixel 4 of line 1", "finite"),
            (dict(alpha={"texture": "cut.exr"}), "truncated or damaged"),
            (dict(alpha={"texture": "text.png"}), "alpha.texture"),
            (dict(transform={"texture": "good.exr"}), "transform.texture", "too few channels", "4 are needed"),
            (dict(transform={"texture": "flat.exr"}), "pixel 2 of line 0", "singular"),
            (dict(alpha={"texture": "good.exr", "channels": "R"}), "no channel \"R\"", "Y"),
            (dict(alpha={"texture": "good.exr", "wrap": "tile"}), "alpha.wrap", "repeat"),
            (dict(alpha={"texture": "good.exr", "colour_space": "sRGB"}), "alpha.colour_space", "srgb"),
            (dict(alpha={"textur": "good.exr"}), "did you mean \"texture\""),
            (dict(alpha={}), "needs a \"texture\""),
            (dict(alpha={"direction_map": "good.exr"}), "gives an angle, which alpha is not"),
            (dict(alpha={"attribute": "age"}), "$.objects[0]", "only a mesh has"),
            (dict(alpha={"expression": "0.1 +"}), "alpha.expression", "no formula", "at its end"),
            (dict(ndf="gtr", gamma={"expression": "1 + u"}), "material.gamma", "cannot vary"),
            (dict(ndf="gtr", alpha={"expression": "0.1 + u"}), "material.alpha", "cannot vary here", "shape"),
            (dict(alpha={"texture": "bad.exr", "range": [0.5, 1]}, rotation={"expression": "u"}), "material.rotation", "beside a picture only transform"),
            (dict(jacobian={"u": "u"}), "jacobian.v"),
            (dict(jacobian={"u": "u", "v": "v + w"}), "jacobian.v", "no formula", "knows u, v, pi"),
            (dict(jacobian={}), "needs a named \"map\""),
            (dict(jacobian={"displacement": "good.exr"}), "jacobian.displacement", "too few channels"),
            (dict(jacobian={"displacement": "good.exr", "u": "u"}), "jacobian.u", "displacement"),
        ]
        for parameters, *words in cases:
            with self.subTest(parameters):
                self.assertIn("scene.json:1:", self.refused(microfacet(**parameters), *words))
        self.texture("other.exr", {"Y": bad + 1})
        self.refused(microfacet(alpha={"texture": "other.exr"}, stretch={"texture": "bad.exr", "wrap": "clamp"}),
                     "material.stretch", "have to be the same")

    def test_attributes(self):
        grid = Attributes("grid")
        grid.folder = self.folder
        vertices, faces = grid.grid(2)
        grid.ply("m.ply", vertices, faces, {"age": [0.2] * len(vertices)})
        self.refused(microfacet(alpha={"attribute": "size"}), "$.objects[0]", "no property \"size\"", mesh="m")
        grid.ply("m.ply", vertices + vertices[:1], faces, {"age": [0.2] * len(vertices) + [0.3]})
        self.refused(microfacet(alpha={"attribute": "age"}), "$.objects[0]", "0.2 and 0.3", mesh="m")


class Explain(Pictures):
    def test_without_textures_no_openimageio(self):
        for material, loaded, feature in ((self.metal(alpha=0.2), False, None), (self.metal(alpha={"expression": "0.1 + u"}), False, "expressions"),
                                          (self.metal(alpha=self.texture("a.exr", {"Y": [[0.1, 0.2]]})), True, "textures")):
            done = musurf("render", self.scene(material), "--explain")
            self.assertEqual(done.returncode, 0, done.err)
            told = strict(done.out)
            self.assertEqual(any(name.startswith("libOpenImageIO") for name in told["libraries"]), loaded)
            self.assertEqual({"textures", "attributes", "expressions", "tensions"} & set(told["features"]), {feature} - {None})
            self.assertEqual(told["materials"][0]["texture_bytes"], 3 * 8 * 4 if loaded else 0)  # 2 texels and their mean


if __name__ == "__main__":
    sys.exit(unittest.main())
