#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf surface statistics` against numpy, an independent caster, V-grooves by pencil and known albedos.

The independent caster knows the untransformed surface only: masking under M is compared through the invariance.
"""
import itertools
import sys
import unittest

import numpy as np

from command import musurf, strict
from test_surface_command import MAPS, Folder, numbers, write_exr

import exact_caster  # noqa: E402
from crosscheck import heightfield, maps, mesh  # noqa: E402

RINGS, SECTORS = 6, 8
M = MAPS["mirror"]
VIEWS = [maps.carried(M, maps.direction(60, 20)), maps.carried(M, maps.direction(75, 140))]
LIGHTS = [maps.direction(50, np.degrees(np.arctan2(-v[1], -v[0]))) for v in VIEWS]  # where each view is mirrored to


def statistics(files, views, *more):
    done = musurf("surface", "statistics", *files, *[f"--view={numbers(v)}" for v in views], *more)
    assert done.returncode == 0, done.err
    return strict(done.out)


def bin_of(w):
    """Bins of directions [..., 3] as --help says."""
    theta, phi = np.arctan2(np.hypot(w[..., 0], w[..., 1]), w[..., 2]), np.arctan2(w[..., 1], w[..., 0]) % (2 * np.pi)
    ring = np.minimum((RINGS * theta / (np.pi / 2)).astype(int), RINGS - 1)
    return ring * SECTORS + np.minimum((SECTORS * phi / (2 * np.pi)).astype(int), SECTORS - 1)


def solid_angles():
    edges = np.cos(np.linspace(0, np.pi / 2, RINGS + 1))
    return np.repeat(2 * np.pi / SECTORS * (edges[:-1] - edges[1:]), SECTORS)


class AgainstNumpy(Folder):
    """Every number of a small surface under a mirroring M once more; sums of doubles differ by rounding alone, which
    1e-12 leaves room for, and no facet lies so near to the border of a bin that rounding moves it."""
    N = 12

    def setUp(self):
        super().setUp()
        self.h = heightfield.make(self.N, 0.6, 2.5, 3).astype(np.float32).astype(float)
        self.file = self.folder / "h.exr"
        write_exr(self.file, self.h)
        slopes = mesh.baked_slopes(self.h, M)
        self.slopes = slopes
        normal = np.stack([-slopes[0], -slopes[1], np.ones(slopes.shape[1:])], -1)
        self.area = np.linalg.norm(normal, axis=-1)  # per macro area
        self.normal = normal / self.area[..., None]
        self.bin = bin_of(self.normal)

    def points(self):
        """(u, v) of the L points; the partners in U are reflected at the cell's middle."""
        for k, l in itertools.product(range(6), range(3)):
            if (k + 0.5) / 6 + (l + 0.5) / 3 < 1:
                yield (k + 0.5) / 6, (l + 0.5) / 3

    def seen(self, w, i=None, j=None, upper=slice(None)):
        """[point, i, j, L|U]: V(w); or [point, 1, 1, 1] of one facet."""
        if i is None:
            i, j = np.meshgrid(np.arange(self.N), np.arange(self.N), indexing="ij")
            facing = self.normal @ w > 0
        else:
            facing = (self.normal[i, j, upper] @ w > 0)[None, None, None]
            i, j, upper = np.array([[i]]), np.array([[j]]), slice(upper, upper + 1)
        original = np.array([*(np.linalg.inv(M) @ w[:2]), w[2]])
        return np.array([exact_caster.visible(self.h, np.stack([i + u, i + 1 - u], 2)[..., upper],
                                              np.stack([j + v, j + 1 - v], 2)[..., upper], facing, original)
                         for u, v in self.points()])

    def binned(self, values, bins=None):
        return np.bincount((self.bin if bins is None else bins).ravel(), np.ravel(values), RINGS * SECTORS)

    def close(self, given, expected):
        given = np.array([np.nan if x is None else x for x in np.atleast_1d(given)])
        np.testing.assert_allclose(given, np.atleast_1d(expected), rtol=1e-12, atol=1e-12)

    def test_all(self):
        answer = statistics([self.file], VIEWS, f"--transform={numbers(M)}", *[f"--light={numbers(l)},25" for l in LIGHTS],
                            f"--rings={RINGS}", f"--sectors={SECTORS}", "--slopes=5", "--slope-bounds=-1,0.8,-0.7,1.1",
                            "--bounces=1", "--fresnel=schlick:0.1,0.5,1")
        count = 2 * self.N**2
        self.assertEqual((answer["facets"], answer["points"], answer["units"], answer["unit_count"], answer["block"]),
                         (count, 9, "blocks", 16, self.N / 4))
        expected, _, _ = np.histogram2d(self.slopes[1].ravel(), self.slopes[0].ravel(), 5, [[-0.7, 1.1], [-1, 0.8]])
        self.close(answer["slopes"]["density"], (expected / count / (1.8 / 5)**2).ravel())
        self.close(answer["slopes"]["outside"], 1 - expected.sum() / count)
        self.close(answer["slopes"]["mean"], self.slopes.reshape(2, -1).mean(1))
        covariance = np.cov(self.slopes.reshape(2, -1), bias=True)
        self.close(answer["slopes"]["covariance"], covariance[[0, 0, 1], [0, 1, 1]])
        self.close(answer["normals"]["facets"], self.binned(np.ones(self.bin.shape)))
        self.close(answer["normals"]["D"], self.binned(self.area) / count / solid_angles())
        self.close(answer["normals"]["area"], self.area.mean())
        bits = [self.seen(v) for v in VIEWS]
        with np.errstate(invalid="ignore"):
            for v, seen, view in zip(VIEWS, bits, answer["views"]):
                projected = self.area * np.maximum(0, self.normal @ v)
                self.close(view["view"], v)
                self.close(view["facing"], self.binned(self.area * (projected > 0)) / self.binned(self.area))
                self.close(view["G1"], self.binned(self.area * seen.mean(0)) / self.binned(self.area))
                self.close(view["Dv"], self.binned(projected * seen.mean(0)) / (count * v[2]) / solid_angles())
                self.close(view["projected_area"], (projected * seen.mean(0)).sum() / (count * v[2]))
                self.close(view["G1_projected"], (projected * seen.mean(0)).sum() / projected.sum())
                self.check_reflection(v, seen, projected, view["reflection"])
            both = bits[0] & bits[1]
            facing = (self.normal @ VIEWS[0] > 0) & (self.normal @ VIEWS[1] > 0)
            pair, = answer["pairs"]
            self.close(pair["facing"], self.binned(self.area * facing) / self.binned(self.area))
            self.close(pair["G2"], self.binned(self.area * both.mean(0)) / self.binned(self.area))
            self.close(pair["G2_facet_mean"], both.sum() / (9 * facing.sum()))

    def check_reflection(self, v, seen, projected, reflection):
        """Eq. (11f) facet by facet, each reflected ray a view of its own for the independent caster."""
        cosine = self.normal @ v
        r = 2 * cosine[..., None] * self.normal - v
        escaped = np.zeros(seen.shape)
        for at in zip(*np.nonzero(seen.any(0) & (r[..., 2] > 0))):
            escaped[(slice(None), *at)] = seen[(slice(None), *at)] & self.seen(r[at], *at)[:, 0, 0, 0]
        weight = projected * escaped.mean(0) / (projected * seen.mean(0)).sum()
        discs = [((r @ l > np.cos(np.radians(25))) / (np.pi * np.sin(np.radians(25))**2 * l[2])) for l in LIGHTS]
        self.assertGreater(max((weight * disc).sum() for disc in discs), 0.1)
        self.assertEqual(len(reflection), 3)
        for f0, channel in zip((0.1, 0.5, 1), reflection):
            light = weight * (f0 + (1 - f0) * (1 - np.maximum(0, cosine))**5)
            order, = channel["orders"]
            self.close(order["albedo"], light.sum())
            self.close(channel["escaped"], light.sum())
            self.close(order["density"], self.binned(light, bin_of(np.where(r[..., 2:] > 0, r, [0, 0, 1]))) / solid_angles())
            self.close([lamp["f"] for lamp in channel["lights"]], [(light * disc).sum() for disc in discs])
            self.close([lamp["f_all_orders"] for lamp in channel["lights"]], [(light * disc).sum() for disc in discs])
            self.close(channel["escaped"] + channel["over_limit"] + channel["lost"] + channel["absorbed"], 1)


