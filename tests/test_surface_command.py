#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf surface make|measure` as a contract: files, JSON, exact counts, the same under every M, refusals.

Counts are held to an independent caster (exact_caster.py) and to the slopes of scripts/crosscheck, written apart.
"""
import itertools
import os
import pathlib
import resource
import struct
import sys
import tempfile
import unittest

import numpy as np

from command import ROOT, musurf, strict

sys.path.insert(0, str(ROOT / "scripts"))
import exact_caster  # noqa: E402
import exr  # noqa: E402
from crosscheck import heightfield, maps, masking, mesh  # noqa: E402

VIEWS = [maps.direction(60, 20), maps.direction(75, 140), maps.direction(85, 260)]
MAPS = {"stretch": np.diag([5.0, 1.0]), "skew": np.array([[1.0, 2.0], [0.0, 1.0]]), "turn": maps.rotation(0.5),
        "mirror": np.array([[0.8, 0.5], [0.3, -1.2]]),
        "condition 100": maps.rotation(0.3) @ np.diag([10, 0.1]) @ maps.rotation(1.1)}


def numbers(values):
    return ",".join(repr(float(x)) for x in np.ravel(values))


def write_exr(file, heights, channels=("Y",), kind=2):
    """An uncompressed scanline EXR, written from the format's description."""
    rows, columns = heights.shape
    head = struct.pack("<II", 20000630, 2)

    def attribute(name, type_name, value):
        return name.encode() + b"\0" + type_name.encode() + b"\0" + struct.pack("<i", len(value)) + value
    listed = b"".join(c.encode() + b"\0" + struct.pack("<iIii", kind, 0, 1, 1) for c in channels) + b"\0"
    window = struct.pack("<4i", 0, 0, columns - 1, rows - 1)
    head += attribute("channels", "chlist", listed) + attribute("compression", "compression", b"\0")
    head += attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window)
    head += attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    head += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    head += attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    size = columns * len(channels) * (2 if kind == 1 else 4)
    offsets = [len(head) + 8 * rows + k * (8 + size) for k in range(rows)]
    lines = [struct.pack("<ii", k, size)
             + len(channels) * heights[k].astype("<f2" if kind == 1 else "<f4").tobytes() for k in range(rows)]
    pathlib.Path(file).write_bytes(head + struct.pack(f"<{rows}Q", *offsets) + b"".join(lines))


def measure(file, views, m=None, *more):
    done = musurf("surface", "measure", file, *([] if m is None else [f"--transform={numbers(m)}"]),
                  *[f"--view={numbers(v)}" for v in views], *more)
    assert (done.returncode, done.err) == (0, ""), done.err
    return strict(done.out)


class Folder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)


