#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Normal maps: what they mean, against meshes with such normals and turned copies of themselves; what is seen of them from afar,
against every texel by itself; and refusals.

Where pictures are compared closely, the light is parallel and reflected once: nothing is drawn at random but where in a pixel
is looked, which is the same for both.
"""
import math
import sys
import unittest
from statistics import NormalDist

import numpy as np

from command import musurf, strict
from picture_flip import flip
from plates import FLAT, Pictures, write_png

SUN = [{"type": "directional", "direction": [0.3, 0.5, 0.8]}]


def encode(sx, sy):
    """Unit normals of slopes, by channel; the top row is v = 1."""
    length = 1 / np.sqrt(1 + sx**2 + sy**2)
    return {"R": -sx * length, "G": -sy * length, "B": length}


def waves(n=256, height=0.3):
    """Slopes of a smooth periodic surface, by formulas, at the middles of texels."""
    return slopes_at(*np.meshgrid((np.arange(n) + 0.5) / n, 1 - (np.arange(n) + 0.5) / n), height)


def slopes_at(u, v, height=0.3):
    a, b = 2 * math.pi * (2 * u + v), 2 * math.pi * (u - v)
    return height * (np.cos(a) + 0.5 * np.cos(b)), height * (0.5 * np.cos(a) - 0.5 * np.cos(b))


class Maps(Pictures):
    def sunny(self, material, samples=4, size=(40, 30), light=SUN, depth=1, camera=None, **item):
        def change(scene):
            scene["lights"], scene["integrator"] = light, {"samples": samples, "depth": depth}
            scene["camera"] = camera or scene["camera"]
        return self.picture(material, samples=samples, size=size, change=change, **item)

    def map(self, name, planes, **more):
        self.texture(name, planes)
        return {"file": name} | more

    def close(self, a, b, bound):
        off = np.abs(a - b) / np.maximum(b, 1e-3 * b.max())
        self.assertLess(off.max(), bound)


class Meaning(Maps):
    def test_one_that_leans_nowhere_is_none(self):
        alone = self.picture(self.metal(alpha=0.25, alpha_x=0.1))
        write_png(self.folder / "n.png", np.tile([128, 127, 255], (4, 4, 1)))  # no code is 0: the two beside it are
        for map in (self.map("n.exr", encode(np.zeros((4, 8)), np.zeros((4, 8)))), {"file": "n.png", "y": "down"},
                    self.map("w.exr", encode(*waves(8)), strength=0)):
            got = self.picture(self.metal(alpha=0.25, alpha_x=0.1, normal_map=map))
            self.assertTrue(np.array_equal(alone, got), map)
        told = strict(musurf("render", self.scene(self.metal(normal_map={"file": "n.png"})), "--explain").out)
        self.assertEqual(told["materials"][0]["normal_map"], "none")
        self.assertIn("normal_maps", told["left_out"])

    def test_level_where_it_is_seen(self):
        """It leans somewhere, but not in what any pixel covers: the picture without it bit by bit, on the way that M takes where
        the lobe may be widened."""
        sx, sy = np.zeros((64, 64)), np.zeros((64, 64))
        sx[-8:, :8] = 0.5
        away = {"wrap": "clamp", "scale": [0.25, 0.25], "offset": [0.7, 0.7]}
        metal = dict(alpha_x=0.25, alpha_y=0.1)
        for how, more in (("none", {}), ("covariance", {"jacobian": FLAT})):
            map = self.map("n.exr", encode(sx, sy), filter=how, **away)
            self.assertTrue(np.array_equal(self.picture(self.metal(**metal, **more)), self.picture(self.metal(normal_map=map, **metal))), how)

    def mesh(self, name, n, normal_at, uv_at=lambda u, v: (u, v)):
        """A plate of n x n cells with the normals that a function of (u, v) gives."""
        t = np.arange(n + 1) / n
        v, u = (a.ravel() for a in np.meshgrid(t, t, indexing="ij"))
        sx, sy = normal_at(u, v)
        lines = [f"v {2*a-1:.9g} {2*b-1:.9g} 0" for a, b in zip(u, v)] + ["vt %.9g %.9g" % uv_at(a, b) for a, b in zip(u, v)]
        lines += [f"vn {-x:.9g} {-y:.9g} 1" for x, y in zip(sx, sy)]
        for j in range(n):
            for i in range(n):
                a, b, c, d = (k + 1 for k in (j*(n+1)+i, j*(n+1)+i+1, (j+1)*(n+1)+i+1, (j+1)*(n+1)+i))
                lines += [f"f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}", f"f {a}/{a}/{a} {c}/{c}/{c} {d}/{d}/{d}"]
        (self.folder / name).write_text("\n".join(lines) + "\n")
        return {"mesh": "m", "file": name}

    def test_leaning_map_is_a_mesh_with_leaning_normals(self):
        """Floats of normals are off by 2^-24, and once more by the frame: 4 2^-24 in a slope. |d log f / d slope| is at most 4 / alpha
        of GGX, with masking and cosine at most 4 / alpha + 10: 90 here; and 2^-15 for float shading, which is not the same."""
        lean = (0.2, -0.1)
        metal = self.metal(alpha_x=0.05, alpha_y=0.2, rotation=0.4)
        want = self.sunny(metal, **self.mesh("m.obj", 1, lambda u, v: (lean[0] + 0 * u, lean[1] + 0 * u)))
        for how in ("covariance", "none"):
            map = self.map("n.exr", encode(np.full((4, 4), lean[0]), np.full((4, 4), lean[1])), filter=how)
            self.close(self.sunny(metal | {"normal_map": map}), want, 90 * 2**-22 + 2**-15)

    def test_height_field_is_a_mesh_with_its_normals(self):
        """h = 1/128 a cell, against 512 texels. Linear along the cells' diagonals is off by h^2 / 8 of the second derivative
        there, 0.3 (2 pi)^2 9 = 107: 8.1e-4. Unit normals are linear, not slopes, whose weights then change along the edge by
        the length's log, h s s' / (1 + s^2) < 3.8 h, and that of h s' < 8.5 h / 4: 5e-4. Texels: 16 times less. GGX of alpha 0.3: 4 / alpha +
        10 times that."""
        metal = self.metal(alpha=0.3)
        want = self.sunny(metal, **self.mesh("m.obj", 128, slopes_at))
        got = self.sunny(metal | {"normal_map": self.map("n.exr", encode(*waves(512)), filter="none")})
        flat = self.sunny(metal)
        self.close(got, want, (4 / 0.3 + 10) * (8.1e-4 + 5e-4) * 17 / 16)
        self.assertGreater(np.abs(flat - want).mean() / want.mean(), 0.2)

    def test_turned_with_its_texture(self):
        """A quarter of a turn, and mirrored, of picture, its vectors and the mesh's texture coordinates together; and seen from behind.
        Bounds as of the leaning map: 4 / 0.2 + 10."""
        metal = self.metal(alpha=0.2)
        sx, sy = waves(64)
        plate = self.mesh("m.obj", 1, lambda u, v: (0 * u, 0 * u))
        turned = self.mesh("t.obj", 1, lambda u, v: (0 * u, 0 * u), lambda u, v: (v, 1 - u))
        mirror = self.mesh("f.obj", 1, lambda u, v: (0 * u, 0 * u), lambda u, v: (1 - u, v))
        more = {"scale": [3, 3]}  # so that pixels see enough of it to be widened, too
        want = self.sunny(metal | {"normal_map": self.map("n.exr", encode(sx, sy), **more)}, **plate)
        # u' = v, v' = 1 - u: slopes (sy, -sx), the picture turned so that its columns are rows
        turn = self.map("t.exr", encode(np.rot90(sy, -1), -np.rot90(sx, -1)), **more)
        self.close(self.sunny(metal | {"normal_map": turn}, **turned), want, 30 * 2**-20 + 2**-14)
        flip = self.map("f.exr", encode(-sx[:, ::-1], sy[:, ::-1]), **more)
        self.close(self.sunny(metal | {"normal_map": flip}, **mirror), want, 30 * 2**-20 + 2**-14)
        # about x: (x, y) is at (x, -y), and what stood out is sunk in
        behind = self.map("b.exr", encode(-sx[::-1], sy[::-1]), **more)
        over = {**plate, "transform": [{"rotate": [1, 0, 0, 180]}], "two_sided": True}
        self.close(self.sunny(metal | {"normal_map": behind}, **over), want, 30 * 2**-20 + 2**-14)

    def test_words(self):
        sx, sy = waves(64)
        picture = lambda **more: self.sunny(self.metal(alpha=0.2, normal_map={"file": "n.exr"} | more))  # noqa: E731
        def made(planes):
            self.texture("n.exr", planes)
        made(encode(2 * sx, -2 * sy))
        want = picture()
        made(encode(sx, sy))
        self.close(picture(y="down", strength=2), want, 1e-4)
        n = {c: (p + 1) / 2 for c, p in encode(2 * sx, -2 * sy).items()}
        made({"X": n["R"], "Y": n["G"], "other": 0 * n["B"]})
        self.close(picture(range=[-1, 1], channels=["X", "Y"]), want, 1e-3)  # z of float x, y
        turned = {c: p[:, ::-1] for c, p in encode(-2 * sx, -2 * sy).items()}
        made(turned)
        self.close(picture(scale=[-1, 1], offset=[1, 0]), want, 1e-4)


class FromAfar(Maps):
    ABOVE = {"type": "orthographic", "position": [0, 0, 3], "target": [0, 0, 0], "up": [0, 1, 0], "height": 1}

    @staticmethod
    def every_texel(sx, sy, alpha, wi):
        """f cos of Beckmann (F = 1, height-correlated) seen from straight above, of each texel in its own frame, and the mean."""
        n = np.stack([-sx, -sy, np.ones_like(sx)], -1) / np.sqrt(1 + sx**2 + sy**2)[..., None]
        h = (wi + np.array([0, 0, 1])) / np.linalg.norm(wi + np.array([0, 0, 1]))
        cos_h, cos_o, cos_i = n @ h, n[..., 2], n @ wi

        def bulk(c):
            a = np.minimum(c, 1 - 1e-12) / np.sqrt(1 - np.minimum(c, 1 - 1e-12)**2) / alpha
            return np.where(a > 30, 0, np.exp(-np.minimum(a, 30)**2) / (a * 2 * math.sqrt(math.pi)) - 0.5 * erfc(a))
        erfc = np.vectorize(math.erfc)
        d = np.exp(-(1 / cos_h**2 - 1) / alpha**2) / (math.pi * alpha**2 * cos_h**4)
        return (d / (4 * cos_o * (1 + bulk(cos_o) + bulk(cos_i))) * (cos_i > 0)).mean()

    def test_gaussian_slopes_widen_beckmann(self):
        """A map of Gaussian slopes in every pixel whole: one sample of the widened lobe, many points, and the mean over the texels by
        a program of its own. The lobe's slopes are exact then, alpha^2 + 2 C; what differs is in cosines, by some C (1 + tan^2) each
        of four factors, C = 0.01. The points are 192 x 1500 of a relative variance below 2: 5 standard errors are 1.3 %."""
        alpha, c, n = 0.15, 0.01, 128
        frequency = np.hypot(*np.meshgrid(*2 * [np.fft.fftfreq(n) * n]))
        smooth = [np.fft.ifft2(np.fft.fft2(p) * ((frequency > 2) & (frequency < 9))).real for p in np.random.default_rng(20).normal(size=(2, n, n))]
        order = [p.ravel().argsort().argsort().reshape(n, n) for p in smooth]
        gauss = np.array([NormalDist(0, math.sqrt(c)).inv_cdf((i + 0.5) / n**2) for i in range(n * n)])
        sx, sy = (gauss[o] for o in order)
        self.texture("n.exr", encode(sx, sy))
        for x in (0.0, 0.5):
            wi = np.array([x, 0.3 * x, 1]) / math.sqrt(1 + 1.09 * x * x)
            light = [{"type": "directional", "direction": wi.tolist()}]
            exact, alone = self.every_texel(sx, sy, alpha, wi), self.every_texel(np.zeros((1, 1)), np.zeros((1, 1)), alpha, wi)

            def seen(samples, how):
                metal = {"material": "musurf.microfacet", "ndf": "beckmann", "alpha": alpha, "fresnel": "none",
                         "normal_map": {"file": "n.exr", "scale": [900, 900], "filter": how}}
                return self.sunny(metal, samples=samples, size=(16, 12), light=light, camera=self.ABOVE, plain=True).mean()
            points, lobe = seen(1500, "none"), seen(1, "covariance")
            self.assertLess(abs(points / exact - 1), 0.013, x)
            self.assertLess(abs(lobe / exact - 1), 4 * c * (1 + x * x), x)
            self.assertGreater(abs(alone / exact - 1), 0.15, x)

    def test_few_samples(self):
        """From the side, by paths, with a mean slope of the material's own: 4 filtered samples are less than half as far from the
        truth as 4 points, which 16 times as many should be; of 100, each of which sees less, none is farther."""
        rng = np.random.default_rng(4)
        self.texture("n.exr", encode(*rng.normal(size=(2, 64, 64)) * 0.4))

        def seen(samples, how, seed=0):
            metal = self.metal(ndf="beckmann", alpha=0.1, tilt=[0.1, -0.05], normal_map={"file": "n.exr", "scale": [800, 800], "filter": how})
            return self.picture(metal, "--seed", str(seed), samples=samples, size=(24, 18), shape="rectangle", transform=[{"scale": 20}])
        truth = seen(700, "none", 9)

        def off(samples, how):
            return math.sqrt(((seen(samples, how) - truth)**2).mean())
        self.assertLess(off(4, "covariance"), 0.5 * off(4, "none"))
        self.assertLess(off(100, "covariance"), 1.1 * off(100, "none"))


class Previews(Maps):
    def setUp(self):
        """A small sky: little to filter."""
        super().setUp()
        x, y = np.meshgrid(np.arange(64) / 64, np.arange(32) / 32)
        sky = {c: 0.1 + (1 - y)**2 + 3 * np.exp(-((x - 0.3)**2 + (y - a)**2) / 0.003) for c, a in zip("RGB", (0.2, 0.3, 0.4))}
        self.texture("sky.exr", sky)

    def seen(self, by, normal_map, samples=4, ndf="ggx", alpha=0.1, **item):
        def change(scene):
            scene["lights"] = [{"type": "environment", "image": "sky.exr"}]
            scene["integrator"] = {"samples": samples, "depth": 1, "by": by}
        metal = self.metal(ndf=ndf, alpha=alpha)
        return self.picture(metal | ({"normal_map": normal_map} if normal_map else {}), size=(40, 30), change=change, **(item or {"shape": "sphere"}))

    def test_all_take_it(self):
        self.texture("n.exr", encode(*waves(64)))
        near = {"file": "n.exr", "scale": [2, 1], "filter": "none"}
        truth = self.seen("path", near, 100)
        distance = {}
        for by in ("split", "bent-normal", "major-axis", "lobe", "filtered"):
            distance[by] = flip(np.moveaxis(truth, 0, -1), np.moveaxis(self.seen(by, near), 0, -1))
        without = flip(np.moveaxis(truth, 0, -1), np.moveaxis(self.seen("lobe", None), 0, -1))
        for by, d in distance.items():
            self.assertLess(d, 0.5 * without, distance)
        self.assertEqual(min(distance, key=distance.get), "lobe", distance)
        mirror = self.seen("path", near, 32, alpha=0)  # which looks at points
        self.assertLess(flip(np.moveaxis(mirror, 0, -1), np.moveaxis(self.seen("lobe", near | {"filter": "covariance"}, alpha=0), 0, -1)), 0.5 * without)

    def test_lobe_from_afar(self):
        """One sample of a plate, 100 texels a pixel: less than a third as far from the truth as one that looks at a point."""
        rng = np.random.default_rng(5)
        self.texture("n.exr", encode(*rng.normal(size=(2, 64, 64)) * 0.4))
        far, plate = {"file": "n.exr", "scale": [800, 800]}, {"shape": "rectangle", "transform": [{"scale": 20}], "ndf": "beckmann"}
        truth = self.seen("path", far | {"filter": "none"}, 100, **plate)
        widened, turned = (np.square(self.seen("lobe", m, 1, **plate) - truth).mean() for m in (far, far | {"filter": "none"}))
        self.assertLess(math.sqrt(widened), math.sqrt(turned) / 3)


class Refusals(Maps):
    def test_bad_input(self):
        flat = encode(np.zeros((2, 2)), np.zeros((2, 2)))
        bad = {c: p.copy() for c, p in flat.items()}
        bad["G"][1, 0] = np.nan
        inward = {c: p.copy() for c, p in flat.items()}
        inward["B"][0, 1] = -0.5
        for name, planes in (("flat.exr", flat), ("grey.exr", {"Y": flat["B"]}), ("nan.exr", bad), ("in.exr", inward)):
            self.texture(name, planes)
        for map, words in (({"file": "missing.exr"}, ("missing.exr", "no such file")), ({"file": "grey.exr"}, ("too few channels", "3 are needed")),
                           ({"file": "nan.exr"}, ("pixel 0 of line 1", "finite")), ({"file": "in.exr"}, ("pixel 1 of line 0", "points outward")),
                           ({}, ("file", "missing")), ({"file": "flat.exr", "strenght": 1}, ("strenght", "strength")),
                           ({"file": "flat.exr", "y": "left"}, ("up, down",)), ({"file": "flat.exr", "wrap": "mirror"}, ("wrong side",)),
                           ({"file": "flat.exr", "channels": ["R", "Q"]}, ("no channel", "Q")), ("flat.exr", ("normal_map",))):
            with self.subTest(map=map):
                self.refused(self.metal(normal_map=map), *words)
        (self.folder / "m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.texture("lean.exr", encode(*waves(4)))
        self.refused(self.metal(normal_map={"file": "lean.exr"}), "normal_map", "texture coordinates", mesh="m", file="m.obj")
        done = musurf("eval", stdin=[{"material": self.metal(normal_map={"file": str(self.folder / "lean.exr")}), "wo": [0, 0, 1]}])
        self.assertIn("vary over the surface", done.out)

    def test_floats_that_look_encoded(self):
        self.texture("n.exr", {c: (p + 1) / 2 for c, p in encode(*waves(16, 0.1)).items()})
        done = musurf("render", self.scene(self.metal(normal_map={"file": "n.exr"})), "--explain")
        self.assertIn('"range": [-1, 1]', done.err)


if __name__ == "__main__":
    sys.exit(unittest.main())
