#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf surface fit` as a contract: errors that cover, refusals with reasons, materials that the rest accepts.

Gaussian fields, whose slopes are known exactly, are made here by numpy, apart from musurf's generator.
"""
import json
import pathlib
import sys
import tempfile
import unittest

import numpy as np

from command import ROOT, musurf, strict
from test_surface_command import write_exr

sys.path.insert(0, str(ROOT / "scripts"))
import exr  # noqa: E402

N = 256
X, Y = np.meshgrid(np.arange(N), np.arange(N), indexing="ij")


def gaussian(n, correlation, seed, alpha):
    """Heights of autocorrelation exp(-r^2/correlation^2), and the covariance of their facets' slopes."""
    k = 2 * np.pi * np.fft.fftfreq(n)
    a, b = np.meshgrid(k, k, indexing="ij")
    amplitude = np.exp(-(a**2 + b**2) * correlation**2 / 8)
    heights = np.fft.ifft2(np.fft.fft2(np.random.default_rng(seed).standard_normal((n, n))) * amplitude).real

    def covariance(i, j):
        return (amplitude**2 * np.cos(a * i + b * j)).mean()
    # both triangles of a cell: differences along x and along y that share a corner
    same = 2 * (covariance(0, 0) - covariance(1, 0))
    across = covariance(1, -1) - 2 * covariance(1, 0) + covariance(0, 0)
    scale = alpha / np.sqrt(2 * same)
    return heights * scale, np.array([[same, across], [across, same]]) * scale**2


