#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The page in headless Chromium, opened from the disk, offline, worked by its own controls: what it shows is what `musurf eval` and `musurf
ibl axis` say, to rounding.

How much rounding. Page and command run the same C, without fused products on either side; they differ by their libraries' sine, cosine,
exponential and the like (1 ulp each or so), and by an ulp of each direction, which the command normalises again. An ulp e of a direction is one of
the slope s, and moves ln D by at most e |d ln D / d s| of the narrowest distribution here, e 4 / alpha_least with alpha_least = 0.0121 / 5, beside
a factor of a few for sums: 1.1e-16 * 1700 * 5 = 9e-13. So 1e-12 relative for what eval says. Of the axis the ends are as well conditioned as the
difference of the squared sigmas to their sum (1e3 at most, here 10), and components of micronormals are compared with 1."""
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import chromium
import exr
from command import BUILD, ROOT, answers, microfacet, musurf

LEFT_OUT = 77
BOUND = 1e-12
PAGE = BUILD / "musurf.html"
READY = "document.documentElement.dataset.ready && Number(document.getElementById('status').dataset.frames) > 0"

# Keys of the page's controls and what the command is told; each differs from the page as it opens.
CASES = [
    {"ndf": "gtr", "roughness": 0.5, "gamma": 1.7, "M": [1, 2, 0, 1], "view": [60, 40], "light": [50, -110], "metal": "Ag"},
    {"ndf": "gtr", "roughness": 0.11, "gamma": 1.7, "M": [5, 0, 0.25, 1], "view": [30, 10], "light": [31, -171], "metal": "none"},
    {"ndf": "ggx", "roughness": 0.7, "M": [-0.8, 1.4, 0.5, 0.6], "view": [80, -130], "light": [70, 65], "metal": "Au"},
    {"ndf": "beckmann", "roughness": 0.6, "M": [2.5, -1, 0.5, 0.75], "view": [20, 140], "light": [35, 0], "metal": "none", "masking": "separable"},
    {"ndf": "std", "roughness": 0.55, "gamma": 2.5, "M": [0.5, 0.25, -0.75, 1.5], "view": [75, 5], "light": [65, 170], "metal": "Cu",
     "masking": "direction_correlated"},
    {"ndf": "sheen", "roughness": 0.8, "M": [1.5, 0.5, 0, 1], "view": [45, 100], "light": [55, -20], "metal": "none"},
    {"ndf": "phong", "exponent": 40, "M": [1.25, 0.5, 0.25, 0.75], "view": [55, -60], "light": [40, 100], "metal": "none"},
]
for CASE in CASES:
    CASE.setdefault("masking", "height_correlated")
AXIS = ("t", "far", "near", "tau", "far_clamped", "delta", "width", "length", "zeta", "radius")


def need():
    """Without a browser, or a compiler to WebAssembly, the test is left out."""
    lacking = [name for name, there in (("chromium", chromium.program()), ("clang", shutil.which("clang")), ("wasm-ld", shutil.which("wasm-ld")),
                                        ("wasi-libc", pathlib.Path("/usr/lib/wasm32-wasi/libc.a").exists())) if not there]
    if lacking:
        print(f"{', '.join(lacking)} not installed: HOSTS=page scripts/install does that")
        sys.exit(LEFT_OUT)


def direction(angles):
    theta, phi = map(math.radians, angles)
    return [math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)]


def material_of(case):
    given = {key: case[key] for key in ("ndf", "roughness", "gamma", "exponent", "masking") if key in case}
    if case["metal"] != "none":
        given["fresnel"] = {"conductor": case["metal"]}
    return microfacet(**given, transform=[case["M"][:2], case["M"][2:]])


def flat(values):
    return [x for value in values for x in flat(value)] if isinstance(values, list) else [values]


class Shown(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.page = chromium.Page(PAGE.as_uri()).__enter__()
        cls.addClassCleanup(cls.page.__exit__)
        cls.page.until(READY)

    def put(self, key, value):
        """As a person does: a value into the last control of that key, and the event that a browser sends."""
        self.page.run(f"""(() => {{
            const input = [...document.querySelectorAll('[data-key="{key}"]')].at(-1);
            input.value = {str(value)!r};
            input.dispatchEvent(new Event("input", {{ bubbles: true }}));
        }})()""")

    def put_all(self, case):
        before = self.page.run("Number(document.documentElement.dataset.shown)")
        for key, value in case.items():
            if isinstance(value, list):
                for index, each in enumerate(value):
                    self.put(f"{key}.{index}", each)
            else:
                self.put(key, value)
        self.page.until(f"Number(document.documentElement.dataset.shown) > {before} && !musurf.asked")

    def numbers(self):
        """What stands in the tables, by name."""
        shown = self.page.run("Object.fromEntries([...document.querySelectorAll('[data-name]')].map((e) => [e.dataset.name, e.textContent]))")
        return {name: [float(word) for word in text.replace("∞", "inf").split()] for name, text in shown.items()}

    def agree(self, shown, said, bound, least=0.0):
        """The worst difference, relative, or to `least` where that is more; over the bound it fails."""
        said, worst = flat(said), 0
        self.assertEqual(len(shown), len(said))
        for a, b in zip(shown, said):
            worst = max(worst, abs(a - b) / max(abs(b), least, 1e-300))
        self.assertLessEqual(worst, bound, f"shown {shown}, said {said}")
        return worst

    def ask_eval(self, case, shown):
        return answers(musurf("eval", stdin=[{"material": material_of(case), "wo": direction(case["view"]), "wi": direction(case["light"]),
                                              "wm": shown["wm"]}]))[0]

    def test_numbers_are_those_of_eval(self):
        worst = 0
        for case in CASES:
            with self.subTest(**case):
                self.put_all(case)
                shown = self.numbers()
                said = self.ask_eval(case, shown)
                half = [a + b for a, b in zip(direction(case["view"]), direction(case["light"]))]
                self.agree(shown["wm"], [c / math.hypot(*half) for c in half], 4e-16, 1)
                for name in ("Lambda", "sigma", "D", "G1", "Dv", "f", "F", "G2", "pdf"):
                    worst = max(worst, self.agree(shown[name], said[name], BOUND))
                self.agree(shown["f_cos"], [f * direction(case["light"])[2] for f in said["f"]], BOUND)
                self.assertGreater(min(shown["f"]), 0)
        print(f"at most {worst:.1e} from musurf eval")

    def test_a_wrong_map_is_found(self):
        """The transposed M, its inverse up to a factor, one row for the other: none of them says the same. (One column for the other does.)"""
        for case in CASES:
            self.put_all(case)
            shown, (a, c, b, d) = self.numbers(), case["M"]
            for wrong in ([a, b, c, d], [d, -c, -b, a], [b, d, a, c]):
                said = self.ask_eval({**case, "M": wrong}, shown)
                with self.subTest(wrong=wrong, **case), self.assertRaises(AssertionError):
                    for name in ("sigma", "D", "f"):
                        self.agree(shown[name], said[name], BOUND)

    def test_numbers_are_those_of_the_axis(self):
        settings = [{"N": 8, "k": 1, "beta": 2.3, "appendix_c": "symmetric"}, {"N": 23, "k": 1.5, "beta": 1.25, "appendix_c": "printed"}]
        worst = 0
        for i, case in enumerate(CASES):
            with self.subTest(**case):
                own = settings[i % 2]
                self.put_all({**case, **own})
                shown = self.numbers()
                said = answers(musurf("ibl", "axis", stdin=[{"sigma": shown["slope_sigma"], "angle": shown["angle"][0],
                                                             "wo": direction(case["view"]), **own}]))[0]
                for name in AXIS:
                    worst = max(worst, self.agree(shown[name], said[name], BOUND, 1 if name in ("far", "near", "far_clamped", "t", "tau") else 1e-3))
                self.hold_samples(said["samples"], direction(case["view"]))
        self.put_all(settings[0])
        print(f"at most {worst:.1e} from musurf ibl axis")

    def hold_samples(self, samples, wo):
        """The dots of the three panels stand where the samples are, seen by the projections of panel.h."""
        def equal_area(w):
            return [c / math.sqrt(1 + w[2]) / 1.1 for c in w[:2]]

        reach = self.page.run("musurf.panels[0].reach")
        seen = [lambda m: [-m[0] / m[2] / reach, -m[1] / m[2] / reach], equal_area,
                lambda m: equal_area([2 * sum(a * b for a, b in zip(m, wo)) * c - o for c, o in zip(m, wo)])]
        for panel, project in zip(("slopes", "normals", "reflected"), seen):
            path = self.page.run(f"document.querySelector('#{panel} path.samples').getAttribute('d')")
            dots = [[float(x) for x in dot.split()] for dot in path.replace("h0", "").split("M")[1:]]
            self.assertEqual(len(dots), len(samples))
            for dot, micronormal in zip(dots, samples):
                x, y = project(micronormal)
                self.assertAlmostEqual(dot[0], x, delta=1e-4)  # written in ten-thousandths
                self.assertAlmostEqual(dot[1], -y, delta=1e-4)

    def test_slopes_have_the_covariance_of_M(self):
        """Sigma = alpha² / 2 (M M^T)^-1 of GGX, by its axes."""
        case = CASES[2]
        self.put_all(case)
        shown, (a, c, b, d) = self.numbers(), case["M"]
        scale = case["roughness"] ** 4 / 2 / (a * d - b * c) ** 2
        wanted = [scale * (b * b + d * d), -scale * (a * b + c * d), scale * (a * a + c * c)]
        (u, v), (angle,) = shown["slope_sigma"], shown["angle"]
        x, y = math.cos(angle), math.sin(angle)
        self.agree([u * u * x * x + v * v * y * y, (u * u - v * v) * x * y, u * u * y * y + v * v * x * x], wanted, BOUND)

    def test_lines_to_copy_answer_the_same(self):
        self.put_all(CASES[0])
        shown, lines = self.numbers(), [self.page.run(f"document.getElementById('{name}-line').textContent") for name in ("eval", "axis")]
        said = answers(musurf("eval", stdin=lines[0])) + answers(musurf("ibl", "axis", stdin=lines[1]))
        self.agree(shown["D"] + shown["pdf"], [said[0]["D"], said[0]["pdf"]], BOUND)
        self.agree(shown["width"] + shown["length"], [said[1]["width"], said[1]["length"]], BOUND)

    def test_columns_are_dragged_and_moved_by_keys(self):
        self.put_all({"M": [1, 0, 0, 1]})
        box = self.page.run("(({left, top, width, height}) => [left, top, width, height])(document.getElementById('map').getBoundingClientRect())")
        at = [[box[0] + box[2] * (1 + x / 3) / 2, box[1] + box[3] * (1 - y / 3) / 2] for x, y in ((0, 1), (1.5, 1.2))]
        for kind, (x, y) in (("mousePressed", at[0]), ("mouseMoved", at[1]), ("mouseReleased", at[1])):
            self.page.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)
        M = self.page.run("musurf.state.M")
        for got, wanted in zip(M, (1, 1.5, 0, 1.2)):
            self.assertAlmostEqual(got, wanted, delta=0.01 + 3 / box[2] * 2)  # hundredths, and a pixel
        self.page.run("document.querySelector('#map .column1').focus()")
        for key in ("ArrowRight", "ArrowUp"):
            self.page.call("Input.dispatchKeyEvent", type="keyDown", key=key)
        for got, wanted in zip(self.page.run("musurf.state.M"), (M[0], M[1] + 0.02, M[2], M[3] + 0.02)):
            self.assertAlmostEqual(got, wanted, delta=1e-9)

    def test_address_holds_the_state(self):
        self.put_all(CASES[1])
        wanted = self.numbers()
        self.page.until("location.hash.includes('roughness=0.11')")
        address = self.page.run("location.hash")
        self.page.run("document.getElementById('reset').click()")
        self.page.until("!location.hash.includes('roughness') && !musurf.asked")
        self.assertNotEqual(self.numbers()["D"], wanted["D"])
        self.page.run(f"location.hash = {address!r}")
        self.page.until("musurf.state.roughness === 0.11 && !musurf.asked")
        self.assertEqual(self.numbers(), wanted)

    def test_a_singular_map_is_refused(self):
        self.put_all({"M": [1, 2, 0, 1]})
        before = self.numbers()
        self.put("M.3", 0)
        self.assertIn("transform", self.page.run("document.getElementById('complaint').textContent"))
        self.assertEqual(self.numbers(), before)
        self.put("M.3", 1)
        self.assertEqual(self.page.run("document.getElementById('complaint').textContent"), "")

    def sphere(self, case, technique, around="studio", passes=1, size=64):
        """Radiance of the page's sphere in surroundings turned by 90 degrees, as its workers compute it."""
        self.put_all({**case, "N": 8, "k": 1, "beta": 2.3, "appendix_c": "symmetric"})
        flat = self.page.run(f"""(() => {{
            const {{ core, material, query, choices }} = musurf, place = core.malloc(8 * 7), size = {size}, passes = {passes};
            const technique = choices.technique.indexOf({technique!r}), sampled = {technique!r} === "sampled";
            globalThis.made ??= {{}};
            const light = made[{around!r}] ??= core.page_surroundings_new(choices.surroundings.indexOf({around!r}), 512);
            new Float64Array(core.memory.buffer, place, 7).set([size, technique, {math.radians(90)}, 1, 0, 0, 1]);
            const sphere = core.page_sphere_new(), rows = core.malloc(24 * size), sums = core.malloc(24 * size), seen = [];
            core.page_sphere_set(sphere, material, light, query.place, place, 4096);
            for (let row = 0; row < size / 2; row++) {{
                new Uint8Array(core.memory.buffer, sums, 24 * size).fill(0);
                for (let pass = 0; pass < passes; pass++) core.page_sphere_rows(sphere, row, pass, sampled ? sums : 0, rows, 0);
                const both = [...new Float32Array(core.memory.buffer, rows, 6 * size)];
                seen[row] = both.slice(0, 3 * size), seen[size - 1 - row] = both.slice(3 * size);
            }}
            return seen.flat();
        }})()""")
        return np.array(flat).reshape(size, size, 3)

    def test_the_sphere_is_that_of_the_renderer(self):
        """`musurf render` of such a sphere, camera and studio: the same reads in the same filtered light. What differs is the table of
        albedos, of 24 x 10 nodes here: linear between them, (1/23)² / 8 of a second derivative of 10 or so, 2.4e-3, and around
        (10°)² / 8 of that of a sine of twice the angle and a tenth's height, 1.5e-3; and 4096 samples, some 2e-3: 1e-2 in all where the cosine is above 0.3.
        A place in a pixel differs by 1e-3 of it at most. (Of samplers that reject more the renderer's own table is noisier.) The transposed M, and a light
        turned the other way, are seen at once."""
        for case, technique, name in (({**CASES[2], "roughness": 0.3}, "major axis", "major-axis"),
                                      ({**CASES[2], "roughness": 0.4, "M": [1, 2, 0, 1]}, "bent normal", "bent-normal")):
            case = {**case, "metal": "none"}
            ours = self.sphere(case, technique)
            y, x = (np.mgrid[0:64, 0:64] + 0.5 - 32) / 32 / 0.88
            inside = x * x + y * y < 1 - 0.3**2
            with tempfile.TemporaryDirectory() as folder:
                def off(material, rotation):
                    scene = {"camera": {"type": "orthographic", "position": [0, -5, 0], "target": [0, 0, 0], "up": [0, 0, 1], "height": 2 / 0.88},
                             "film": {"width": 64, "height": 64, "pixels": "float", "filter": "box", "radius": 0.001},
                             "integrator": {"depth": 1, "samples": 1, "reads": 8}, "objects": [{"shape": "sphere", "radius": 1, "material": material}],
                             "lights": [{"type": "studio", "rotation": rotation}]}
                    file, out = pathlib.Path(folder, "scene.json"), pathlib.Path(folder, "out.exr")
                    file.write_text(json.dumps(scene))
                    done = musurf("render", file, "-o", out, "--integrator", name, "--quiet")
                    self.assertEqual(done.returncode, 0, done.err)
                    channels = exr.read(out)[1]
                    theirs = np.stack([channels[c] for c in "RGB"], -1).astype(float)
                    return (np.abs(ours - theirs) / theirs)[inside].max()
                a, c, b, d = case["M"]
                worst = off(material_of(case), 90)
                print(f"{name} of {case['ndf']}: at most {worst:.1e} from musurf render")
                self.assertLess(worst, 1e-2)
                if name == "major-axis":
                    self.assertGreater(off(material_of({**case, "M": [a, b, c, d]}), 90), 0.1)
                    self.assertGreater(off(material_of(case), -90), 0.1)

    def test_techniques_agree_in_even_light(self):
        """Radiance 0.8 from everywhere comes back 0.8 times the albedo, by whatever reads: bit by bit but for sums of weights. Sampled 256 times
        a pixel it is the same to noise: weights are between 0 and 1, so that the mean over 1800 pixels, of 460 000 samples, deviates by
        0.5 / 680 at most, 7e-4; the table by 1e-2 (above), in a mean a fifth: 5e-3 in all."""
        case = {**CASES[0], "metal": "none"}
        y, x = (np.mgrid[0:64, 0:64] + 0.5 - 32) / 32 / 0.88
        inside = x * x + y * y < 1 - 0.3**2
        axis = self.sphere(case, "major axis", "even")[inside]
        for technique in ("split integral", "bent normal", "whole lobe", "filtered importance"):
            self.assertLess(np.abs(self.sphere(case, technique, "even")[inside] - axis).max(), 1e-5)
        self.assertTrue((axis > 0.2).all() and (axis < 0.8).all())
        sampled = self.sphere(case, "sampled", "even", 256)[inside]
        self.assertLess(abs(sampled.mean() / axis.mean() - 1), 5e-3)
        self.assertGreater(np.abs(sampled - axis).max(), 1e-3)  # it is another estimate

    def test_frames_go_on_while_the_light_turns(self):
        before = self.page.run("Number(document.getElementById('status').dataset.frames)")
        pixels = """(() => {
            const canvas = Object.assign(document.createElement("canvas"), { width: 64, height: 64 }), sphere = document.getElementById("sphere-picture");
            const context = canvas.getContext("2d", { willReadFrequently: true });
            context.drawImage(sphere, 0, 0, sphere.width, sphere.height, 0, 0, 64, 64);
            return [...context.getImageData(0, 0, 64, 64).data].join();
        })()"""
        first = self.page.run(pixels)
        self.page.run("document.getElementById('play').click()")
        self.page.until(f"Number(document.getElementById('status').dataset.frames) > {before} + 5")
        self.page.run("document.getElementById('play').click()")
        self.page.until("!musurf.sphere.busy && !musurf.sphere.dirty")
        self.assertNotEqual(self.page.run(pixels), first)
        self.page.picture(BUILD / "page.png")
        self.assertEqual(self.page.run("document.documentElement.dataset.ready"), "2" if self.page.run("navigator.hardwareConcurrency") == 2 else
                         str(min(self.page.run("navigator.hardwareConcurrency"), 4)))

    def test_nothing_was_asked_of_a_network_and_nothing_complained_of(self):
        self.page.run("0")
        self.assertEqual(self.page.complaints, [])
        self.assertEqual([each for each in self.page.requests if not each.startswith(("file:", "blob:"))], [])
        self.assertLess(PAGE.stat().st_size, 1e6)


class Without(unittest.TestCase):
    """Browsers that lack something."""

    def test_without_workers_it_draws_all_the_same(self):
        with chromium.Page(PAGE.as_uri() + "#N=3&size=256", before="delete globalThis.Worker") as page:
            page.until(READY)
            self.assertEqual(page.run("document.documentElement.dataset.ready"), "0")
            self.assertEqual(page.run("document.getElementById('sphere-picture').width"), 256)
            self.assertEqual(page.complaints, [])

    def test_without_web_assembly_it_says_so(self):
        with chromium.Page(PAGE.as_uri(), before="delete globalThis.WebAssembly") as page:
            page.until("!document.getElementById('failure').hidden")
            self.assertIn("this browser has no WebAssembly", page.run("document.getElementById('failure').textContent"))


if __name__ == "__main__":
    need()
    subprocess.run(["make", "run-page", f"BUILD={BUILD}"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    unittest.main()