class Make(Folder):
    def test_file_and_report(self):
        file = self.folder / "h.exr"
        done = musurf("surface", "make", "--ndf", "ggx", "--alpha", "0.3", "--size", "128", "--seed", "7", "-o", file)
        self.assertEqual((done.returncode, done.err), (0, ""))
        said = strict(done.out)
        header, channels = exr.read(file)
        self.assertEqual((list(channels), channels["Y"].shape), (["Y"], (128, 128)))
        self.assertEqual((header["ndf"], header["alpha"], header["seed"], header["clip"]), ("ggx", 0.3, "7", 0.9999))
        heights = channels["Y"].astype(float)
        steep = np.hypot(*heightfield.slopes(heights))
        self.assertAlmostEqual(steep.max() / said["steepest"], 1, places=12)
        self.assertLessEqual(steep.max(), said["limit"])
        self.assertAlmostEqual(said["limit"] / (0.3 * np.sqrt(0.9999 / 0.0001)), 1, places=12)
        self.assertAlmostEqual(np.ptp(heights), said["range"], places=9)
        edges = [0.3 * np.sqrt(u / (1 - u)) for u in np.arange(1, 20) / 20]
        for family, deviation in enumerate(said["deviation"]):
            shares = np.bincount(np.searchsorted(edges, steep[..., family].ravel()), minlength=20) / 128**2
            self.assertAlmostEqual(np.sqrt(((20 * shares - 1)**2).mean()), deviation, places=12)
            self.assertLess(deviation, 0.02)

    def test_blocks_that_do_not_shrink(self):
        """Of 16 x 256 heights, compression leaves some blocks as long as they were; those are stored as they are."""
        for seed in (0, 1):  # either has such a block
            file = self.folder / f"{seed}.exr"
            done = musurf("surface", "make", "--ndf=beckmann", "--alpha=0.3", "--size=256", f"--seed={seed}", "-o", file)
            self.assertEqual(done.returncode, 0, done.err)
            heights = exr.read(file)[1]["Y"].astype(float)
            self.assertAlmostEqual(np.ptp(heights), strict(done.out)["range"], places=9)
            self.assertEqual(musurf("surface", "measure", file, "--view=1,0,1").returncode, 0)

    def test_seed_decides(self):
        made = []
        for name, seed in (("a", 1), ("b", 1), ("c", 2)):
            done = musurf("surface", "make", "--ndf=beckmann", "--alpha=0.5", "--size=32", f"--seed={seed}",
                          "--correlation=4", "-o", self.folder / name)
            self.assertEqual(done.returncode, 0, done.err)
            made.append(exr.read(self.folder / name)[1]["Y"])
        np.testing.assert_array_equal(made[0], made[1])
        self.assertFalse(np.allclose(made[0], made[2]))

    def test_refusals(self):
        good = {"--ndf": "gtr", "--alpha": "0.3", "--gamma": "2", "--size": "32", "-o": str(self.folder / "h.exr")}
        for changes, words in [({"--ndf": None}, "--ndf is needed"), ({"-o": None}, "-o FILE is needed"),
                               ({"--gamma": None}, "gtr needs --gamma"), ({"--exponent": "3"}, "gtr has no --exponent"),
                               ({"--ndf": "gg"}, '--ndf is "gg"'), ({"--alpha": "1.5"}, "alpha must lie between 0 and 1"),
                               ({"--alpha": "nan"}, "a number is needed"), ({"--size": "33"}, "must be even"),
                               ({"--size": "4"}, "whole number from 8"), ({"--clip": "1"}, "between 0 and 1"),
                               ({"--correlation": "9"}, "a quarter of the size"), ({"--correlation": "-1"}, "above 0"),
                               ({"-o": str(self.folder)}, "is a folder"), ({"-o": "/nonexistent/h.exr"}, "No such file")]:
            with self.subTest(changes=changes):
                options = {k: v for k, v in {**good, **changes}.items() if v is not None}
                done = musurf("surface", "make", *itertools.chain(*options.items()))
                self.assertEqual((done.returncode, done.out), (2, ""))
                self.assertRegex(done.err, r"^musurf surface make: [^\n]*\n$")
                self.assertIn(words, done.err)
                self.assertEqual(os.listdir(self.folder), [])

    def test_old_file_survives_failure(self):
        file = self.folder / "h.exr"
        file.write_bytes(b"precious")
        done = musurf("surface", "make", "--ndf", "ggx", "--alpha", "0.3", "--size", "128", "-o", file,
                      preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096)),
                      restore_signals=False)  # SIGXFSZ stays ignored: the write fails instead
        self.assertEqual((done.returncode, done.out), (2, ""))
        self.assertRegex(done.err, r"^musurf surface make: [^\n]*h.exr: cannot be written[^\n]*\n$")
        self.assertEqual((file.read_bytes(), os.listdir(self.folder)), (b"precious", ["h.exr"]))


