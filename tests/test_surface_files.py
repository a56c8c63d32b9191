#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Heightfields of others: formats, units, borders, levels and holes. What was read is seen through `surface mesh`.

The files are written here, byte by byte from the formats' descriptions. That a border brings no artefacts is tested by
cutting a piece out of a larger surface: facets of the piece must be seen as they are in the larger one.
"""
import pathlib
import struct
import tempfile
import unittest
import zlib

import numpy as np

import exact_caster
from command import LEAKS, musurf, strict
from test_surface_command import MAPS, VIEWS, maps, heightfield, masking, numbers, write_exr
from test_surface_mesh import read_ply


def write_pgm(file, codes, most=65535, text=False):
    head = b"P%d\n# a comment\n%d %d\n%d\n" % (2 if text else 5, codes.shape[1], codes.shape[0], most)
    body = (" ".join(map(str, codes.ravel())).encode() if text
            else codes.astype(">u2" if most > 255 else "u1").tobytes())
    file.write_bytes(head + body)


def write_png(file, codes, chunks=()):
    """16-bit grey."""
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    rows, columns = codes.shape
    raw = b"".join(b"\0" + row.astype(">u2").tobytes() for row in codes)
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 16, 0, 0, 0, 0))
                     + b"".join(chunk(*c) for c in chunks) + chunk(b"IDAT", zlib.compress(raw)) + chunk(b"IEND", b""))


def write_tiff(file, values, code):
    """One strip, little-endian; code 1: whole numbers, 3: floats."""
    rows, columns = values.shape
    data = values.tobytes()
    tags = [(256, 3, columns), (257, 3, rows), (258, 3, 8 * values.itemsize), (259, 3, 1), (262, 3, 1), (273, 4, 8),
            (277, 3, 1), (278, 3, rows), (279, 4, len(data)), (339, 3, code)]
    directory = struct.pack("<H", len(tags)) + b"".join(struct.pack("<HHII", t, k, 1, v) for t, k, v in tags) + b"\0" * 4
    file.write_bytes(b"II*\0" + struct.pack("<I", 8 + len(data)) + data + directory)


class Files(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)
        self.random = np.random.default_rng(11)

    def heights(self, file, *options, warning=""):
        """What the commands measure, [nx, ny]; the mesh repeats the first row and column at the end."""
        out = self.folder / "read.ply"
        done = musurf("surface", "mesh", file, "-o", out, *options)
        self.assertEqual(done.returncode, 0, done.err)
        self.assertRegex(done.err, f"^musurf: [^\n]*{warning}[^\n]*\n$" if warning else "^$")
        points, _ = read_ply(out)
        nx, ny = points[:, :2].max(0).astype(int) + 1
        np.testing.assert_array_equal(points[:, 0].reshape(nx, ny)[:, 0], np.arange(nx))
        whole = points[:, 2].reshape(nx, ny)
        if "--border=crop" in options:
            return whole
        np.testing.assert_array_equal(whole[-1], whole[0])
        np.testing.assert_array_equal(whole[:, -1], whole[:, 0])
        return whole[:-1, :-1]

    def refused(self, words, file, *options):
        done = musurf("surface", "measure", file, "--view=1,0,1", *options, env=LEAKS)
        with self.subTest(file=file, options=options):
            self.assertEqual((done.returncode, done.out), (2, ""))
            self.assertRegex(done.err, r"^musurf surface measure: [^\n]*\n$")
            self.assertIn(words, done.err)


class Formats(Files):
    def test_codes_are_taken_as_they_are(self):
        codes = self.random.integers(0, 65536, (12, 20))
        low = codes % 200
        gamma = [(b"gAMA", struct.pack(">I", 45455))], [(b"sRGB", b"\0")], []
        files = []
        for k, chunks in enumerate(gamma):
            write_png(self.folder / f"{k}.png", codes, chunks)
            files.append((f"{k}.png", codes))
        write_pgm(self.folder / "wide.pgm", codes)
        write_pgm(self.folder / "text.pgm", codes, text=True)
        write_pgm(self.folder / "bytes.pgm", low, 199)
        write_tiff(self.folder / "16.tif", codes.astype("<u2"), 1)
        write_tiff(self.folder / "8.tif", low.astype("u1"), 1)
        write_tiff(self.folder / "float.tif", (codes / 7).astype("<f4"), 3)
        write_tiff(self.folder / "double.tif", (codes / 7).astype("<f8"), 3)
        write_exr(self.folder / "float.exr", codes / 7)
        write_exr(self.folder / "half.exr", low.astype(float), kind=1)
        files += [("wide.pgm", codes), ("text.pgm", codes), ("bytes.pgm", low), ("16.tif", codes), ("8.tif", low),
                  ("float.tif", (codes / 7).astype("f4")), ("double.tif", codes / 7),
                  ("float.exr", (codes / 7).astype("f4")), ("half.exr", low)]
        for name, expected in files:
            with self.subTest(file=name):
                np.testing.assert_array_equal(self.heights(self.folder / name), expected)
        np.testing.assert_array_equal(self.heights(self.folder / "wide.pgm", "--cell=0.3", "--height-scale=1.7e-4"),
                                      codes.astype(float) * 1.7e-4 / 0.3)

    def test_channels(self):
        h = self.random.standard_normal((6, 9)).astype(np.float32)
        for name in ("height", "depth.Z"):
            write_exr(self.folder / "one.exr", h, (name,))
            np.testing.assert_array_equal(self.heights(self.folder / "one.exr"), h)
        write_exr(self.folder / "two.exr", h, ("A", "Z"))
        both = bytearray((self.folder / "two.exr").read_bytes())
        for k in range(6):  # a scanline holds its channels one after the other; A becomes another picture
            start = len(both) - (6 - k) * (8 + 72) + 8
            both[start:start + 36] = (h[k] + 1).tobytes()
        (self.folder / "two.exr").write_bytes(bytes(both))
        np.testing.assert_array_equal(self.heights(self.folder / "two.exr", "--channel=Z"), h)
        np.testing.assert_array_equal(self.heights(self.folder / "two.exr", "--channel=A"), h + 1)

    def test_refusals(self):
        codes = self.random.integers(0, 256, (5, 7))
        file = self.folder / "bad.pgm"
        write_pgm(file, codes, 255)
        whole = file.read_bytes()
        file.write_bytes(whole[:-1])
        self.refused("truncated", file)
        file.write_bytes(b"P5\n5 7\n")
        self.refused("damaged", file)
        write_pgm(file, codes, 100)
        self.refused("above the largest", file)
        write_pgm(file, codes[:1], 255)
        self.refused("is 7 x 1", file)
        write_png(self.folder / "bad.png", codes)
        self.refused('no channel "R", but', self.folder / "bad.png", "--channel=R")
        (self.folder / "bad.png").write_bytes((self.folder / "bad.png").read_bytes()[:60])
        self.refused("bad.png: ", self.folder / "bad.png")
        write_pgm(file, codes, 255)
        for option, words in (("--cell=0", "above 0"), ("--cell=-1", "above 0"), ("--height-scale=0", "is 0"),
                              ("--border=wrap", "periodic, crop, mirror, blend"), ("--level=all", "none, mean, plane"),
                              ("--height-scale=1e300", "too large"), ("--border=blend", "at least 16 pixels")):
            self.refused(words, file, option)


class Shapes(Files):
    def test_rectangles_are_seen_exactly(self):
        """nx != ny: counts by the exact caster, and masking invariance on baked vertices."""
        h = 3 * heightfield.make(40, 0.5, 4.0, 3)[:24, :].astype(np.float32).astype(float)
        file = self.folder / "h.exr"
        for turned in (h, h.T):
            write_exr(file, turned)
            slopes = heightfield.slopes(turned)
            i, j = np.meshgrid(*map(np.arange, turned.shape), indexing="ij")
            exact = [exact_caster.visible(turned, np.stack([i + 0.25, i + 0.75], 2), np.stack([j + 0.5, j + 0.5], 2),
                                          masking.facing(slopes, v) > 0, v).transpose(2, 0, 1) for v in VIEWS]
            for name, m in {"identity": np.eye(2), **MAPS}.items():
                for tracer, share in (("own", 2e-5), ("embree", 1e-3)):
                    with self.subTest(shape=turned.shape, map=name, tracer=tracer):
                        done = musurf("surface", "measure", file, f"--transform={numbers(m)}", "--tracer", tracer, "--bits",
                                      self.folder / "b.npy", *[f"--view={numbers(maps.carried(m, v))}" for v in VIEWS])
                        self.assertEqual(done.returncode, 0, done.err)
                        bits = np.load(self.folder / "b.npy")
                        self.assertEqual(bits.shape, (3, 2, *turned.shape))
                        for seen, expected in zip(bits, exact):
                            self.assertLessEqual((seen != expected).sum(), max(1, share * expected.size))


class Borders(Files):
    def test_cropped_pieces_see_what_the_whole_sees(self):
        whole = heightfield.make(128, 0.4, 5.0, 5).astype(np.float32).astype(float)
        piece = whole[10:100, 20:122]
        write_exr(self.folder / "whole.exr", whole)
        write_exr(self.folder / "piece.exr", piece)
        for name, m in {"identity": np.eye(2), **MAPS}.items():
            with self.subTest(map=name):
                views = [f"--view={numbers(maps.carried(m, v))}" for v in (maps.direction(60, 20), maps.direction(80, 200))]
                answers, bits = [], []
                for file, border in (("whole.exr", "periodic"), ("piece.exr", "crop")):
                    done = musurf("surface", "measure", self.folder / file, *views, f"--transform={numbers(m)}",
                                  f"--border={border}", "--bits", self.folder / "b.npy", "--bins=4")
                    self.assertEqual((done.returncode, done.err), (0, ""))
                    answers.append(strict(done.out))
                    bits.append(np.load(self.folder / "b.npy"))
                for k, view in enumerate(answers[1]["views"]):
                    i0, i1, j0, j1 = (int(x) for x in view["window"])
                    self.assertEqual(view["facets"], 2 * (i1 - i0) * (j1 - j0))
                    self.assertGreater(view["facets"], 3000)
                    outside = bits[1][k].copy()
                    outside[:, i0:i1, j0:j1] = 0
                    self.assertEqual(outside.sum(), 0)
                    inside = bits[1][k][:, i0:i1, j0:j1]
                    self.assertLessEqual((inside != bits[0][k][:, 10 + i0:10 + i1, 20 + j0:20 + j1]).sum(), 1)
                    self.assertEqual(view["visible"], inside.sum())
                    self.assertEqual(sum(b["visible"] for b in view["bins"]), inside.sum())
                self.assertGreater(answers[1]["pairs"][0]["both_visible"], 0)
        self.refused("all its rays may leave", self.folder / "piece.exr", "--border=crop", "--view=1,0,0.001")

    def test_mirror_and_crop_and_blend(self):
        h = self.random.standard_normal((32, 48)).astype(np.float32).astype(float)
        write_exr(self.folder / "h.exr", h)
        np.testing.assert_array_equal(self.heights(self.folder / "h.exr", "--border=crop"), h)
        folded = np.concatenate([h, h[-2:0:-1]], 0)
        folded = np.concatenate([folded, folded[:, -2:0:-1]], 1)
        np.testing.assert_array_equal(self.heights(self.folder / "h.exr", "--border=mirror"), folded)
        faded = h - h.mean()
        for axis in (0, 1):
            faded = np.moveaxis(faded, axis, 0)
            strip = len(faded) // 8
            t = np.pi / 2 * np.arange(strip)[:, None] / strip
            faded = np.concatenate([np.sin(t) * faded[:strip] + np.cos(t) * faded[-strip:], faded[strip:-strip]])
            faded = np.moveaxis(faded, 0, axis)
        np.testing.assert_allclose(self.heights(self.folder / "h.exr", "--border=blend"), faded + h.mean(), atol=1e-12)
        # weights of squares that add up to 1: the variance of noise stays, within its standard error sqrt(2/1152)
        self.assertAlmostEqual(faded.var(), h.var(), delta=4 * np.sqrt(2 / faded.size))

    def test_broken_borders_are_noticed(self):
        codes = np.add.outer(100 * np.arange(16), np.zeros(16, int))  # a ramp
        write_pgm(self.folder / "ramp.pgm", codes)
        self.heights(self.folder / "ramp.pgm", warning="do not go on across the border")
        for border in ("periodic", "crop", "mirror", "blend"):
            self.heights(self.folder / "ramp.pgm", f"--border={border}")
        self.heights(self.folder / "ramp.pgm", "--level=plane")


class Reading(Files):
    """`surface read`: what it writes is, read without options, what other commands saw of the file with them."""

    def read(self, file, *options, warning=""):
        out = self.folder / "common.exr"
        done = musurf("surface", "read", file, "-o", out, *options)
        self.assertEqual(done.returncode, 0, done.err)
        self.assertRegex(done.err, warning or "^$")
        said = strict(done.out)
        self.assertEqual((said["file"], said["from"]), (str(out), str(file)))
        return out, said

    def test_the_common_form_is_the_same_surface(self):
        codes = self.random.integers(0, 65536, (20, 31))
        write_png(self.folder / "h.png", codes)
        write_pgm(self.folder / "h.pgm", codes)
        write_tiff(self.folder / "h.tif", codes.astype("<u2"), 1)
        units = ["--cell=0.3", "--height-scale=1.7e-4"]
        for name, border, size in (("h.png", "periodic", (20, 31)), ("h.pgm", "mirror", (38, 60)), ("h.tif", "blend", (18, 28)),
                                   ("h.png", "crop", (19, 30))):
            with self.subTest(file=name, border=border):
                options = [*units, f"--border={border}", "--level=plane"]
                out, said = self.read(self.folder / name, *options)
                again = ["--border=crop"] if border == "crop" else []
                exact = self.heights(self.folder / name, *options)
                found = self.heights(out, *again)
                np.testing.assert_array_equal(found, exact.astype(np.float32))
                self.assertEqual((said["pixels"], said["size"], said["repeats"]), ([20, 31], list(size), border != "crop"))
                self.assertEqual(said["rounded"], abs(found - exact).max())
                self.assertAlmostEqual(said["range"], np.ptp(exact), places=12)
                i, j = np.meshgrid(np.arange(20) - 9.5, np.arange(31) - 15.0, indexing="ij")
                plane, _, _, _ = np.linalg.lstsq(np.stack([np.ones_like(i), i, j], -1).reshape(-1, 3),
                                                 codes.ravel() * 1.7e-4 / 0.3, rcond=None)
                np.testing.assert_allclose(said["plane"], plane, rtol=1e-9)

    def test_holes_are_counted_and_what_is_no_float_is_refused(self):
        h = self.random.standard_normal((8, 9))
        h[3, 4:6] = np.nan
        write_exr(self.folder / "h.exr", h)
        _, said = self.read(self.folder / "h.exr", "--fill", warning="2 heights")
        self.assertEqual((said["filled"], said["level"], said["plane"]), (2, "none", [0, 0, 0]))
        for words, options in (("not finite", []), ("too large for a float", ["--fill", "--height-scale=1e40"])):
            out = self.folder / "none.exr"
            done = musurf("surface", "read", self.folder / "h.exr", "-o", out, *options)
            self.assertEqual((done.returncode, done.out, out.exists()), (2, "", False))
            self.assertIn(words, done.err)


class Repairs(Files):
    def test_level(self):
        i, j = np.meshgrid(np.arange(20.0), np.arange(30.0), indexing="ij")
        h = self.random.standard_normal((20, 30))
        term = np.stack([np.ones_like(i), i, j], -1).reshape(-1, 3)
        tilted = (h + 5 + 0.3 * i - 0.2 * j).astype(np.float32).astype(float)
        write_exr(self.folder / "h.exr", tilted)
        np.testing.assert_allclose(self.heights(self.folder / "h.exr", "--level=mean"), tilted - tilted.mean(), atol=1e-12)
        fit = term @ np.linalg.lstsq(term, tilted.ravel(), rcond=None)[0]
        np.testing.assert_allclose(self.heights(self.folder / "h.exr", "--level=plane"), tilted - fit.reshape(20, 30), atol=1e-12)

    def test_holes(self):
        """x^2 - y^2 + xy/2 + x solves Laplace's equation on the lattice, too: holes inside are closed exactly."""
        i, j = np.meshgrid(np.arange(24.0), np.arange(28.0), indexing="ij")
        h = i * i - j * j + i * j / 2 + i
        broken = h.copy()
        broken[5:14, 6:17], broken[20, 3], broken[18:20, 22:25] = np.nan, np.inf, -np.inf
        write_exr(self.folder / "h.exr", broken)
        count = 9 * 11 + 1 + 6
        self.refused(f"x = 5, y = 6 is not finite ({count} of 672", self.folder / "h.exr")
        read = self.heights(self.folder / "h.exr", "--fill", warning=f"{count} heights")
        # it stops when nothing moves by 1e-6 of the extent; errors shrink by 1.8 - 1 a pass, so that 1e-6/(1 - 0.8) are left
        np.testing.assert_allclose(read, h, atol=1e-5 * np.ptp(h))
        np.testing.assert_array_equal(read[np.isfinite(broken)], h[np.isfinite(broken)])
        broken[0, 0] = np.nan  # at the edge: something between its neighbours
        write_exr(self.folder / "h.exr", broken)
        read = self.heights(self.folder / "h.exr", "--fill", warning=f"{count + 1} heights")
        self.assertTrue(min(h[0, 1], h[1, 0]) <= read[0, 0] <= max(h[0, 1], h[1, 0]))
        write_exr(self.folder / "h.exr", np.full((4, 4), np.nan))
        self.refused("16 of 16", self.folder / "h.exr", "--fill")


if __name__ == "__main__":
    unittest.main()
