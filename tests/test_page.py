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
import math
import unittest

import numpy as np

import page_host
from command import answers, musurf
from page_host import CASES, PAGE, direction, material_of

BOUND = 1e-12
AXIS = ("t", "far", "near", "tau", "far_clamped", "delta", "width", "length", "zeta", "radius")


def flat(values):
    return [x for value in values for x in flat(value)] if isinstance(values, list) else [values]


class Shown(page_host.Worked):
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
        panels, worst = ["hemisphere", "close up"], 0
        for i, case in enumerate(CASES):
            with self.subTest(**case):
                own = settings[i % 2]
                self.put_all({**case, **own, "panels": panels[(i + i // 2) % 2]})
                shown = self.numbers()
                said = answers(musurf("ibl", "axis", stdin=[{"sigma": shown["slope_sigma"], "angle": shown["angle"][0],
                                                             "wo": direction(case["view"]), **own}]))[0]
                for name in AXIS:
                    worst = max(worst, self.agree(shown[name], said[name], BOUND, 1 if name in ("far", "near", "far_clamped", "t", "tau") else 1e-3))
                self.hold_samples(said["samples"], direction(case["view"]))
        self.put_all({**settings[0], "panels": panels[0]})
        print(f"at most {worst:.1e} from musurf ibl axis")

    def hold_samples(self, samples, wo):
        """The dots of the three panels stand where the samples are, seen by the projections of panel.h."""
        def equal_area(w):
            return [c / math.sqrt(1 + w[2]) for c in w[:2]]

        frames = self.page.run("musurf.panels.map((panel) => panel.frame)")
        seen = [lambda m: [-m[0] / m[2], -m[1] / m[2]], equal_area,
                lambda m: equal_area([2 * sum(a * b for a, b in zip(m, wo)) * c - o for c, o in zip(m, wo)])]
        for panel, project, (reach, *middle) in zip(("slopes", "normals", "reflected"), seen, frames):
            path = self.page.run(f"document.querySelector('#{panel} path.samples').getAttribute('d')")
            dots = [[float(x) for x in dot.split()] for dot in path.replace("h0", "").split("M")[1:]]
            self.assertEqual(len(dots), len(samples))
            for dot, micronormal in zip(dots, samples):
                x, y = ((place - centre) / reach for place, centre in zip(project(micronormal), middle))
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

    def drag(self, panel, start, end):
        """From a place of a panel, -1 to 1, y up, to another; the size of a pixel."""
        self.page.run("scrollTo(0, 0)")
        left, top, width, height = self.page.run(f"(({{left, top, width, height}}) => [left, top, width, height])"
                                                 f"(document.getElementById('{panel}').getBoundingClientRect())")
        at = [[left + width * (1 + x) / 2, top + height * (1 - y) / 2] for x, y in (start, end)]
        for kind, (x, y) in (("mousePressed", at[0]), ("mouseMoved", at[1]), ("mouseReleased", at[1])):
            self.page.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)
        return 2 / width

    def test_views_are_dragged_on_the_sphere_and_in_a_panel(self):
        """To x, y of the sphere with radius 0.88, whose normal is (x, -front, y), tangent eastward; and of the equal-area disc, horizon
        at 1 / 1.1. Angles are kept to 0.1 degrees, 1e-3; a pixel's place moves the direction by less than three times its size."""
        self.put_all({"view": [0, 0], "panels": "hemisphere"})
        pixel = self.drag("sphere", (0, 0), (0.5 * 0.88, -0.3 * 0.88))
        n = np.array([0.5, -math.sqrt(1 - 0.25 - 0.09), -0.3])
        t = np.array([-n[1], n[0], 0]) / math.hypot(n[0], n[1])
        toward = np.array([0, -1, 0])
        wo = direction(self.page.run("musurf.state.view"))
        for got, wanted in zip(wo, (t @ toward, np.cross(n, t) @ toward, n @ toward)):
            self.assertAlmostEqual(got, wanted, delta=1e-3 + 3 * pixel)
        self.page.until("!musurf.asked")
        place = [c / math.sqrt(1 + wo[2]) / 1.1 for c in wo[:2]]
        pixel = self.drag("normals", place, (-0.4 / 1.1, 0.5 / 1.1))
        z = 1 - 0.16 - 0.25
        for got, wanted in zip(direction(self.page.run("musurf.state.view")), (-0.4 * math.sqrt(1 + z), 0.5 * math.sqrt(1 + z), z)):
            self.assertAlmostEqual(got, wanted, delta=1e-3 + 3 * pixel)

    def test_columns_are_dragged_and_moved_by_keys(self):
        self.put_all({"M": [1, 0, 0, 1]})
        pixel = self.drag("map", (0, 1 / 3), (1.5 / 3, 1.2 / 3))
        M = self.page.run("musurf.state.M")
        for got, wanted in zip(M, (1, 1.5, 0, 1.2)):
            self.assertAlmostEqual(got, wanted, delta=0.01 + 3 * pixel)  # hundredths, and a pixel
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

    def test_whatever_is_set_there_are_numbers(self):
        """300 states all over the ranges, their ends among them: every number is one, or infinite (Lambda at the horizon, D of a mirror); what is
        drawn has finite places; a refused M is told and leaves the page as it was."""
        wrong = self.page.run("""(() => {
            let seed = 7;
            const random = () => (seed = (seed * 1103515245 + 12345) % 2147483648) / 2147483648;
            const pick = (list) => list[Math.floor(random() * list.length)], wrong = [], { choices } = musurf;
            const end = (low, high) => pick([low, high, low + (high - low) * random(), low + (high - low) * random()]);
            for (let i = 0; i < 300; i++) {
                const wide = 10 ** (4 * random() - 2), M = [0, 0, 0, 0].map(() => pick([0, 1, wide]) * (2 * random() - 1));
                musurf.change({ ndf: pick(choices.ndf), masking: pick(choices.masking), metal: pick(choices.metal), roughness: end(0, 1), gamma: end(0, 10),
                                exponent: end(0, 1000), M, view: [end(0, 89.9), end(-180, 180)], light: [end(0, 89.9), end(-180, 180)], N: Math.ceil(end(1, 64)),
                                k: end(0.1, 3), beta: end(0, 10), appendix_c: pick(choices.appendix_c), panels: pick(choices.panels) });
                musurf.show();
                const told = document.getElementById("complaint").textContent !== "", text = document.getElementById("numbers").textContent;
                const paths = [...document.querySelectorAll("svg path")].map((path) => path.getAttribute("d") ?? "").join();
                const dots = [...document.querySelectorAll("svg circle, svg g")].map((one) => (one.getAttribute("cx") ?? "") + one.getAttribute("transform")).join();
                if (/NaN|none|undefined/.test(text) || /NaN|Infinity/.test(paths + dots)) wrong.push([told, JSON.stringify(musurf.state)]);
            }
            return wrong;
        })()""")
        self.assertEqual(wrong, [])

    def test_it_is_one_small_file(self):
        self.assertLess(PAGE.stat().st_size, 1e6)
        self.assertEqual([each for each in self.page.requests if each.startswith("file:")], [PAGE.as_uri()])

    def test_a_singular_map_is_refused(self):
        self.put_all({"M": [1, 2, 0, 1]})
        before = self.numbers()
        self.put("M.3", 0)
        self.assertIn("transform", self.page.run("document.getElementById('complaint').textContent"))
        self.assertEqual(self.numbers(), before)
        self.put("M.3", 1)
        self.assertEqual(self.page.run("document.getElementById('complaint').textContent"), "")


if __name__ == "__main__":
    page_host.made()
    unittest.main()
