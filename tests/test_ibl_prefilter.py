#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf ibl prefilter`: levels against the kernel integrated over every pixel, and the mip map as a file, read by tests/exr.py.

The kernel around N towards L, h half way: D(h) / 4 (N.L), normalised over the directions above N's horizon: drawing h from
D cos for a view along N, weighted by N.L.
"""
import math
import pathlib
import tempfile
import unittest

import numpy

import exr
from command import musurf, strict

ROWS = 64


def directions(rows, columns):
    theta = (numpy.arange(rows)[:, None] + 0.5) / rows * math.pi
    phi = 2 * math.pi * (0.5 - (numpy.arange(columns)[None, :] + 0.5) / columns)
    flat = numpy.sin(theta)
    return numpy.stack(numpy.broadcast_arrays(flat * numpy.cos(phi), flat * numpy.sin(phi), numpy.cos(theta)), -1)


def areas(rows, columns):
    edges = numpy.cos(numpy.arange(rows + 1) / rows * math.pi)
    return numpy.repeat((edges[:-1] - edges[1:])[:, None] * 2 * math.pi / columns, columns, 1)


def sky(w):
    """Broad lights over a ground, none alike in the three channels, so that no mirror or turn of the sphere goes unseen."""
    def glow(x, y, z, sharp):
        axis = numpy.array([x, y, z]) / math.sqrt(x * x + y * y + z * z)
        return numpy.exp(sharp * (w @ axis - 1))
    return {"R": 0.2 + 5 * glow(1, 0.4, 0.3, 12), "G": 0.1 + 3 * glow(-0.2, 1, 0.8, 8) + glow(0, -1, -0.5, 20),
            "B": 0.3 + 2 * glow(0.1, -0.2, 1, 15) + 0.2 * w[..., 0]}


def kernel(alpha, n, w):
    cosine = w @ n
    half = (cosine + 1) / 2  # (n.h)²
    d = 1 / (half + (1 - half) / alpha**2) ** 2  # D up to a factor
    return numpy.where(cosine > 0, d * cosine, 0)


def level_count(rows):
    levels = 2
    while rows >> levels >= 8:
        levels += 1
    return levels


class Prefilter(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.env, self.out = (pathlib.Path(self.folder.name, name) for name in ("env.exr", "out.exr"))

    def make(self, channels, *options):
        exr.write(self.env, channels)
        return self.again(*options)

    def again(self, *options):
        done = musurf("ibl", "prefilter", self.env, "-o", self.out, *options)
        self.assertEqual((done.returncode, done.out), (0, ""), done.err)
        return done.err

    def test_names_of_files(self):
        exr.write(self.env, {name: numpy.ones((8, 16)) for name in "RGB"})
        done = musurf("ibl", "prefilter", self.env, "-o", self.out.with_suffix(".png"))
        self.assertEqual(done.returncode, 2)
        self.assertIn("must be a name that ends in .exr", done.err)
        self.assertFalse(self.out.with_suffix(".png").exists())

    def test_constant(self):
        """Weights sum to 1 within the roundings of some 2^-24 in each of two interpolations and the sum."""
        self.make({name: numpy.full((50, 90), value) for name, value in (("R", 0.25), ("G", 3.0), ("B", 1e-3))}, "--samples", 64)
        header, levels = exr.read_mip(self.out)
        self.assertEqual(levels[0]["R"].shape, (50, 100))
        for level in levels:
            for name, value in (("R", 0.25), ("G", 3.0), ("B", 1e-3)):
                self.assertLess(numpy.max(numpy.abs(level[name] / numpy.float32(value) - 1)), 2e-6)
        self.assertEqual(header["musurfLevels"], level_count(50))
        self.assertEqual(header["envmap"], b"\0")

    def test_levels_are_the_kernel(self):
        """Against the sum over all pixels' middles. Interpolating between pixels p apart adds the variance p²/6 per axis, which
        takes p² s / 6 off a light of sharpness s: 0.5 % for s = 12, p = pi/64; the sharper one is a third of its channel. Added
        is 0.1 % for what 4096 points know of such a sky (0.02 % at the rougher levels, and a quarter of it with four times as
        many, as measured)."""
        w = directions(ROWS, 2 * ROWS)
        fine = sky(w)
        self.make(fine, "--samples", 4096)
        header, levels = exr.read_mip(self.out)
        count = header["musurfLevels"]
        for name in "RGB":
            numpy.testing.assert_allclose(levels[0][name], fine[name], rtol=1e-6)
        worst = 0
        for number in range(1, count):
            alpha = (number / (count - 1)) ** 2
            n = directions(*levels[number]["R"].shape)
            for row in range(0, n.shape[0], max(1, n.shape[0] // 6)):
                for column in range(0, n.shape[1], max(1, n.shape[1] // 6)):
                    k = kernel(alpha, n[row, column], w) * areas(ROWS, 2 * ROWS)
                    for name in "RGB":
                        right = (k * fine[name]).sum() / k.sum()
                        worst = max(worst, abs(levels[number][name][row, column] - right) / fine[name].max())
        self.assertLess(worst, 0.006)

    def test_cube_maps(self):
        """OpenEXR's faces: +x, -x, +y, -y, +z, -z with y up and z the middle of its latitude-longitude images, their corners
        as exrenvmap writes them; pixels on the edges. Level 0 is the average over its pixels of what is interpolated between
        those of a face, p = 2/63 apart at most: off by p²/8 times the second derivative along either side, 0.3 % of the height
        of a light of sharpness 12 and 0.4 % for 15; 3 x 3 places of a pixel of a half of that add less than a tenth of this."""
        side = 64
        p = numpy.linspace(-1, 1, side)
        right, down, one = *numpy.meshgrid(p, p), numpy.ones((side, side))
        # in the frame of musurf: x, y, z of each face by the place to the right and down
        faces = [(right, one, -down), (-right, -one, -down), (-down, right, one), (down, right, -one), (one, -right, -down),
                 (-one, right, -down)]
        w = numpy.concatenate([numpy.stack(face, -1) / numpy.sqrt(1 + right**2 + down**2)[..., None] for face in faces])
        self.make(sky(w), "--height", 48, "--samples", 16)
        first = exr.read_mip(self.out)[1][0]
        fine, weight = sky(directions(8 * 48, 8 * 96)), areas(8 * 48, 8 * 96)

        def pooled(values):
            return values.reshape(48, 8, 96, 8).sum((1, 3))
        for name in "RGB":
            right = pooled(fine[name] * weight) / pooled(weight)
            self.assertLess(numpy.max(numpy.abs(first[name] - right)) / fine[name].max(), 0.0045)

    def test_progress_for_programs(self):
        """Every line is JSON: rising fractions, a warning of what was clamped, the end; then that it is there already. Without, text."""
        fine = dict(sky(directions(64, 128)))
        fine["R"][3, 5] = -1
        lines = [strict(line) for line in self.make(fine, "--samples", 4096, "--threads", 1, "--progress=json").splitlines()]
        events = [line["event"] for line in lines]
        self.assertEqual((events[0], set(events[1:-1]), events[-1]), ("warning", {"progress"}, "done"))
        fractions = [line["fraction"] for line in lines if line["event"] == "progress"]
        self.assertTrue(fractions == sorted(fractions) and 0 < fractions[0] and fractions[-1] <= 1, fractions)
        self.assertEqual((lines[-1]["file"], lines[-1]["samples"]), (str(self.out), 4096))
        self.assertEqual([strict(line)["event"] for line in self.again("--samples", 4096, "--progress=json").splitlines()], ["kept"])
        self.assertEqual(len(self.again("--samples", 16, "--progress=none").splitlines()), 2)

    def test_any_number_of_threads(self):
        fine = sky(directions(40, 80))
        files = []
        for threads in (1, 2, 3):
            self.out.unlink(missing_ok=True)
            self.make(fine, "--threads", threads, "--samples", 32)
            files.append(self.out.read_bytes())
        self.assertEqual(files[0], files[1])
        self.assertEqual(files[0], files[2])

    def test_made_once(self):
        fine = sky(directions(16, 32))
        self.assertNotIn("already", self.make(fine, "--samples", 32))
        before = self.out.stat().st_mtime_ns
        self.assertIn("already", self.again("--samples", 32))
        self.assertEqual(self.out.stat().st_mtime_ns, before)
        self.assertNotIn("already", self.again("--samples", 33))
        self.assertNotIn("already", self.make({**fine, "R": fine["R"] * 2}, "--samples", 33))
        self.out.write_bytes(b"not an image")
        self.assertNotIn("already", self.again("--samples", 33))
        self.assertEqual(exr.read_mip(self.out)[1][0]["G"].shape, (16, 32))

    def test_smaller_than_the_image(self):
        """Level 0 is the average by solid angle: what the sphere holds is kept."""
        fine = sky(directions(60, 130))
        self.make(fine, "--height", 16, "--samples", 16)
        first = exr.read_mip(self.out)[1][0]
        self.assertEqual(first["R"].shape, (16, 32))
        for name in "RGB":
            self.assertAlmostEqual((first[name] * areas(16, 32)).sum() / (fine[name] * areas(60, 130)).sum(), 1, delta=1e-6)

    def test_refusals(self):
        exr.write(self.env, sky(directions(16, 32)))
        for arguments in ((), (self.env,), ("-o", self.out), (self.env, "-o", self.out, "--samples", 1),
                          (self.env, self.env, "-o", self.out), (self.out, "-o", self.out), (self.env, "-o", "/nowhere/a.exr")):
            self.assertEqual(musurf("ibl", "prefilter", *arguments).returncode, 2, arguments)
        exr.write(self.env, sky(directions(4, 8)))
        self.assertIn("too few", musurf("ibl", "prefilter", self.env, "-o", self.out).err)
        self.assertFalse(self.out.exists())

    def test_the_image_stays(self):
        """An environment is not replaced by what is made of it, whatever the name that it is reached by."""
        exr.write(self.env, sky(directions(16, 32)))
        before = self.env.read_bytes()
        self.out.symlink_to(self.env)
        for name in (self.env, self.out):
            done = musurf("ibl", "prefilter", self.env, "-o", name, "--samples", 16)
            self.assertEqual((done.returncode, self.env.read_bytes() == before), (2, True), done.err)
            self.assertIn("would replace", done.err)


if __name__ == "__main__":
    unittest.main()
