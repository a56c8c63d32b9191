#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf surface statistics --transmission` against numpy and an independent caster, a pane and V-grooves by pencil and paper.

Snell and Fresnel are written here in angles. The caster knows no underside: the mirror image z -> -z of the surface and of a
ray from below are a surface and a ray from above on the same triangles, another symmetry than the command's.
"""
import itertools
import sys
import unittest

import numpy as np

import test_surface_statistics as above
from command import musurf
from test_surface_command import Folder, numbers, write_exr

import exact_caster  # noqa: E402
from crosscheck import maps  # noqa: E402

M, RINGS, SECTORS, VIEWS = above.M, above.RINGS, above.SECTORS, above.VIEWS


def refracted(v, m, eta):
    """Where m (unit, v.m > 0) sends v [..., 3], NaN in total reflection; and F, which is 1 then."""
    cosine = np.sum(v * m, -1)
    sine = np.sqrt(np.maximum(0, 1 - cosine**2)) / eta
    with np.errstate(invalid="ignore"):
        below = np.sqrt(1 - sine**2)
    t = -(v - cosine[..., None] * m) / eta - below[..., None] * m
    s, p = (cosine - eta * below) / (cosine + eta * below), (eta * cosine - below) / (eta * cosine + below)
    return t, np.where(sine < 1, (s**2 + p**2) / 2, 1)


def down(w):
    return w * np.array([1, 1, -1])


def disc(w, l, degrees):
    """The radiance along w [..., 3] of a disc of light about l."""
    return (w @ l > np.cos(np.radians(degrees))) / (np.pi * np.sin(np.radians(degrees))**2 * abs(l[2]))


class Facets(above.AgainstNumpy):
    """Facet by facet, as in the class above; sums differ by rounding alone."""
    test_all = None  # is run over there

    def from_below(self, t, i, j, upper):
        """[point]: V(t) of a facet."""
        original = np.array([*(np.linalg.inv(M) @ t[:2]), -t[2]])
        points = np.array([(i + u, j + v) if not upper else (i + 1 - u, j + 1 - v) for u, v in self.points()])
        return exact_caster.visible(-self.h, points[:, 0], points[:, 1], np.ones(len(points), bool), original)

    def grouped(self, weight, v, eta, light):
        """Sorted by normal into bins eight times as fine; F and the light asked at the mean normal."""
        theta = np.arctan2(np.hypot(self.normal[..., 0], self.normal[..., 1]), self.normal[..., 2])
        phi = np.arctan2(self.normal[..., 1], self.normal[..., 0]) % (2 * np.pi)
        fine = (8 * RINGS * theta / (np.pi / 2)).astype(int) * 8 * SECTORS + (8 * SECTORS * phi / (2 * np.pi)).astype(int)
        total = 0
        for k in np.unique(fine[weight > 0]):
            of = fine == k
            mean = (weight[of][:, None] * self.normal[of]).sum(0)
            t, f = refracted(v, mean / np.linalg.norm(mean), eta)
            total += weight[of].sum() * (1 - f) * disc(t, light, 25)
        return total / eta**2

    def brightest(self, v, eta):
        """Where the facet that shows most sends it, if a disc of 25 degrees there stays below the horizon."""
        t, f = refracted(v, self.normal, eta)
        light = np.where(t[..., 2] < -0.45, self.area * np.maximum(0, self.normal @ v) * (1 - f), 0)
        return t[np.unravel_index(light.argmax(), light.shape)] if light.max() > 0 else maps.direction(130, 20)

    def test_all_numbers(self):
        self.lit = []
        for eta in (1.5, 1 / 1.5):
            lights = [self.brightest(v, eta) for v in VIEWS]
            answer = above.statistics([self.file], VIEWS, f"--transform={numbers(M)}", f"--fresnel=dielectric:{eta!r}",
                                      "--transmission", *[f"--light={numbers(l)},25" for l in lights],
                                      f"--rings={RINGS}", f"--sectors={SECTORS}")
            for v, view in zip(VIEWS, answer["views"]):
                with self.subTest(eta=eta, view=v):
                    self.check(v, eta, lights, view["transmission"], view["reflection"][0])
        self.assertGreaterEqual(sum(f > 0.01 for f in self.lit), 3, self.lit)  # of four

    def check(self, v, eta, lights, given, reflection):
        seen, projected = self.seen(v), self.area * np.maximum(0, self.normal @ v)
        t, f = refracted(v, self.normal, eta)
        through = np.zeros(seen.shape)
        for at in zip(*np.nonzero(seen.any(0) & (t[..., 2] < 0))):
            through[(slice(None), *at)] = seen[(slice(None), *at)] & self.from_below(t[at], *at)
        all_of_it = (projected * seen.mean(0)).sum()
        share, weight = projected * seen.mean(0) / all_of_it, projected * through.mean(0) / all_of_it
        light = weight * (1 - f)
        self.close(given["escaped"], light.sum())
        self.close(given["caught"], (share * (1 - f)).sum() - light.sum())
        self.close(given["reflected"], (share * f).sum())
        self.close(given["total_reflection"], share[np.isnan(t[..., 0])].sum())
        self.close(given["factor"], 1 / eta**2)
        t = np.where(weight[..., None] > 0, t, [0, 0, -1])
        self.close(given["density"], self.binned(light, above.bin_of(down(t))) / eta**2 / above.solid_angles())
        expected = [(light * disc(t, l, 25)).sum() / eta**2 for l in lights]
        self.lit.append(max(expected))
        self.close([lamp["f"] for lamp in given["lights"]], expected)
        self.close([lamp["f_grouped"] for lamp in given["lights"]], [self.grouped(weight, v, eta, l) for l in lights])
        # Reflected once, refracted once, and what meets the surface again on either side: all of it.
        self.close(reflection["escaped"] + reflection["over_limit"] + given["escaped"] + given["caught"], 1)
        self.assertGreater(reflection["over_limit"] + given["caught"], 0.01)
        self.assertEqual(reflection["lights"], [])


class Pane(Folder):
    """A level surface under a mirroring M: Snell and Fresnel themselves."""

    def test_pane(self):
        file = self.folder / "pane.exr"
        write_exr(file, np.full((8, 8), 0.25, np.float32))
        up = np.array([0, 0, 1.0])
        for eta, degrees in itertools.product((1.5, 2.4, 1 / 1.5, 1.0), (10, 35, 70)):
            v = maps.direction(degrees, 50)
            t, f = refracted(v, up, eta)
            total = bool(np.isnan(t[0]))
            light = maps.direction(150, 0) if total else t
            radius = min(10, 0.99 * (90 - np.degrees(np.arccos(-light[2]))))
            view, = above.statistics([file], [v], f"--transform={numbers(M)}", f"--fresnel=dielectric:{eta!r}",
                                     f"--light={numbers(light)},{radius!r}", "--transmission", f"--rings={RINGS}",
                                     f"--sectors={SECTORS}")["views"]
            given, reflection = view["transmission"], view["reflection"][0]
            with self.subTest(eta=eta, degrees=degrees):
                self.assertAlmostEqual(given["escaped"], 1 - f, 13)
                self.assertEqual((given["caught"], given["total_reflection"]), (0, 1 if total else 0))
                self.assertAlmostEqual(reflection["orders"][0]["albedo"] + given["escaped"], 1, 13)
                radiance = np.array(given["density"]) * above.solid_angles()
                expected = np.zeros(RINGS * SECTORS)
                if not total:
                    expected[above.bin_of(down(t))] = (1 - f) / eta**2
                np.testing.assert_allclose(radiance, expected, atol=1e-13)
                # Inside a white furnace radiance is 1 above and eta^2 below: everything in between shows 1.
                self.assertAlmostEqual(reflection["orders"][0]["albedo"] + eta**2 * radiance.sum(), 1, 12)
                lamp, = given["lights"]
                f_t = 0 if total else (1 - f) / eta**2 * disc(t, light, radius)
                np.testing.assert_allclose([lamp["f"], lamp["f_grouped"]], f_t, rtol=1e-12)
                if total:
                    continue
                back = above.statistics([file], [-t], f"--fresnel=dielectric:{1 / eta!r}", "--transmission")["views"][0]
                self.assertAlmostEqual(back["transmission"]["escaped"], given["escaped"], 12)  # the way back
                self.assertAlmostEqual(back["transmission"]["factor"] * given["factor"], 1, 12)

    def test_totally_reflected(self):
        """The critical angle of 1/1.5 is 41.8 degrees."""
        self.assertEqual([bool(np.isnan(refracted(maps.direction(d, 0), np.array([0, 0, 1.0]), 1 / 1.5)[0][0]))
                          for d in (41.8, 41.82)], [False, True])


class Groove(Folder):
    """V-grooves two wide and s deep, valleys at even x. From the side of x > 0 a wall that falls toward it is seen from its
    top down to where the next top's shadow begins; one that rises, wholly or not at all. A refracted ray leaves a wall and
    goes down; what it can meet is the next valley on its way. So all borders are straight lines' crossings."""
    SIDE = 15

    def expected(self, s, theta, eta):
        """(escaped, caught, reflected, total), and the most by which a border may move them, in columns of points."""
        v, out, cuts, steep = np.array([np.sin(theta), 0, np.cos(theta)]), np.zeros(4), 0, 0
        for sign in (-1, 1):  # rises over x in (0, 1), falls over (1, 2)
            m = np.array([sign * s, 0, 1]) / np.hypot(s, 1)
            a, b = (0.0, 1.0) if sign < 0 else (1.0, 2.0)
            weight = (1 + sign * s * np.tan(theta)) / 2  # projected area per x, over the plane's own
            if weight <= 0:
                continue
            if sign > 0 and theta > 0:
                b, cuts = min(b, (s + 3 / np.tan(theta)) / (s + 1 / np.tan(theta))), cuts + 1
            steep = max(steep, weight)
            t, f = refracted(v, m, eta)
            if np.isnan(t[0]):
                out += np.array([0, 0, 1, 1]) * weight * (b - a)
                continue
            c, d, cuts = a, b, cuts + 1  # of it, [c, d] is clear below
            if t[2] >= 0:
                d = c
            elif sign < 0 and t[0] > 0:
                d = min(b, 2 * (-t[2] / t[0]) / (s - t[2] / t[0]))
            elif sign > 0 and t[0] < 0:
                c = max(a, 2 * s / (s + t[2] / t[0]))
            clear = max(0, d - c)
            out += weight * np.array([(1 - f) * clear, (1 - f) * (b - a - clear), f * (b - a), 0])
        return out, (cuts + 1) * steep

    def test_shares(self):
        file, met = self.folder / "groove.exr", np.zeros(3)
        for s, degrees, eta in itertools.product((0.5, 1.3, 3.0, 6.0), (0, 20, 50, 72), (1.5, 2.4, 1 / 1.5)):
            theta = np.radians(degrees)
            expected, columns = self.expected(s, theta, eta)
            self.assertAlmostEqual(expected[:3].sum(), 1, 12)
            h = np.zeros((8, 8))
            h[1::2] = s
            write_exr(file, h.astype(np.float32))
            m = maps.rotation(0.7) @ np.diag([1.0, -1.7])
            view, = above.statistics([file], [maps.carried(m, np.array([np.sin(theta), 0, np.cos(theta)]))],
                                     f"--transform={numbers(m)}", f"--subsamples={self.SIDE**2}", "--transmission",
                                     f"--fresnel=dielectric:{eta!r}", "--bounces=0")["views"]
            given = [view["transmission"][key] for key in ("escaped", "caught", "reflected", "total_reflection")]
            with self.subTest(depth=s, degrees=degrees, eta=eta):
                # 2 SIDE columns of points a wall; each border moves one of them at most.
                self.assertLess(abs(given - expected).max(), columns / (2 * self.SIDE))
            met += [0.05 < expected[k] < 0.95 for k in (0, 1, 3)]
        self.assertTrue(np.all(met >= 3), met)