class Fits(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def fit(self, heights, *more, code=0):
        file = self.folder / "h.exr"
        write_exr(file, heights)
        done = musurf("surface", "fit", file, *more)
        self.assertEqual(done.returncode, code, done.err)
        self.assertRegex(done.err, r"^musurf surface fit: [^\n]*\n$" if code else "^$")
        return strict(done.out)

    def test_errors_cover(self):
        """16 open pieces of Gaussian fields, tilted, under a skew: alpha_x, alpha_y, rotation against the truth.

        z of three nearly independent numbers, 16 times: their squares sum to chi^2 of 48, which is within 20.3 and 92.9
        but for one time in ten thousand at either end. Errors come from 36 blocks or more: t of 35 degrees, z^2 is 35/33 wider.
        Another family is likelier than the true one by k, criterion 2 ln k, at most once in k times: behind by 23 once in
        96000, of 6 families and 16 pieces once in 1000.
        A mean slope is heights at the rim over the side: blocks cannot know that rims cancel, and its z is below 1.
        """
        m, tilt = np.array([[1, 0.8], [0, 1.3]]), np.array([0.05, -0.08])
        back = np.linalg.inv(m).T
        z, chosen = [], 0
        for seed in range(501, 517):
            heights, covariance = gaussian(512, 8, seed, 0.3)
            piece = heights[:257, :257] + tilt[0] * np.arange(257)[:, None] + tilt[1] * np.arange(257)
            said = self.fit(piece, "--open", "--transform", ",".join(map(str, m.ravel())))
            best = next(c for c in said["candidates"] if c["candidate"] == "beckmann")
            self.assertEqual((said["verdict"], best["explains"]), ("explained", True))
            self.assertLess(best["behind"], 23)
            chosen += said["material"]["ndf"] == "beckmann"
            self.assertGreaterEqual(said["blocks"], 6)
            values, errors = best["values"], best["errors"]
            size, axes = np.linalg.eigh(back @ covariance @ back.T)
            turn = values["rotation"] - np.arctan2(axes[1, 1], axes[0, 1])
            z.append([(values["alpha_x"] - np.sqrt(2 * size[1])) / errors["alpha_x"],
                      (values["alpha_y"] - np.sqrt(2 * size[0])) / errors["alpha_y"],
                      ((turn + np.pi / 2) % np.pi - np.pi / 2) / errors["rotation"]])
            for k in range(2):
                self.assertLess(abs(values["mean_slope"][k] - (back @ tilt)[k]), 3.5 * errors["mean_slope"][k])
            # a tilt is the mean slope before the symmetric M
            (xx, xy, yy) = values["M"]
            np.testing.assert_allclose(np.array([[xx, xy], [xy, yy]]) @ values["mean_slope"], values["tilt"], atol=1e-12)
        self.assertGreater(chosen, 8)
        squares = (np.array(z)**2).sum()
        self.assertLess(20.3, squares)
        self.assertLess(squares, 92.9 * 35 / 33)

    def test_material_goes_on(self):
        """-o writes what stdout says; eval takes it, and its D is what the parameters say; what made it is found."""
        file, material = self.folder / "made.exr", self.folder / "material.json"
        for law in (["ggx", "--alpha", "0.25"], ["phong", "--exponent", "30"], ["gtr", "--alpha", "0.3", "--gamma", "3"]):
            made = musurf("surface", "make", "--ndf", *law, "--size", "256", "--correlation", "6", "--seed", "11", "-o", file)
            self.assertEqual(made.returncode, 0, made.err)
            done = musurf("surface", "fit", file, "-o", material)
            self.assertEqual((done.returncode, done.err), (0, ""))
            said = strict(done.out)
            self.assertEqual(json.loads(material.read_text()), said["material"])
            self.assertEqual(said["material"]["ndf"], law[0])
            line = {"material": said["material"], "wo": [0, 0, 1], "wm": [0.1, 0.2, 0.9]}
            value = musurf("eval", stdin=json.dumps(line) + "\n")
            self.assertEqual((value.returncode, value.err), (0, ""))
            again = dict(line, material={"material": "musurf.microfacet", "ndf": law[0],
                                         **{law[k][2:]: float(law[k + 1]) for k in range(1, len(law), 2)}})
            truth = musurf("eval", stdin=json.dumps(again) + "\n")
            # alpha, gamma and mean slope are known to a few percent each
            self.assertLess(abs(strict(value.out)["D"] / strict(truth.out)["D"] - 1), 0.1)

    def test_residual_counts_facets(self):
        """Shares of steepness in the report against the facets, counted here in the frame that the report states.

        The report judges each half by the other's fit, here all by the fit of all: differences are of the order of the
        standard errors of shares."""
        heights, _ = gaussian(N, 6, 77, 0.3)
        said = self.fit(heights)
        best = said["candidates"][0]
        (xx, xy, yy), mean = best["values"]["M"], best["values"]["mean_slope"]
        h = exr.read(self.folder / "h.exr")[1]["Y"].astype(float)
        x, y = np.roll(h, -1, 0) - h, np.roll(h, -1, 1) - h
        s = np.stack([np.concatenate([x, np.roll(x, -1, 1)]), np.concatenate([y, np.roll(y, -1, 0)])]).reshape(2, -1)
        u = np.array([[xx, xy], [xy, yy]]) @ (s - np.array(mean)[:, None]) / best["values"]["alpha"]
        below = -np.expm1(-(u**2).sum(0))
        shares = np.bincount(np.minimum((20 * below).astype(int), 19), minlength=20) / s.shape[1]
        steepness = best["residual"]["steepness"]
        self.assertEqual(said["facets"], s.shape[1])
        self.assertLess(np.abs(shares - steepness["shares"]).max(), 2 * max(steepness["errors"]))
        self.assertAlmostEqual(steepness["rms"], np.sqrt(((20 * np.array(steepness["shares"]) - 1)**2).mean()), places=12)
        self.assertAlmostEqual(steepness["variation"], np.abs(np.array(steepness["shares"]) - 0.05).sum() / 2, places=12)

    def test_refusals(self):
        rough, _ = gaussian(N, 6, 3, 0.3)
        nearly, _ = gaussian(N, 6, 4, 0.03)
        heavy = self.folder / "made.exr"
        self.assertEqual(musurf("surface", "make", "--ndf", "ggx", "--alpha", "0.3", "--size", N, "-o", heavy).returncode, 0)
        ggx = exr.read(heavy)[1]["Y"].astype(float)
        levels = np.ptp(ggx) / 255
        saw = X % 32
        for name, heights, words, more in [
                ("plane", 0.3 * X + 0.1 * Y, "a plane that is tilted", ["--open"]),
                ("two lobes", rough + 0.9 * abs(X % 64 - 32), "two-lobed", []),
                ("turned lobes", rough + 0.45 * abs(Y % 64 - 32), "two-lobed", []),
                ("skewed", rough + 0.15 * np.where(saw < 28, saw, 7 * (32 - saw)), "skewed", []),
                ("boxes", 5.0 * ((X // 16 + Y // 16) % 2), "few orientations", []),
                ("rough boxes", 5.0 * ((X // 16 + Y // 16) % 2) + nearly, "steepness is of another kind", []),
                ("pyramids", abs(X % 32 - 16) / 2 + abs(Y % 32 - 16) / 2, "few orientations", []),
                ("grating", 3 * np.sin(2 * np.pi * 5 * X / N), "lie on a line", []),
                ("rough grating", 3 * np.sin(2 * np.pi * X / 16) + nearly / 2, "no candidate explains", []),
                ("8 bits", np.round(ggx / levels) * levels, "heights come in steps of", []),
                ("patches", np.where((X // 16 + Y // 16) % 2 == 0, 0.1, 1) * rough, "steepness is of another kind", []),
                ("small", rough[:16, :16], "too few facets", []),
                ("few hills", rough[:48, :48], "too few independent facets", [])]:
            with self.subTest(name):
                material = self.folder / "material.json"
                said = self.fit(heights, "-o", material, *more, code=1)
                self.assertEqual(said["verdict"], "refused")
                self.assertIn(words, said["reason"])
                self.assertNotIn("material", said)
                self.assertFalse(material.exists())
                self.assertFalse(any(c["explains"] for c in said["candidates"][:1]))
        self.assertEqual(self.fit(np.full((N, N), 3.0))["material"], {"material": "musurf.microfacet", "ndf": "flat"})
        broken = rough.copy()
        broken[3, 5] = np.nan
        write_exr(self.folder / "nan.exr", broken)
        done = musurf("surface", "fit", self.folder / "nan.exr")
        self.assertEqual((done.returncode, done.out), (2, ""))
        self.assertIn("is not finite", done.err)

    def test_tabulated(self):
        """What no candidate explains is still a material: a histogram, whose D is the share of facets."""
        rough, _ = gaussian(N, 6, 5, 0.3)
        table = self.folder / "table.json"
        said = self.fit(rough + 0.9 * abs(X % 64 - 32), "--tabulated", table, code=1)
        material = json.loads(table.read_text())
        weights = np.array(material["histogram"]["weights"])
        self.assertEqual(weights.shape, (128, 128))
        self.assertAlmostEqual(weights.sum() / said["facets"], 1 - said["outside"], places=12)
        self.assertLess(said["outside"], 0.002)
        # P22 at both lobes is many times that between them: D cos^4 there
        lines = [{"material": material, "wo": [0, 0, 1], "wm": [-x, 0, 1]} for x in (-0.9, 0, 0.9)]
        done = musurf("eval", stdin="".join(json.dumps(line) + "\n" for line in lines))
        self.assertEqual((done.returncode, done.err), (0, ""))
        d = [strict(line)["D"] for line in done.out.splitlines()]
        self.assertGreater(min(d[0], d[2]) / 1.81**2, 5 * d[1])

    def test_usage(self):
        rough, _ = gaussian(N, 6, 6, 0.3)
        file = self.folder / "h.exr"
        write_exr(file, rough)
        for arguments, words in [([], "a heightfield FILE is needed"), ([file, file], "is a second"),
                                 ([file, "--keep", "0.2"], "half of the facets"), ([file, "--keep", "2"], "between 0 and 1"),
                                 ([file, "--tolerance", "-1"], "between 0 and 1"),
                                 ([file, "--transform", "1,2,2,4"], "singular"),
                                 ([file, "-o", "/nonexistent/m.json"], "No such file"),
                                 ([self.folder / "none.exr"], "No such file")]:
            with self.subTest(arguments=arguments):
                done = musurf("surface", "fit", *arguments)
                self.assertEqual((done.returncode, done.out), (2, ""))
                self.assertRegex(done.err, r"^musurf surface fit: [^\n]*\n$")
                self.assertIn(words, done.err)


if __name__ == "__main__":
    sys.exit(unittest.main())
