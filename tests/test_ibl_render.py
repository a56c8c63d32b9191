#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf render --integrator`: techniques of image-based lighting against albedos, against each other, turned, and against paths."""
import json
import math
import pathlib
import tempfile
import unittest

import numpy

import exr
from command import answers, microfacet, musurf
from picture_flip import flip

TECHNIQUES = ("split", "bent-normal", "major-axis", "lobe", "filtered")
STUDIO = {"type": "studio", "scale": [1, 0.9, 0.8]}


def ggx(linear, eta, **more):
    """Section 4.1: alpha_lin and eta."""
    return microfacet(ndf="ggx", alpha_x=linear**2 * (1 + eta), alpha_y=linear**2 * (1 - eta), **more)


class Render(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def render(self, by, objects, light, view, size=16, height=2.2, samples=1, radius=0.5, good=True, options=(), integrator={}):
        scene = {"camera": {"type": "orthographic", "position": [5 * x for x in view], "height": height, "up": [0, 0, 1]},
                 "film": {"width": size, "height": size, "pixels": "float", "filter": "box", "radius": radius},
                 "integrator": {"depth": 1, "samples": samples, **integrator}, "objects": objects, "lights": [light]}
        file, out = pathlib.Path(self.folder.name, "scene.json"), pathlib.Path(self.folder.name, "out.exr")
        file.write_text(json.dumps(scene))
        done = musurf("render", file, "-o", out, "--integrator", by, "--quiet", *options)
        if not good:
            return done
        self.assertEqual(done.returncode, 0, done.err)
        channels = exr.read(out)[1]
        self.albedo = numpy.stack([channels["albedo." + c] for c in "RGB"], -1).astype(float)
        return numpy.stack([channels[c] for c in "RGB"], -1).astype(float)

    def test_even_light_gives_the_albedo(self):
        """To 1e-3 and 5 standard errors of `musurf ibl albedo`, whose views these are; of a rejecting sampler (beckmann, gtr) the
        renderer's own table has errors too: 2e7 samples on 64 nodes are 2e5 each, whose weights in [0, 1] deviate by 1/2 at most:
        1e-3, of which 2 more are allowed."""
        rows, columns = 3, 3
        for material, most in ((ggx(0.4, 0.8), 1e-3), (ggx(0.7, 0, fresnel={"conductor": "Cu"}), 1e-3),
                               (ggx(0.8, 0.9, rotation=0.6, fresnel={"dielectric": 1.5}), 1e-3),
                               (microfacet(ndf="gtr", alpha=0.3, gamma=1.4), 3e-3)):
            done = musurf("ibl", "albedo", "--rows", rows, "--columns", columns, "--samples", 1 << 14, stdin=[{"material": material}])
            table = answers(done)[0]
            first = material.get("alpha_x") == 0.4**2 * 1.8
            for row, column in ((0, 1), (1, 2))[:2 if first else 1]:
                z, phi = table["cosines"][row], table["azimuths"][column]
                view = [math.sqrt(1 - z * z) * math.cos(phi), math.sqrt(1 - z * z) * math.sin(phi), z]
                plate = [{"shape": "rectangle", "size": [9, 9], "material": material}]
                for by in TECHNIQUES if first and row else ("lobe",):
                    seen = self.render(by, plate, {"type": "constant"}, view, size=2, height=0.1)[0, 0]
                    off = numpy.abs(seen - table["albedo"][rows * row + column]).max()
                    self.assertLess(off, most + 5 * table["deviation"], (by, material, z, phi))

    def test_turned_together(self):
        """Object, light and view a quarter about z: squares turn into themselves, and so do taps; what is left is rounding of
        directions, 1e-6 of a texel's 0.006 or more, and of sums: 1e-3 of the radiance at the studio's steepest edges is ample. A
        light that is not turned along makes another picture."""
        material = ggx(0.5, 0.8)
        view = [math.cos(0.3) * 0.9, math.sin(0.3) * 0.9, math.sqrt(1 - 0.81)]
        turned = [-view[1], view[0], view[2]]
        for by in ("bent-normal", "lobe"):
            before = self.render(by, [{"shape": "sphere", "radius": 1, "material": material}], STUDIO, view)
            ball = {"shape": "sphere", "radius": 1, "material": material, "transform": [{"rotate": [0, 0, 1, 90]}]}
            after = self.render(by, [ball], dict(STUDIO, rotation=90), turned)
            inside = before.mean(-1) > 0
            self.assertLess(numpy.quantile(numpy.abs(after - before)[inside], 0.9), 1e-3)
        other = self.render(by, [ball], STUDIO, turned)
        self.assertGreater(numpy.abs(other - before)[inside].mean(), 0.02)

    def test_a_varying_map_is_the_constant_one(self):
        """A roughness in a slot, of a formula that is constant, takes the way over M of each hit. The table of albedos is drawn again,
        each within 1e-3; the reads, radiance over albedo, are the same but for M's rounding in float, at most 1e-4 of a level."""
        view = [0.3, -0.9, 0.3]
        balls = [[{"shape": "sphere", "radius": 1, "material": microfacet(alpha_x=x, alpha_y=0.1, rotation=0.4)}]
                 for x in (0.4, {"expression": "0.4 + 0*u"})]
        for by in ("lobe",):
            pictures = [(self.render(by, ball, STUDIO, view), self.albedo) for ball in balls]
            self.assertLess(numpy.abs(pictures[0][1] - pictures[1][1]).max(), 2e-3)
            inside = pictures[0][1].min(-1) > 0.1
            constant, varying = (rgb[inside] / albedo[inside] for rgb, albedo in pictures)
            self.assertGreater(inside.sum(), 50)
            self.assertLess(numpy.abs(constant - varying).max(), 1e-3 * constant.max())

    def test_a_mirror_under_a_varying_map(self):
        """No M makes a mirror rough or dark: the same as without, in even light all of it."""
        for mirror in ({"ndf": "flat"}, {"alpha": 0}):
            ball = [{"shape": "sphere", "radius": 1, "material": microfacet(jacobian={"u": "u", "v": "v + 2*u^5"}, **mirror)}]
            for by in ("split", "lobe"):
                seen = self.render(by, ball, {"type": "constant"}, [0.3, -0.9, 0.3], size=8)
                self.assertLess(numpy.abs(seen - 1).max(), 1e-5, (mirror, by))

    def test_usual_reads(self):
        """Where nobody says how many: 16, and of lobes the 10 that take as long."""
        ball = [{"shape": "sphere", "radius": 1, "material": ggx(0.4, 0.8)}]
        for by, usual in (("major-axis", 16), ("lobe", 10)):
            left, said, other = (self.render(by, ball, STUDIO, [0, -1, 0.2], size=8, integrator=more) for more in ({}, {"reads": usual}, {"reads": 26 - usual}))
            self.assertTrue((left == said).all())
            self.assertGreater(numpy.abs(left - other).max(), 0)

    def test_against_paths(self):
        """A sphere of Figure 19: mean FLIP of the major axis is below that of the bent normal for alpha_lin < 0.5, and of reads all over
        the lobe below half of the major axis'; as many as each pixel needs are no worse than a fixed number by more than a
        tenth. 256 paths a pixel leave noise that all share."""
        ball = [{"shape": "sphere", "radius": 1, "material": ggx(0.3, 0.75)}]
        shot = lambda by, samples, *options: self.render(by, ball, STUDIO, [0, -0.98, 0.2], size=64, samples=samples, options=options)
        truth = shot("path", 256)
        axis, bent, lobe = (flip(truth, shot(by, 16)) for by in ("major-axis", "bent-normal", "lobe"))
        chosen = flip(truth, shot("lobe", 16, "--reads", "auto"))
        self.assertLess(axis, bent)
        self.assertLess(lobe, axis / 2)
        self.assertLess(chosen, 1.1 * lobe)
        self.assertLess(abs(shot("lobe", 16).mean() / truth.mean() - 1), 0.1)

    def test_tilt(self):
        """A mean slope turns the lobe by twice its angle: reads that leave it out, as "means": false has it and the major axis does,
        see another part of the world; those that follow it are nearer to paths by half at least."""
        material = microfacet(ndf="ggx", alpha_x=0.1, alpha_y=0.03, tilt=[0.3, 0.15])
        ball = [{"shape": "sphere", "radius": 1, "material": material}]
        shot = lambda by, samples, **more: self.render(by, ball, STUDIO, [0, -0.98, 0.2], size=32, samples=samples, integrator=more)
        truth = shot("path", 256)
        followed, left_out, axis = flip(truth, shot("lobe", 4)), flip(truth, shot("lobe", 4, means=False)), flip(truth, shot("major-axis", 4))
        self.assertLess(followed, left_out / 2)
        self.assertLess(followed, axis / 2)

    def test_what_it_does_not_light(self):
        ball = lambda material: [{"shape": "sphere", "radius": 1, "material": material}]
        for objects, light, word in ((ball({"material": "template.lambert"}), STUDIO, "microsurface"),
                                     (ball(microfacet(fresnel={"dielectric": 1.5}, transmission=True)), STUDIO, "reflect"),
                                     (ball(microfacet(ndf="gtr", gamma={"expression": "1 + u"})), STUDIO, "blended"),
                                     (ball(microfacet(alpha=0.2)), {"type": "directional"}, "around")):
            done = self.render("major-axis", objects, light, [0, -0.98, 0.2], good=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(word, done.err)


if __name__ == "__main__":
    unittest.main()
