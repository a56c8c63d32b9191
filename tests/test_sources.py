#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Parameters with sources: textures, direction maps, vertex attributes, formulas.

Pictures of a pair use the same random numbers. Where the same M is handed to the material, they are equal bit by bit.
"""
import math
import sys
import unittest

import numpy as np

from command import microfacet, musurf, strict
from plates import FLAT, M, Pictures, write_png


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

    def test_attribute_of_what_is_compiled_is_a_formula(self):
        """gamma and gtr's alpha from vertices: the values of the formulas, so the same draws of the same materials; beyond "between" the
        nearer end."""
        vertices, faces = self.grid()
        self.ply("m.ply", vertices, faces, {"g": [1 + v[3] for v in vertices], "a": [0.1 + 0.4 * v[4] for v in vertices]})
        for formula, attribute in ((dict(gamma={"expression": "1 + u"}), dict(gamma={"attribute": "g", "between": [1, 2]})),
                                   (dict(gamma={"expression": "1.2 + 0.6*min(max((u - 0.2)/0.6, 0), 1)"}), dict(gamma={"attribute": "g", "between": [1.2, 1.8]})),
                                   (dict(gamma={"expression": "1 + u"}, alpha={"expression": "0.1 + 0.4*v"}),
                                    dict(gamma={"attribute": "g", "between": [1, 2]}, alpha={"attribute": "a", "between": [0.1, 0.5]}))):
            got, want = (self.picture(self.metal(**{"ndf": "gtr", "alpha": 0.2} | p), mesh="m") for p in (attribute, formula))
            off = np.abs(got - want) > 1e-3 * want
            self.assertLess(off.mean(), 0.01)

    def test_equal_attributes_are_the_constant(self):
        vertices, faces = self.grid()
        self.ply("m.ply", vertices, faces, {f"m{k // 2}{k % 2}": [np.ravel(M)[k]] * len(vertices) for k in range(4)})
        got = self.picture(self.metal(alpha=0.25, transform={"attribute": ["m00", "m01", "m10", "m11"]}), mesh="m")
        self.assertTrue(np.array_equal(got, self.picture(self.metal(alpha=0.25, transform=M, jacobian=FLAT), mesh="m")))

    def bend(self):
        """A bent square, at rest in rest.obj and as bent.obj."""
        vertices, faces = self.grid()
        obj = ["vt %r %r" % v[3:] for v in vertices] + ["f " + " ".join(f"{i + 1}/{i + 1}" for i in f) for f in faces]
        bent = [(x + 0.2 * x * x, y, 0.25 * math.sin(2 * x) * math.cos(y)) for x, y, *_ in vertices]
        for name, points in (("rest.obj", [v[:3] for v in vertices]), ("bent.obj", bent)):
            (self.folder / name).write_text("\n".join(["v %r %r %r" % tuple(map(float, p)) for p in points] + obj) + "\n")

    def test_tension_by_a_file(self):
        """What `musurf tension -o` writes, read as attributes, is the tension that the scene computes."""
        self.bend()
        done = musurf("tension", self.folder / "rest.obj", self.folder / "bent.obj", "-o", self.folder / "m.ply")
        self.assertEqual(done.returncode, 0, done.err)
        got = self.picture(self.metal(alpha=0.25, transform={"attribute": ["m00", "m01", "m10", "m11"]}), mesh="m")
        want = self.picture(self.metal(alpha=0.25), mesh="m", file="bent.obj", tension={"rest": "rest.obj"})
        off = np.abs(got - want) > 1e-3 * want
        self.assertLess(off.mean(), 0.01)

    def test_order(self):
        """M = P J P^-1 T transform: a transform from a picture stands where the constant does, bit by bit, also under a tension
        and a map, neither of which commutes with it or with the other."""
        self.bend()
        planes = {f"m{k // 2}{k % 2}": np.full((64, 64), np.ravel(M)[k]) for k in range(4)}
        planes["m00"][-8:, :8] += 1
        texture = self.texture("m.exr", planes) | {"wrap": "clamp", "scale": [0.25, 0.25], "offset": [0.7, 0.7]}
        for more in ({}, {"jacobian": {"u": "u + 0.3*v", "v": "v + u^2"}}):
            one, other = (self.picture(self.metal(alpha=0.25, transform=t, **more), mesh="m", file="bent.obj", tension={"rest": "rest.obj"})
                          for t in (M, texture))
            self.assertTrue(np.array_equal(one, other))

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
            (dict(ndf="gtr", gamma={"expression": "1 - 2*u"}), "material.gamma", "at least 0"),
            (dict(ndf="gtr", gamma={"attribute": "age"}), "material.gamma", "comes from vertices", "between"),
            (dict(ndf="gtr", gamma={"attribute": "age", "between": [3, 1]}), "material.gamma.between", "[3, 1]", "the second must not be less"),
            (dict(ndf="gtr", gamma={"attribute": "age", "between": [-1, 1]}), "material.gamma.between", "[-1, 1]", "at least 0"),
            (dict(ndf="gtr", gamma={"expression": "1 + u", "between": [1, 2]}), "material.gamma.between"),
            (dict(ndf="phong", exponent={"expression": "1 + u"}, theta_x={"expression": "u"}, theta_y={"expression": "u"}), "cannot vary too", "exponent and theta_x"),
            (dict(fresnel={"schlick": {"texture": "good.exr"}}), "fresnel.schlick", "cannot vary over the surface"),
            (dict(alpha={"texture": "bad.exr", "range": [0.5, 1]}, rotation={"expression": "u"}), "material.rotation", "beside a picture only transform"),
            (dict(alpha={"expression": "u/0"}), "material.alpha: gives inf", "finite", "all places"),
            (dict(alpha={"expression": "-0.1 - u"}), "material.alpha: gives -0.1", "at least 0", "all places"),
            (dict(rotation={"expression": "sqrt(-1 - v)"}, alpha_x=0.1), "material.rotation: gives nan", "finite"),
            (dict(transform={"expression": ["u", "u", "v", "v"]}), "material.transform: gives [[", "invertible"),
            (dict(jacobian={"u": "u", "v": "u"}), "material.jacobian: gives [[1, 0], [1, 0]]", "invertible"),
            (dict(jacobian={"u": "u + 0/0", "v": "v"}), "material.jacobian: gives [[nan, nan], [0, 1]]", "finite"),
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

    def test_bad_places_are_counted(self):
        """A half of the unit square: a warning with its share; the rest is what it is."""
        for parameters, *words in ((dict(alpha={"expression": "u - 0.5"}), "alpha: gives -0.492188", "at least 0"),
                                   (dict(alpha={"expression": "0.3 + 0*log(u - 0.5)"}), "alpha: gives nan", "finite"),
                                   (dict(stretch={"expression": "1.5 - u"}), "stretch: gives 1.49219", "below 1"),
                                   (dict(jacobian={"u": "max(u, 0.5)", "v": "v"}), "jacobian: gives [[0, 0], [0, 1]]", "invertible")):
            with self.subTest(parameters):
                done = musurf("render", self.scene(microfacet(**parameters)), "-o", self.folder / "out.exr", "--progress", "none")
                self.assertEqual(done.returncode, 0, done.err)
                warning = [line for line in done.err.splitlines() if "warning" in line]
                self.assertEqual(len(warning), 1, done.err)
                for word in (*words, "2048 of 64 x 64 places", "scene.json:1:"):
                    self.assertIn(word, warning[0])

    def test_attributes(self):
        grid = Attributes("grid")
        grid.folder = self.folder
        vertices, faces = grid.grid(2)
        grid.ply("m.ply", vertices, faces, {"age": [0.2] * len(vertices)})
        self.refused(microfacet(alpha={"attribute": "size"}), "$.objects[0]", "no property \"size\"", mesh="m")
        grid.ply("m.ply", vertices + vertices[:1], faces, {"age": [0.2] * len(vertices) + [0.3]})
        self.refused(microfacet(alpha={"attribute": "age"}), "$.objects[0]", "0.2 and 0.3", mesh="m")
        grid.ply("m.ply", vertices, faces, {"age": [0.2, -0.3] + [0.2] * (len(vertices) - 2)})
        self.refused(microfacet(alpha={"attribute": "age"}), "$.objects[0]", "vertex at (0, -1, 0)", "\"age\" of -0.3", "at least 0", mesh="m")


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
