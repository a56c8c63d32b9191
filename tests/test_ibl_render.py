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
from test_ibl_albedo import NDFS, SKEW, quadrature, tables

# Samples a pixel of 16 x 16 for which tables of albedos are made: of what is mirrored, of what is not; fewer are integrated one by one.
MANY, MORE = 20, 48
TECHNIQUES = ("split", "bent-normal", "major-axis", "lobe", "filtered")
STUDIO = {"type": "studio", "scale": [1, 0.9, 0.8]}


FLAT = [[2, 0], [0, 0.5]]
TILTED = microfacet(ndf="ggx", alpha=0.3, tilt=[0.4, 0.2])
NOISY = microfacet(ndf="tabulated", tilt=[0.2, -0.1], fresnel={"conductor": "Cu"}, histogram={
    "bounds": [-0.4, 0.4, -0.4, 0.4], "weights": numpy.random.default_rng(7).poisson(2, (8, 8)).tolist()})


def by_slopes(material, wo):
    """E of a tilted GGX or a histogram, summed over slopes before M: in double, by midpoints, of asinh of the slope in units of alpha, to
    160, and its azimuth; or of cells. Half as many along each axis leave four times the error where it is smooth (Euler and Maclaurin): a third of
    the difference is taken off, and is more than what is left."""
    sums = []
    for count in (48, 96):
        if material["ndf"] == "ggx":
            t, turn = numpy.meshgrid(7 * (numpy.arange(count) + 0.5) / count, 2 * math.pi * (numpy.arange(count) + 0.5) / count)
            r = material["alpha"] * numpy.sinh(t)
            x, y, area = r * numpy.cos(turn), r * numpy.sin(turn), r * material["alpha"] * numpy.cosh(t) * 14 * math.pi / count**2
        else:
            low, high = material["histogram"]["bounds"][:2]
            x, y = numpy.meshgrid(*[low + (numpy.arange(count) + 0.5) * (high - low) / count] * 2)
            area = numpy.full_like(x, ((high - low) / count)**2)
        m = numpy.array(material["transform"], dtype=float)
        slope = numpy.linalg.inv(m).T @ numpy.stack([(x + material["tilt"][0]).ravel(), (y + material["tilt"][1]).ravel()])
        n = numpy.stack([-slope[0], -slope[1], numpy.ones(slope.shape[1])], -1)
        n /= numpy.linalg.norm(n, axis=-1)[:, None]
        facing = n @ wo
        wi = 2 * facing[:, None] * n - wo
        up = (facing > 0) & (wi[:, 2] > 0)
        f = numpy.array([answer["f"] for answer in answers(musurf("eval", stdin=[{"material": material, "wo": list(wo), "wi": list(w)} for w in wi[up]]))])
        sums.append((f * (wi[:, 2] * 4 * facing * n[:, 2]**3 * area.ravel())[up, None]).sum(0) / abs(numpy.linalg.det(m)))
    less = (sums[0] - sums[1]) / 3
    return sums[1] - less, numpy.abs(less).max()


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
        done = musurf("render", file, "-o", out, *(("--integrator", by) if by else ()), "--quiet", *options)
        if not good:
            return done
        self.assertEqual(done.returncode, 0, done.err)
        channels = exr.read(out)[1]
        self.albedo = numpy.stack([channels["albedo." + c] for c in "RGB"], -1).astype(float)
        return numpy.stack([channels[c] for c in "RGB"], -1).astype(float)

    def even(self, material, by="lobe", **more):
        """A sphere in even light; with the views of its pixels in the frame of the surface, whose tangent points east."""
        toward = numpy.array([0.6, -0.7, 0.3874])
        toward /= numpy.linalg.norm(toward)
        seen = self.render(by, [{"shape": "sphere", "radius": 1, "material": material}], {"type": "constant"}, toward, height=2, radius=1e-3, **more)
        up = numpy.array([0, 0, 1]) - toward[2] * toward
        up /= numpy.linalg.norm(up)
        row, column = numpy.mgrid[:16, :16]
        x, y = (column + 0.5) / 8 - 1, 1 - (row + 0.5) / 8
        n = x[..., None] * numpy.cross(up, toward) + y[..., None] * up + numpy.sqrt(numpy.maximum(1 - x * x - y * y, 0))[..., None] * toward
        east = numpy.cross([0, 0, 1], n)
        east /= numpy.linalg.norm(east, axis=-1)[..., None]
        return seen, numpy.stack([east @ toward, numpy.cross(n, east) @ toward, n @ toward], -1)

    def test_even_light_gives_the_albedo(self):
        """To 1e-3, for every distribution under a skewed M, steep or near the horizon in turn, and the 1e-4 that quadrature of what `musurf eval`
        says is off at slope roughnesses of 0.2 and more (test_ibl_albedo.py). All techniques give the same."""
        far = []
        for i, material in enumerate([microfacet(transform=SKEW, **ndf) for ndf in NDFS] + [
                microfacet(ndf="beckmann", alpha=0.6, multiple_scattering="compensated", fresnel={"conductor": "Au"}),
                ggx(0.8, 0.5, rotation=0.6, fresnel={"dielectric": 1.5}, masking="separable")]):
            seen, wo = self.even(material, samples=MANY)
            place = ((6, 9), (12, 2))[i % 2]
            self.assertLess(numpy.abs(seen[place] - quadrature(material, list(wo[place]))).max(), 1.1e-3, (material, wo[place]))
            far.append(abs(seen[6, 9, 0] - seen[12, 2, 0]))
        self.assertGreater(max(far), 0.1)  # views differ
        for by in TECHNIQUES:
            self.assertLess(numpy.abs(self.even(material, by, samples=MANY)[0] - seen).max(), 1e-5)

    def test_even_light_on_tilts_and_histograms(self):
        """Under an M of 4:1, where f jumps and albedos have creases, from above and down to the rim: to 1e-3 and what sums over slopes are
        off, as `by_slopes` says."""
        for material in (TILTED, NOISY):
            seen, wo = self.even({**material, "transform": FLAT}, samples=MORE)
            few = self.even({**material, "transform": FLAT})[0]
            self.assertTrue(1e-6 < numpy.abs(seen - few).max() < 1.5e-3)  # by a table, and one by one
            for place in ((6, 9), (12, 2), (2, 2), (13, 2)):
                right, off = by_slopes({**material, "transform": FLAT}, wo[place])
                self.assertLess(off, 4e-4)
                self.assertLess(numpy.abs(seen[place] - right).max(), 1e-3 + off, (material["ndf"], place))

    def test_even_light_on_what_is_nearly_a_mirror(self):
        """Smoother than directions in float are dense: as a mirror of its mean slope, sigma/cos G2 with Smith's Lambda = sigma/cos - 1 of both
        directions, at least 0; to 1e-3 and 10 alpha, for masking changes by no more there."""
        for alpha, tilt in ((1e-12, (0, 0)), (1e-8, (0, 0)), (1e-6, (0.1, 0.2)), (9e-5, (0.1, 0.2))):
            seen, wo = self.even(microfacet(ndf="ggx", alpha=alpha, tilt=list(tilt)))
            m = numpy.array([-tilt[0], -tilt[1], 1])
            for place in ((6, 9), (8, 5)):
                o = wo[place]
                i = 2 * (m @ o) / (m @ m) * m - o
                over = [(m @ w) / w[2] for w in (o, i)]
                right = over[0] / (1 + sum(max(0, x - 1) for x in over))
                self.assertLess(numpy.abs(seen[place] - right).max(), 1e-3 + 10 * alpha, (alpha, place))

    def test_even_light_on_a_leaning_mirror(self):
        """In the same closed form, which has creases where either direction begins to be masked: everywhere on the sphere to 1e-3."""
        seen, wo = self.even(microfacet(ndf="ggx", alpha=0, tilt=[0.3, 0.2]), samples=MORE)
        m = numpy.array([-0.3, -0.2, 1])
        shown = (wo[..., 2] > 0.02) & (abs(numpy.linalg.norm(wo, axis=-1) - 1) < 1e-6)  # and on the sphere
        over_o = wo @ m / wo[..., 2]
        i = 2 * (wo @ m / (m @ m))[..., None] * m - wo
        over_i = numpy.where(i[..., 2] > 0, i @ m / i[..., 2], numpy.inf)
        right = numpy.where(over_o > 0, over_o / (1 + numpy.maximum(0, over_o - 1) + numpy.maximum(0, over_i - 1)), 0)
        self.assertGreater(numpy.ptp(right[shown]), 0.5)
        self.assertLess(numpy.abs(seen[shown] - right[shown][:, None]).max(), 1e-3)

    def test_even_light_on_a_little_tilt(self):
        """One that changes f by less than a hundredth: what is seen from opposite sides differs by some 2e-3 nevertheless."""
        material = microfacet(ndf="ggx", alpha=0.3, tilt=[0.0006, 0.0004], transform=[[1, 0], [0, 1]])
        seen, wo = self.even(material)
        for place in ((0, 9), (7, 15)):
            right, off = by_slopes(material, wo[place])
            self.assertLess(off, 4e-4)
            self.assertLess(numpy.abs(seen[place] - right).max(), 1e-3 + off, place)

    def test_even_light_where_m_turns_tilts(self):
        """M of each point, which shears what leans: no table over the lobe's axes has that."""
        z = 0.4
        view = [math.sqrt(1 - z * z), 0, z]
        for material in (TILTED, NOISY):
            plate = [{"shape": "rectangle", "size": [2, 2], "material": {**material, "transform": {"expression": ["1.5", "u", "-u", "0.6"]}}}]
            seen = self.render("lobe", plate, {"type": "constant"}, view, size=4, height=2 * z, radius=1e-3)
            values = []
            for row in (0, 3):
                u = (1 - (1 - (row + 0.5) / 2)) / 2
                right, off = by_slopes({**material, "transform": [[1.5, u], [-u, 0.6]]}, view)
                self.assertLess(off, 4e-4)
                self.assertLess(numpy.abs(seen[row, 2] - right).max(), 1e-3 + off, (material["ndf"], row))
                values.append(right)
            self.assertGreater(abs(values[0] - values[1]).max(), 0.02)

    def test_even_light_of_walks_where_m_turns_tilts(self):
        """A random walk, which is told by walks: to 1e-3, and 4 standard errors of a million of its own samples; 16 comparisons. As if M turned
        the lobe it would be off by 0.01 and more."""
        z = 0.5
        view = [math.sqrt(1 - z * z), 0, z]
        for material in (TILTED, NOISY):
            material = {**material, "multiple_scattering": "random_walk", "fresnel": {"schlick": [0.95, 0.6, 0.2]}}
            plate = [{"shape": "rectangle", "size": [2, 2], "material": {**material, "transform": {"expression": ["1.5", "u", "-u", "0.6"]}}}]
            seen = self.render("lobe", plate, {"type": "constant"}, view, size=4, height=2 * z, radius=1e-3)
            u = [(1 - (1 - (row + 0.5) / 2)) / 2 for row in (0, 3)]
            found = tables([{**material, "transform": [[1.5, at], [-at, 0.6]]} for at in u], "--rows", 1, "--columns", 1, "--samples", 1 << 20)
            for row, table in zip((0, 3), found):
                self.assertLess(table["deviation"], 5e-4)
                self.assertLess(numpy.abs(seen[row, 2] - table["albedo"][0]).max(), 1e-3 + 4 * table["deviation"], (material["ndf"], row))

    def test_even_light_where_m_varies(self):
        """A plate whose roughness along x grows with u, seen along x: image rows are places. 1e-3 and quadrature's 1e-4, between nodes of
        sigma too; of a distribution that is drawn by rejection."""
        z = 0.6
        plate = lambda rough: [{"shape": "rectangle", "size": [2, 2], "material": microfacet(ndf="beckmann", alpha_x=rough, alpha_y=0.25)}]
        seen = self.render("lobe", plate({"expression": "0.2 + 0.6*u"}), {"type": "constant"}, [0.8, 0, z], height=2 * z, radius=1e-3, samples=MANY)
        for row in (3, 13):
            x = -(1 - (row + 0.5) / 8)
            material = microfacet(ndf="beckmann", alpha_x=0.2 + 0.6 * (x + 1) / 2, alpha_y=0.25)
            right = quadrature(material, [0.8, 0, z])
            self.assertLess(numpy.abs(seen[row, 8] - right).max(), 1.1e-3, row)
        self.assertGreater(abs(seen[3, 8, 0] - seen[13, 8, 0]), 5e-3)

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
            pictures = [(self.render(by, ball, STUDIO, view, samples=MANY), self.albedo) for ball in balls]
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
        """Where nobody says how many: 16, and of lobes 6."""
        ball = [{"shape": "sphere", "radius": 1, "material": ggx(0.4, 0.8)}]
        for by, usual in (("major-axis", 16), ("lobe", 6)):
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

    def test_settings_of_other_techniques(self):
        """In a scene that names one; in one that names none, if nobody does."""
        ball = [{"shape": "sphere", "radius": 1, "material": microfacet(alpha=0.2)}]
        refused = lambda asked, **more: self.render(asked, ball, STUDIO, [0, -0.98, 0.2], size=4, good=False, integrator=more)
        for by, key, value in (("path", "k", 1), ("path", "reads", 8), ("lobe", "beta", 2), ("bent-normal", "reads", 8), ("major-axis", "tails", True),
                               ("filtered", "means", False), ("split", "appendix_c", "printed")):
            done = refused(by, by=by, **{key: value})
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"$.integrator.{key}: is of no effect by \"{by}\"", done.err)
        for by, code in (("major-axis", 0), (None, 2)):
            done = refused(by, k=1)
            self.assertEqual(done.returncode, code, done.err)
        self.assertIn("$.integrator.k is of no effect on paths", done.err)
        self.assertEqual(refused("path", by="lobe", tails=False).returncode, 0)  # to compare


if __name__ == "__main__":
    unittest.main()