class Measure(Folder):
    N = 64

    def setUp(self):
        super().setUp()
        self.h = heightfield.make(self.N, 0.5, 5.0, 7).astype(np.float32).astype(float)
        self.file = self.folder / "h.exr"
        write_exr(self.file, self.h)
        self.slopes = heightfield.slopes(self.h)

    def exact(self, v, x=(0.25, 0.75), y=(0.5, 0.5)):
        i, j = np.meshgrid(np.arange(self.N), np.arange(self.N), indexing="ij")
        return exact_caster.visible(self.h, np.stack([i + x[0], i + x[1]], 2), np.stack([j + y[0], j + y[1]], 2),
                                    masking.facing(self.slopes, v) > 0, v)

    def test_untransformed_counts_are_exact(self):
        answer = measure(self.file, VIEWS)
        self.assertEqual(set(answer), {"views", "pairs"})
        bits = [self.exact(v) for v in VIEWS]
        for v, seen, view in zip(VIEWS, bits, answer["views"]):
            front = masking.facing(self.slopes, v) > 0
            self.assertEqual((view["facets"], view["front_facing"], view["visible"]),
                             (2 * self.N**2, front.sum(), seen.sum()))
            self.assertEqual(view["G1_facet_mean"], seen.sum() / front.sum())
        self.assertEqual([(p["a"], p["b"]) for p in answer["pairs"]], [(0, 1), (0, 2), (1, 2)])
        for pair in answer["pairs"]:
            a, b = pair["a"], pair["b"]
            both = (masking.facing(self.slopes, VIEWS[a]) > 0) & (masking.facing(self.slopes, VIEWS[b]) > 0)
            self.assertEqual((pair["facing_both"], pair["both_visible"]), (both.sum(), (bits[a] & bits[b]).sum()))
            self.assertEqual(pair["G2"], (bits[a] & bits[b]).sum() / both.sum())

    def test_projected_mean(self):
        v, weight = VIEWS[1], masking.facing(self.slopes, VIEWS[1])
        for fine in (3, 4):
            seen, count = np.zeros(weight.shape), 0
            for k, l in itertools.product(range(2 * fine), range(fine)):
                p, q = (k + 0.5) / (2 * fine), (l + 0.5) / fine
                if p + q < 1:  # its partner in U is the point reflected at the cell's middle
                    seen += self.exact(v, (p, 1 - p), (q, 1 - q))
                    count += 1
            self.assertEqual(count, fine**2)
            expected = (seen * weight).sum() / weight.sum() / count
            view = measure(self.file, [v], None, f"--subsamples={fine**2}")["views"][0]
            self.assertAlmostEqual(view["G1_projected"], expected, places=12)
            self.assertEqual(view["visible"], self.exact(v).sum())

    def test_projected_mean_is_the_identity(self):
        """Every ray of a view meets the surface: the projected mean is cos/sigma, but for the finite number of points.

        Of the points of an even grid, those that fall beside the border of a shadow err: with 64^2 * 2 * 225 of them and
        borders some 10 % of the facets, far below 1e-3.
        """
        for v in VIEWS:
            view = measure(self.file, [v], None, "--subsamples=225")["views"][0]
            self.assertAlmostEqual(view["G1_projected"] / (v[2] / masking.sigma(self.slopes, v)), 1, delta=1e-3)
            self.assertGreater(view["G1_projected_error"], 0)

    def test_masking_is_invariant_on_baked_vertices(self):
        first = measure(self.file, VIEWS)
        for name, m in MAPS.items():
            for tracer, share in (("own", 2e-5), ("embree", 1e-3)):
                with self.subTest(map=name, tracer=tracer):
                    answer = measure(self.file, [maps.carried(m, v) for v in VIEWS], m, "--tracer", tracer)
                    for a, b in zip(first["views"], answer["views"]):
                        self.assertLessEqual(abs(a["visible"] - b["visible"]), share * a["facets"])
                        self.assertLessEqual(abs(a["front_facing"] - b["front_facing"]), 2e-5 * a["facets"])
                        self.assertAlmostEqual(a["G1_projected"], b["G1_projected"], delta=share)
                    for a, b in zip(first["pairs"], answer["pairs"]):
                        self.assertLessEqual(abs(a["both_visible"] - b["both_visible"]), share * 2 * self.N**2)

    def test_wrong_direction_is_noticed(self):
        first = measure(self.file, VIEWS)["views"]
        m = MAPS["skew"]
        for wrong in (np.eye(2), np.linalg.inv(m), m.T):
            views = measure(self.file, [maps.carried(wrong, v) for v in VIEWS], m)["views"]
            self.assertGreater(max(abs(a["visible"] - b["visible"]) for a, b in zip(first, views)), 1e-2 * 2 * self.N**2)

    def test_bins(self):
        m = MAPS["mirror"]
        v = maps.carried(m, VIEWS[1])
        slopes = mesh.baked_slopes(self.h, m)
        along = (v[0] * slopes[0] + v[1] * slopes[1]) / np.hypot(v[0], v[1])
        front = masking.facing(slopes, v) > 0
        view = measure(self.file, [v], m, "--bins=-2,-0.5,0,0.1")["views"][0]
        self.assertEqual([(b["from"], b["to"]) for b in view["bins"]], [(-2, -0.5), (-0.5, 0), (0, 0.1)])
        for b in view["bins"]:
            self.assertEqual(b["facets"], (front & (along >= b["from"]) & (along < b["to"])).sum())
        view = measure(self.file, [v], m, "--bins=7")["views"][0]
        self.assertEqual(sum(b["facets"] for b in view["bins"]), view["front_facing"])
        self.assertEqual(sum(b["visible"] for b in view["bins"]), view["visible"])
        for b in view["bins"]:
            self.assertAlmostEqual(b["facets"] / view["front_facing"], 1 / 7, delta=2e-3)
            self.assertTrue(0 <= b["G1"] <= 1 and b["G1_error"] >= 0)

    def test_threads_change_nothing(self):
        outs = {musurf("surface", "measure", self.file, "--view=1,0.3,0.4", "--view=-1,2,0.7", "--bins=5", "--tracer", tracer,
                       "--threads", threads).out for tracer in ("own",) for threads in (1, 2, 7)}
        self.assertEqual(len(outs), 1)

    def test_ridge_by_pencil(self):
        """A ridge of height 2, slopes 2 on both sides, one cell wide each: at tan 3 its shadow reaches six cells."""
        h = np.zeros((16, 16))
        h[0] = 2
        write_exr(self.file, h)
        answer = measure(self.file, [[3, 0, 1], [-3, 0, 1], [0, 3, 1]])
        counts = [(v["front_facing"], v["visible"]) for v in answer["views"]]
        self.assertEqual(counts, [(15 * 32, 10 * 32), (15 * 32, 10 * 32), (16 * 32, 16 * 32)])
        # the first two both see columns 6 to 9: (0...9) and (6...15)
        self.assertEqual((answer["pairs"][0]["facing_both"], answer["pairs"][0]["both_visible"]), (14 * 32, 4 * 32))

    def refused(self, words, *arguments):
        done = musurf("surface", "measure", *arguments)
        with self.subTest(arguments=arguments):
            self.assertEqual((done.returncode, done.out), (2, ""))
            self.assertRegex(done.err, r"^musurf surface measure: [^\n]*\n$")
            self.assertIn(words, done.err)

    def test_options_refused(self):
        view = "--view=1,0,1"
        for m in ("1,2,2,4", "0,0,0,0", "1e300,0,0,1e-300"):
            self.refused("singular", self.file, view, f"--transform={m}")
        self.refused("4 numbers", self.file, view, "--transform=1,0,1")
        self.refused("4 numbers", self.file, view, "--transform=1,0,0,nan")
        for v in ("1,0,0", "1,0,-1", "0,0,0"):
            self.refused("z > 0", self.file, f"--view={v}")
        self.refused("near the horizon", self.file, "--view=1,0,1e-9")
        self.refused("3 numbers", self.file, "--view=1,x,1")
        self.refused("a square", self.file, view, "--subsamples=10")
        self.refused("must rise", self.file, view, "--bins=1,0")
        self.refused("known: own, embree", self.file, view, "--tracer=pov")
        self.refused("--view is needed", self.file)
        self.refused("FILE is needed", view)

    def test_files_refused(self):
        bad, view = self.folder / "bad.exr", "--view=1,0,1"
        self.refused("No such file", self.folder / "none.exr", view)
        self.refused("not a regular file", self.folder, view)
        bad.write_text("no picture")
        self.refused("bad.exr: ", bad, view)
        write_exr(bad, self.h[:1])
        self.refused("is 64 x 1", bad, view)
        write_exr(bad, self.h, ("A", "Y"))
        self.refused("more than one channel; one is needed of A, Y", bad, view)
        self.refused('no channel "Z", but A, Y', bad, view, "--channel=Z")
        for value in (np.nan, np.inf):
            broken = self.h.copy()
            broken[3, 5] = value
            write_exr(bad, broken)
            self.refused("the height at x = 3, y = 5 is not finite", bad, view)
        whole = self.file.read_bytes()
        for length in (len(whole) // 2, len(whole) - 10):
            bad.write_bytes(whole[:length])
            self.refused("bad.exr", bad, view)


if __name__ == "__main__":
    unittest.main()