class Realisations(Folder):
    """Three surfaces of one kind, `files`."""

    def setUp(self):
        super().setUp()
        self.files = []
        for seed in range(3):
            self.files.append(self.folder / f"{seed}.exr")
            write_exr(self.files[-1], heightfield.make(64, 0.5, 4.0, seed))


class Consistency(Realisations):
    def test_light_is_conserved(self):
        """Whatever the number of bounces: shares add up, densities integrate to albedos, sorted groups say the same."""
        for bounces in (1, 3, 64):
            view, = statistics(self.files, [VIEWS[1]], f"--transform={numbers(M)}", f"--bounces={bounces}",
                               "--fresnel=conductor:0.2,3.1", "--light=-0.3,0.5,1,20", f"--rings={RINGS}",
                               f"--sectors={SECTORS}")["views"]
            r, = view["reflection"]
            self.assertAlmostEqual(r["escaped"] + r["over_limit"] + r["lost"] + r["absorbed"], 1, 12)
            self.assertEqual([o["order"] for o in r["orders"]], list(range(1, bounces + 1)))
            self.assertAlmostEqual(sum(o["albedo"] for o in r["orders"]), r["escaped"], 12)
            for o in r["orders"]:
                self.assertAlmostEqual(np.dot(o["density"], solid_angles()), o["albedo"], 12)
            self.assertAlmostEqual(np.dot(view["Dv"], solid_angles()), view["projected_area"], 12)
            self.assertEqual(r["over_limit"] > 0, bounces < 64)
            # Groups 1.9 by 5.6 degrees (sin theta) against a disc of 40: F hardly changes within, and of the light what
            # its border cuts, half a group's width on average, less or more: 5 % of f.
            lamp, = r["lights"]
            self.assertAlmostEqual(lamp["f_grouped"] / lamp["f"], 1, delta=0.05)
            self.assertGreaterEqual(lamp["f_all_orders"], lamp["f"])

    def test_mirrors_lose_nothing(self):
        view, = statistics(self.files, [maps.direction(70, 0)], "--bounces=64")["views"]
        r, = view["reflection"]
        self.assertEqual((r["absorbed"], r["lost"]), (0, 0))
        self.assertAlmostEqual(r["escaped"] + r["over_limit"], 1, 12)
        self.assertLess(r["over_limit"], 1e-4)
        # 3 surfaces x 8192 facets x 9 points, of which those beside the borders of shadows err: 1e-3 as in measure
        self.assertAlmostEqual(view["projected_area"], 1, delta=1e-3)

    def test_threads_change_nothing(self):
        outs = {musurf("surface", "statistics", *self.files, "--view=1,0.3,0.4", "--view=-1,2,0.7", "--bounces=9",
                       "--light=-1,0,1", "--threads", threads).out for threads in (1, 2, 7)}
        self.assertEqual(len(outs), 1)

    def test_realisations(self):
        """Of equal surfaces: the mean and its error, of what counts per macro area; for reflection, which counts per
        visible projected area p, the ratio of sums and its error (ratio.h)."""
        def macro(answer, error=""):
            view = answer["views"][0]
            return np.concatenate([answer["normals"]["D" + error], answer["slopes"]["mean" + error], view["Dv" + error],
                                   [view["projected_area" + error]]])

        def light(answer, error=""):
            order = answer["views"][0]["reflection"][0]["orders"][1]
            return np.concatenate([order["density" + error], [order["albedo" + error]]])
        options = [[maps.direction(70, 30)], "--bounces=2", "--rings=4", "--sectors=4"]
        each = [statistics([file], *options) for file in self.files]
        answer = statistics(self.files, *options)
        self.assertEqual((answer["files"], answer["units"], answer["unit_count"]), (3, "realisations", 3))
        values = np.array([macro(a) for a in each])
        np.testing.assert_allclose(macro(answer), values.mean(0), rtol=1e-12, atol=1e-14)
        np.testing.assert_allclose(macro(answer, "_error"), values.std(0, ddof=1) / np.sqrt(3), rtol=1e-9, atol=1e-14)
        p = np.array([[a["views"][0]["projected_area"]] for a in each])
        values = np.array([light(a) for a in each])
        ratio = (values * p).sum(0) / p.sum()
        np.testing.assert_allclose(light(answer), ratio, rtol=1e-12, atol=1e-14)
        np.testing.assert_allclose(light(answer, "_error"), np.sqrt(1.5 * ((p * (values - ratio))**2).sum(0)) / p.sum(),
                                   rtol=1e-9, atol=1e-14)

    def test_blocks_warn(self):
        done = musurf("surface", "statistics", self.files[0], "--view=1,0,1")
        self.assertEqual((done.returncode, done.err), (0, ""))
        self.assertAlmostEqual(strict(done.out)["correlation_length"][0], 4, delta=1)
        write_exr(self.files[0], heightfield.make(64, 0.5, 8.0, 1))
        done = musurf("surface", "statistics", self.files[0], "--view=1,0,1")
        self.assertIn("less than four correlation lengths", done.err)
        self.assertIsNotNone(strict(done.out))

    def test_embree_sees_the_same(self):
        own, embree = (statistics(self.files[:1], VIEWS, f"--transform={numbers(M)}", f"--tracer={tracer}")["views"]
                       for tracer in ("own", "embree"))
        for a, b in zip(own, embree):
            self.assertAlmostEqual(a["G1_projected"], b["G1_projected"], delta=1e-3)
            self.assertAlmostEqual(a["reflection"][0]["escaped"], b["reflection"][0]["escaped"], delta=1e-3)

    def test_refusals(self):
        for words, *arguments in [("FILE is needed", "--view=1,0,1"), ("needs a --view", self.files[0], "--light=0,0,1"),
                                  ("above the horizon", self.files[0], "--view=0,0,1", "--light=1,0,0.1"),
                                  ("above the horizon", self.files[0], "--view=0,0,1", "--light=0,0,0"),
                                  ("needs --bounces", self.files[0], "--view=0,0,1", "--light=0,0,1", "--bounces=0"),
                                  ("from 0 to 64", self.files[0], "--bounces=65"), ("z > 0", self.files[0], "--view=1,0,0"),
                                  ("known: none, schlick", self.files[0], "--fresnel=gold"),
                                  ("a number is needed", self.files[0], "--fresnel=dielectric"),
                                  ("one number a colour", self.files[0], "--fresnel=schlick:1,1"),
                                  ("one number a colour", self.files[0], "--fresnel=conductor:1,1,1"),
                                  ("between 0 and 1", self.files[0], "--fresnel=schlick:1.5"),
                                  ("above 0", self.files[0], "--fresnel=dielectric:0"),
                                  ("takes no numbers", self.files[0], "--fresnel=none:1"),
                                  ("X0 < X1", self.files[0], "--slope-bounds=1,0,0,1"),
                                  ("near the horizon", self.files[0], "--view=1,0,1e-9"),
                                  ("No such file", self.files[0], self.folder / "none.exr")]:
            with self.subTest(arguments=arguments):
                done = musurf("surface", "statistics", *arguments)
                self.assertEqual((done.returncode, done.out), (2, ""))
                self.assertRegex(done.err, r"^musurf surface statistics: [^\n]*\n$")
                self.assertIn(words, done.err)


