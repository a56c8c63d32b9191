#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Histograms of slopes on the command line: inline, from an image and from a heightfield they are the same distribution; the
heightfield's slopes are counted again here with numpy. Images are written here, from the file format's description."""
import pathlib
import struct
import sys
import tempfile
import unittest
import zlib

import numpy

from command import answers, microfacet, musurf

VIEWS = [([0.3, 0.2, 0.9], [-0.2, 0.1, 0.8]), ([0.9, -0.3, 0.1], [-0.7, 0.2, 0.3]), ([0, 0, 1], [0.1, 0.6, 0.5])]


def write_exr(path, planes, compression=0):
    """float32 channels by name; compression 0 (none) or 2 (ZIPS: one line, bytes split, differences, zlib)."""
    height, width = next(iter(planes.values())).shape
    names = sorted(planes)
    channels = b"".join(name.encode() + b"\0" + struct.pack("<iIii", 2, 0, 1, 1) for name in names) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    attributes = [("channels", "chlist", channels), ("compression", "compression", bytes([compression])),
                  ("dataWindow", "box2i", box), ("displayWindow", "box2i", box), ("lineOrder", "lineOrder", b"\0"),
                  ("pixelAspectRatio", "float", struct.pack("<f", 1)), ("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)),
                  ("screenWindowWidth", "float", struct.pack("<f", 1))]
    head = struct.pack("<II", 20000630, 2) + b"".join(
        name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value
        for name, kind, value in attributes) + b"\0"
    lines = []
    for y in range(height):
        data = b"".join(planes[name][y].astype("<f4").tobytes() for name in names)
        if compression:
            split = numpy.frombuffer(data[0::2] + data[1::2], numpy.uint8).astype(int)
            step = numpy.concatenate([split[:1], (numpy.diff(split) + 128) % 256]).astype(numpy.uint8)
            packed = zlib.compress(step.tobytes())
            data = packed if len(packed) < len(data) else data
        lines.append(struct.pack("<ii", y, len(data)) + data)
    offsets, at = [], len(head) + 8 * height
    for line in lines:
        offsets.append(at)
        at += len(line)
    pathlib.Path(path).write_bytes(head + struct.pack(f"<{height}Q", *offsets) + b"".join(lines))


def tabulated(histogram, **more):
    return microfacet(ndf="tabulated", histogram=histogram, **more)


class Tabulated(unittest.TestCase):
    def setUp(self):
        self.room = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.room.name)
        self.rng = numpy.random.default_rng(601)

    def tearDown(self):
        self.room.cleanup()

    def look(self, material, precision="double"):
        queries = [{"material": material, "wo": wo, "wi": wi} for wo, wi in VIEWS]
        done = musurf("eval", "--precision", precision, stdin=queries, cwd=self.folder)
        self.assertEqual(done.returncode, 0, done.out)
        return answers(done)

    def refused(self, material, word):
        done = musurf("eval", stdin=[{"material": material, "wo": [0, 0, 1]}], cwd=self.folder)
        self.assertEqual(done.returncode, 1)
        self.assertIn(word, answers(done)[0]["error"])

    def test_an_image_is_the_inline_table(self):
        weights = self.rng.random((5, 9)).astype(numpy.float32)
        bounds = [-0.8, 1.1, -0.4, 0.9]
        inline = tabulated({"columns": 9, "rows": 5, "bounds": bounds, "weights": weights.tolist()}, transform=[[1, 2], [0, 1]])
        for compression in (0, 2):
            write_exr(self.folder / "slopes.exr", {"Y": weights}, compression)
            image = tabulated({"bounds": bounds, "file": "slopes.exr"}, transform=[[1, 2], [0, 1]])
            self.assertEqual(self.look(image), self.look(inline))

    def heights(self, n=48):
        """Smooth and periodic: a sum of waves."""
        i, j = numpy.meshgrid(numpy.arange(n), numpy.arange(n), indexing="ij")
        waves = sum(self.rng.normal() * numpy.sin(2 * numpy.pi * (a * i + b * j) / n + 7 * self.rng.random())
                    for a in range(4) for b in range(1, 5))
        return waves.astype(numpy.float32)

    @staticmethod
    def slopes(h):
        """(dz/dx, dz/dy) of the triangles (i,j),(i+1,j),(i,j+1) and (i+1,j+1),(i,j+1),(i+1,j); scanline i = x, pixel j = y."""
        h = h.astype(float)
        right, up, both = numpy.roll(h, -1, 0), numpy.roll(h, -1, 1), numpy.roll(numpy.roll(h, -1, 0), -1, 1)
        x = numpy.concatenate([(right - h).ravel(), (both - up).ravel()])
        y = numpy.concatenate([(up - h).ravel(), (both - right).ravel()])
        return x, y

    def test_a_heightfield_is_its_slopes(self):
        square = self.heights()
        for h in (square, square[:, :30] / 8):  # the oblong one steps where it repeats
            x, y = self.slopes(h)
            write_exr(self.folder / "h.exr", {"height": h})
            bounds = [-4, 5, -6, 3]
            self.assertTrue(x.min() > -4 and x.max() < 5 and y.min() > -6 and y.max() < 3)  # and lopsided on purpose
            counts, _, _ = numpy.histogram2d(y, x, bins=24, range=[bounds[2:], bounds[:2]])
            inline = tabulated({"bounds": bounds, "weights": counts.tolist()})
            self.assertEqual(self.look(tabulated({"heightfield": "h.exr", "bins": 24, "range": bounds})), self.look(inline))

    def test_without_a_range_all_slopes_count(self):
        """The projected area from a direction that sees every facet is w.(-mean slope, 1): here 0, the surface being periodic."""
        h = self.heights() / 100
        write_exr(self.folder / "h.exr", {"height": h})
        material = tabulated({"heightfield": "h.exr", "bins": 200})
        for precision, tolerance in (("double", 1e-3), ("float", 1e-3)):  # the mean of a histogram is off by part of a cell
            self.assertAlmostEqual(self.look(material, precision)[2]["sigma"], 1, delta=tolerance)
        # From the side, against the sum over facets. Cells round slopes by a 400th of their range of 0.2 at most.
        x, y = self.slopes(h)
        w = numpy.array(VIEWS[1][0]) / numpy.linalg.norm(VIEWS[1][0])
        area = numpy.maximum(0, w[2] - w[0] * x - w[1] * y).mean()
        self.assertAlmostEqual(self.look(material)[1]["sigma"], area, delta=5e-4)

    def test_a_flat_heightfield_is_nearly_a_mirror(self):
        write_exr(self.folder / "flat.exr", {"height": numpy.zeros((4, 4), numpy.float32)})
        for answer in self.look(tabulated({"heightfield": "flat.exr", "bins": 3})):
            self.assertAlmostEqual(answer["G2"], 1, places=9)

    def test_scene_files_name_images_beside_them(self):
        (self.folder / "data").mkdir()
        write_exr(self.folder / "data/h.exr", {"height": self.heights()})
        scene = self.folder / "scene.json"
        scene.write_text("""{"musurf": 1, "camera": {"position": [0, -3, 2], "target": [0, 0, 0], "fov": 40},
            "film": {"width": 16, "height": 12}, "materials": {"m": {"material": "musurf.microfacet", "ndf": "tabulated",
            "histogram": {"heightfield": "data/h.exr", "bins": 32}}},
            "objects": [{"shape": "sphere", "radius": 1, "material": "m"}], "lights": [{"type": "constant", "radiance": 1}]}""")
        done = musurf("render", scene, "-o", self.folder / "out.exr", "--spp", "4", "--explain")
        self.assertEqual(done.returncode, 0, done.err)
        self.assertIn("tabulated table", done.out + done.err)

    def test_samples_are_drawn(self):
        material = tabulated({"bounds": [-1, 1, -1, 1], "weights": [[0, 1], [2, 0]]})
        done = musurf("sample", "--n", 50, "--seed", 3, stdin=[{"material": material, "wo": [0.2, 0.1, 0.9]}])
        self.assertEqual(done.returncode, 0, done.err)
        for line in answers(done):
            x, y = -line["wm"][0] / line["wm"][2], -line["wm"][1] / line["wm"][2]
            self.assertLess(x * y, 0)  # row 0 is y < 0, column 0 is x < 0
            self.assertLessEqual(max(abs(x), abs(y)), 1)

    def test_what_cannot_be_read_is_told(self):
        one = numpy.ones((4, 4), numpy.float32)
        bounds = [-1, 1, -1, 1]
        self.refused(tabulated({"bounds": bounds, "file": "none.exr"}), "none.exr")
        (self.folder / "text.exr").write_text("no image")
        self.refused(tabulated({"bounds": bounds, "file": "text.exr"}), "text.exr")
        write_exr(self.folder / "two.exr", {"A": one, "B": one})
        self.refused(tabulated({"bounds": bounds, "file": "two.exr"}), "more than one channel")
        write_exr(self.folder / "nan.exr", {"Y": one * numpy.float32("nan")})
        self.refused(tabulated({"bounds": bounds, "file": "nan.exr"}), "no finite number")
        write_exr(self.folder / "negative.exr", {"Y": -one})
        self.refused(tabulated({"bounds": bounds, "file": "negative.exr"}), "out of range")
        write_exr(self.folder / "h.exr", {"Y": self.heights()})
        self.refused(tabulated({"heightfield": "h.exr", "range": [-1, 0.1, -1, 0.1]}), "lie outside")
        truncated = (self.folder / "h.exr").read_bytes()[:-100]
        (self.folder / "short.exr").write_bytes(truncated)
        self.refused(tabulated({"heightfield": "short.exr"}), "short.exr")


if __name__ == "__main__":
    sys.exit(unittest.main())