class Consistency(above.Realisations):
    def test_shares_add_up(self):
        """With its error; and what transmission says of the first facet, reflection says as well."""
        v = maps.direction(60, 20)
        for eta, light in ((1.33, refracted(v, np.array([0, 0, 1.0]), 1.33)[0]), (0.75, -v)):
            view, = above.statistics(self.files, [v], f"--fresnel=dielectric:{eta}",
                                     "--transmission", f"--light={numbers(light)},20", "--light=-0.3,0.5,1,20",
                                     f"--rings={RINGS}", f"--sectors={SECTORS}")["views"]
            given, reflection = view["transmission"], view["reflection"][0]
            self.assertAlmostEqual(given["escaped"] + given["caught"] + given["reflected"], 1, 12)
            self.assertAlmostEqual(reflection["absorbed"], given["escaped"] + given["caught"], 12)
            self.assertAlmostEqual(reflection["absorbed_error"], given["reflected_error"], 12)
            self.assertAlmostEqual(np.dot(given["density"], above.solid_angles()), given["escaped"] * given["factor"], 12)
            self.assertEqual([len(side["lights"]) for side in (given, reflection)], [1, 1])
            lamp, = given["lights"]
            self.assertGreater(lamp["f_error"], 0)
            if eta > 1:
                # Groups of 1.9 by 5.6 degrees (sin theta) against a disc of 40, as in reflection, where rays turn by twice
                # as much as normals; here by 1 - cos_v/(eta cos_t) < 1. Out of a dense medium they may turn by any amount.
                self.assertAlmostEqual(lamp["f_grouped"] / lamp["f"], 1, delta=0.05)

    def test_threads_change_nothing(self):
        outs = {musurf("surface", "statistics", *self.files, "--view=1,0.3,0.4", "--light=-1,0,-1", "--transmission",
                       "--fresnel=dielectric:1.5", "--threads", threads).out for threads in (1, 2, 7)}
        self.assertEqual(len(outs), 1)
        self.assertIn("caught", outs.pop())

    def test_refusals(self):
        for words, *arguments in [("needs --fresnel dielectric", "--transmission"),
                                  ("needs --fresnel dielectric", "--transmission", "--fresnel=conductor:1,1"),
                                  ("needs --fresnel dielectric", "--transmission", "--fresnel=schlick:0.5"),
                                  ("below needs --transmission", "--fresnel=dielectric:1.5", "--light=0,0,-1"),
                                  ("above the horizon, or below", "--transmission", "--fresnel=dielectric:1.5",
                                   "--light=1,0,-0.1")]:
            with self.subTest(arguments=arguments):
                done = musurf("surface", "statistics", self.files[0], "--view=0,0,1", *arguments)
                self.assertEqual((done.returncode, done.out), (2, ""))
                self.assertIn(words, done.err)


if __name__ == "__main__":
    sys.exit(unittest.main())