class Groove(Folder):
    """V-grooves two cells wide: which share of the light leaves after how many reflections, by unfolding.

    Depth s, half-width 1, half-angle b with tan b = 1/s, walls of length R. A ray from theta enters the mouth at x in
    (-1, 1) and goes on straight through mirror images of the groove: it meets the k-th image of a wall, at the angle
    (2k+1) b on one side or the other, before its mouth, if it passes between the bottom and that image's upper end V_k,
    so x lies between the place x_k of the ray through V_k and that through the bottom, s tan theta; and if that angle is
    within a half turn of where it came from. Shares are lengths between such places.
    """
    SIDE = 15

    def shares(self, s, theta):
        b, radius, tangent = np.arctan2(1, s), np.hypot(1, s), np.tan(theta)
        bottom, places = s * tangent, []
        for sense in (-1, 1):
            for k in range(200):
                angle = sense * (2 * k + 1) * b
                if not (angle > theta - np.pi if sense < 0 else theta < angle < theta + np.pi):
                    if sense > 0 and angle <= theta:
                        continue
                    break
                x = radius * np.sin(angle) + (s - radius * np.cos(angle)) * tangent
                places.append((sense, x))
        cuts = np.unique(np.clip([-1, 1, bottom] + [x for _, x in places], -1, 1))
        out = np.zeros(64)
        for low, high in zip(cuts[:-1], cuts[1:]):
            x = (low + high) / 2
            count = sum(p < x < bottom if sense < 0 else bottom < x < p for sense, p in places)
            out[count - 1] += (high - low) / 2
        return out, len(cuts)

    def test_orders(self):
        file = self.folder / "groove.exr"
        most = 0
        for s, degrees in itertools.product((0.5, 1.3, 3.0), (0, 20, 50, 72)):
            theta = np.radians(degrees)
            expected, cuts = self.shares(s, theta)
            self.assertAlmostEqual(expected.sum(), 1, 12)
            h = np.zeros((8, 8))
            h[1::2] = s
            write_exr(file, h.astype(np.float32))
            # Turned, widened (and the slopes lowered), and looked at along the turned direction: the same groove.
            m = maps.rotation(0.7) @ np.diag([1.0, -1.7])
            view = statistics([file], [maps.carried(m, np.array([np.sin(theta), 0, np.cos(theta)]))],
                              f"--transform={numbers(m)}", f"--subsamples={self.SIDE**2}", "--bounces=64")["views"][0]
            r, = view["reflection"]
            albedo = np.array([o["albedo"] for o in r["orders"]])
            # Points stand in 2 SIDE columns a wall; each cut (and the border of the shadow) moves one of them at most.
            column = max(1 + s * np.tan(theta), abs(1 - s * np.tan(theta))) / 2 / (2 * self.SIDE)
            with self.subTest(depth=s, degrees=degrees):
                self.assertLess(abs(albedo - expected).max(), (cuts + 1) * column)
                self.assertEqual((r["over_limit"], r["lost"]), (0, 0))
                reached = np.flatnonzero(expected > 2 * column).max()
                self.assertGreater(albedo[reached], 0)
                most = max(most, reached + 1)
        self.assertGreaterEqual(most, 4)


class KnownAlbedo(Folder):
    def test_beckmann(self):
        """Single-scatter albedo of Beckmann .3 at 75 and 60 degrees as measured by another exact caster on six other
        surfaces, .9108 +- .0005 and .9270 +- .0003. Of eight surfaces the standard error has 7 degrees of freedom: 4 of
        them are exceeded by chance once in 190 times; the seeds are fixed."""
        files = [self.folder / f"{seed}.exr" for seed in range(8)]
        for seed, file in enumerate(files):
            done = musurf("surface", "make", "--ndf=beckmann", "--alpha=0.3", "--size=256", "--correlation=8",
                          f"--seed={seed}", "-o", file)
            self.assertEqual(done.returncode, 0, done.err)
        answer = statistics(files, [maps.direction(75, 0), maps.direction(60, 0)])
        for view, known, error in zip(answer["views"], (0.9108, 0.9270), (0.0005, 0.0003)):
            order, = view["reflection"][0]["orders"]
            self.assertLess(abs(order["albedo"] - known), 4 * np.hypot(order["albedo_error"], error))
            self.assertLess(order["albedo_error"], 2e-3)


if __name__ == "__main__":
    sys.exit(unittest.main())
