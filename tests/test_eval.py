#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf eval` line by line: order, ids, what each key means, bad lines, precision, talking with a partner.

Values are compared here with closed forms of GGX only, to fix what the keys mean; how exact they are is tested elsewhere.
"""
import json
import math
import random
import struct
import subprocess
import sys
import unittest

from command import MUSURF, answers, microfacet, musurf, strict

GGX = microfacet(ndf="ggx", alpha=0.3)
UP = [0, 0, 1]


def unit(v):
    length = math.hypot(*v)
    return [x / length for x in v]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class Lines(unittest.TestCase):
    def test_order_and_ids(self):
        ids = [1, 0, -7, 2.5, "a", "é\n\"", None, True, [1, {"b": []}], {"x": 1}, 10**17]
        lines = [{"id": i, "material": microfacet(alpha=0.1 + 0.01 * (k % 3)), "wo": [0, k, 1]} for k, i in enumerate(ids * 200)]
        done = musurf("eval", stdin=lines)
        self.assertEqual((done.returncode, done.err), (0, ""))
        self.assertEqual([a["id"] for a in answers(done)], [line["id"] for line in lines])

    def test_an_id_comes_back_as_it_was_written(self):
        for text in ("1e2", "-0", "0.10", '"\\u00e9\\/"', "[ 1 ,2]"):
            out = musurf("eval", stdin='{"material": %s, "wo": [0,0,1], "id": %s}\n' % (json.dumps(GGX), text)).out
            self.assertTrue(out.startswith('{"id": %s, ' % text), out)

    def test_without_id(self):
        good, bad = answers(musurf("eval", stdin=[{"material": GGX, "wo": UP}, {"material": GGX}]))
        self.assertNotIn("id", good)
        self.assertIsNone(bad["id"])

    def test_empty_lines_carriage_returns_and_a_last_line_without_newline(self):
        line = json.dumps({"id": 1, "material": GGX, "wo": UP})
        done = musurf("eval", stdin=f"\n{line}\r\n  \n\n{line}")
        self.assertEqual(done.returncode, 0)
        self.assertEqual(len(answers(done)), 2)
        self.assertEqual(musurf("eval", stdin="").returncode, 0)

    def test_bad_lines_do_not_stop_the_others(self):
        good = json.dumps({"id": "good", "material": GGX, "wo": UP})
        bad = [
            ('{"id": 1, "wo": [0,0,1]}', "stdin:{}:1: $.material: is missing"),
            ('{"id": 2, "material": {}, "wo": [0,0,1]}', "stdin:{}:23: $.material.material: is missing"),
            ('{"id": 3, "material": %s}' % json.dumps(GGX), "stdin:{}:1: $.wo: is missing"),
            ('{"id": 4, "material": %s, "wo": [0,0,0]}' % json.dumps(GGX), "$.wo: is the zero vector"),
            ('{"id": 5, "material": %s, "wo": [0,0]}' % json.dumps(GGX), "$.wo: is an array of 2; an array of 3"),
            ('{"id": 6, "material": %s, "wo": [0,0,1], "wm": [0,"1",0]}' % json.dumps(GGX), '$.wm[1]: is "1"; a number'),
            ('{"id": 7, "material": %s, "wo": [0,0,1], "wh": [0,1,0]}' % json.dumps(GGX), "$.wh: this key is not known"),
            ('{"id": 8, "wo": [0,0,NaN]}', "stdin:{}:22: $.wo[2]: NaN is not JSON; a finite number is needed"),
            ('{"id": 9, "wo": [0,0,1e999]}', "stdin:{}:22: $.wo[2]: the number 1e999 is too large"),
            ('{"id": 10, "wo": [0,0,1]', "the '{{' of line {}, column 1 is not closed"),
            ('{"id": 11, "a": 1, "a": 2}', 'the key "a" stands here a second time'),
            ('{"id": 12} {"id": 13}', "more text"),
            ('{"id": 14, "material": {"material": "musurf.microfacet", "alhpa": 1}, "wo": [0,0,1]}',
             'stdin:{}:58: $.material.alhpa: this key is not known; did you mean "alpha"?'),
            ('{"id": 15, "material": {"material": "musurf.microfacet", "transform": [[1,2],[2,4]]}, "wo": [0,0,1]}',
             "stdin:{}:71: $.material.transform: "),
            ("[]", "stdin:{}:1: $: is an array of 0; an object is needed"),
            ("hello", "stdin:{}:1: "),
            ("[" * 100000, "nested deeper than 2048 levels"),
        ]
        text = "".join(f"{good}\n{line}\n" for line, _ in bad) + good
        done = musurf("eval", stdin=text)
        self.assertEqual(done.returncode, 1)
        out = answers(done)
        self.assertEqual(len(out), 2 * len(bad) + 1)
        self.assertEqual(done.err, f"musurf eval: {len(bad)} of {len(out)} lines could not be answered\n")
        for k, (line, words) in enumerate(bad):
            self.assertEqual(out[2 * k]["id"], "good")
            self.assertEqual(set(out[2 * k + 1]), {"id", "error"}, line)
            self.assertIn(words.format(2 * k + 2), out[2 * k + 1]["error"])
            self.assertEqual(out[2 * k + 1]["id"], k + 1 + (k >= 12) if line.startswith("{") else None, line)

    def test_bytes_that_are_no_text(self):
        done = musurf("eval", stdin=b'{"id": 1, "wo": "\xff"}\n{"id": 2, "\0": 1}\n\0\n{"id": "\xff"}\n')
        self.assertEqual(done.returncode, 1)
        out = answers(done)
        self.assertEqual([a["id"] for a in out], [1, 2, None, None])
        self.assertIn("stdin:1:18: $.wo: byte 0xff is not UTF-8", out[0]["error"])
        self.assertIn("stdin:2:12: $: a NUL byte", out[1]["error"])

    def test_a_line_of_brackets_without_end(self):
        good = json.dumps({"id": "good", "material": GGX, "wo": UP}).encode()
        done = musurf("eval", stdin=good + b"\n" + b"[" * 100_000_000 + b"\n" + good)
        self.assertEqual(done.returncode, 1)
        self.assertEqual([a["id"] for a in answers(done)], ["good", None, "good"])
        self.assertIn("stdin:2: the line is longer than 8 MiB", done.out)

    def test_mangled_lines(self):
        """Whatever the bytes, each line gets one answer that is JSON, and nothing crashes."""
        rng = random.Random(20261122)
        whole = json.dumps({"id": 3, "material": microfacet(ndf="gtr", alpha=0.2, gamma=1.7, transform=[[1, 2], [0, 1]],
                                                            fresnel={"conductor": {"n": [1, 2, 3], "k": 2}}),
                            "wo": [0.1, 0.2, 0.9], "wm": [0, 0, 1], "wi": [-0.3, 0.1, 0.8]}).encode()
        lines = []
        for _ in range(3000):
            line = bytearray(whole)
            for _ in range(rng.randint(1, 4)):
                at = rng.randrange(len(line))
                line[at:at + rng.randint(0, 3)] = bytes(rng.choice(b'{}[]",:0123456789eE+-.\\ntfu\xff\x00') for _ in range(rng.randint(0, 3)))
            lines.append(bytes(line).replace(b"\n", b" "))
        done = musurf("eval", stdin=b"\n".join(lines) + b"\n")
        self.assertIn(done.returncode, (0, 1))
        self.assertEqual(len(answers(done)), len(lines))

    def test_mixed_sampling_takes_gtr_s_own_alpha_where_gtr_is_ggx(self):
        """Appendix B: uniform with probability alpha, also at gamma = 0, where the surface is GGX of alpha 1."""
        at, beside = (answer["pdf"] for answer in answers(musurf("eval", stdin=[
            {"material": microfacet(ndf="gtr", alpha=0.1, gamma=gamma, sampler="mixed"), "wo": UP, "wi": [0.6, 0, 0.8]} for gamma in (0, 1e-13)])))
        self.assertAlmostEqual(at, 0.9 * math.sqrt(0.9) / math.pi / (4 * math.sqrt(0.9)) + 0.1 / (2 * math.pi), delta=1e-15)
        self.assertAlmostEqual(at, beside, delta=1e-12)


class Meaning(unittest.TestCase):
    def test_keys(self):
        wo, wm, wi = [0.3, -0.4, 2], [0.1, 0, 1], [-0.5, 0.2, 0.6]
        base = {"material": GGX, "wo": wo}
        only, with_wm, with_wi, both = answers(musurf("eval", stdin=[
            base, {**base, "wm": wm}, {**base, "wi": wi}, {**base, "wm": wm, "wi": wi}]))
        self.assertEqual(list(only), ["Lambda", "sigma"])
        self.assertEqual(list(with_wm), ["Lambda", "sigma", "D", "G1", "Dv"])
        self.assertEqual(list(with_wi), ["Lambda", "sigma", "f", "F", "G2", "pdf"])
        self.assertEqual(both, {**only, **with_wm, **with_wi})

    def test_closed_forms_of_ggx(self):
        """D, Lambda and the rest of GGX at the identity, as in Walter et al. 2007 and Heitz 2014, written out anew."""
        alpha, rng = 0.3, random.Random(4)
        material = microfacet(ndf="ggx", alpha=alpha, fresnel="none")

        def D(m):
            return alpha**2 / (math.pi * (m[2]**2 * (alpha**2 - 1) + 1)**2)

        def Lambda(w):
            return (math.sqrt(1 + alpha**2 * (w[0]**2 + w[1]**2) / w[2]**2) - 1) / 2

        lines = [{"material": material, "wo": unit([rng.gauss(0, 1), rng.gauss(0, 1), rng.uniform(0.2, 1)]),
                  "wm": unit([rng.gauss(0, 0.3), rng.gauss(0, 0.3), 1]),
                  "wi": unit([rng.gauss(0, 1), rng.gauss(0, 1), rng.uniform(0.2, 1)])} for _ in range(200)]
        for line, out in zip(lines, answers(musurf("eval", stdin=lines)), strict=True):
            wo, wm, wi = line["wo"], line["wm"], line["wi"]
            wh = unit([a + b for a, b in zip(wo, wi)])
            G1 = 1 / (1 + Lambda(wo)) if dot(wo, wm) > 0 else 0
            G2 = 1 / (1 + Lambda(wo) + Lambda(wi))
            expected = {"Lambda": Lambda(wo), "sigma": wo[2] * (1 + Lambda(wo)), "D": D(wm), "G1": G1,
                        "Dv": G1 * max(0, dot(wo, wm)) * D(wm) / wo[2], "G2": G2,
                        "pdf": D(wh) / (1 + Lambda(wo)) / (4 * wo[2]), "f": D(wh) * G2 / (4 * wo[2] * wi[2]), "F": 1}
            for key, value in expected.items():
                got = out[key] if isinstance(out[key], list) else [out[key]]
                for x in got:  # Lambda of this form loses up to 1/Lambda in digits, hence the absolute part
                    self.assertTrue(math.isclose(x, value, rel_tol=1e-11, abs_tol=1e-14), (key, x, value, line))

    def test_directions_of_any_length(self):
        """A power of two changes no bit; the farthest lengths that a double holds change little."""
        rng = random.Random(5)
        for _ in range(20):
            v = [[rng.gauss(0, 1), rng.gauss(0, 1), rng.uniform(0.1, 1)] for _ in range(3)]
            lines = [{"material": GGX, **{k: [s * x for x in w] for k, w in zip(("wo", "wm", "wi"), v)}}
                     for s in (1, 2.0**-1000, 2.0**1000, 1e300, 1e-300)]
            out = answers(musurf("eval", stdin=lines))
            self.assertEqual(out[0], out[1])
            self.assertEqual(out[0], out[2])
            for other in out[3:]:
                for key, value in out[0].items():
                    for a, b in zip(*[x if isinstance(x, list) else [x] for x in (value, other[key])]):
                        self.assertTrue(math.isclose(a, b, rel_tol=1e-12), key)  # scaling rounds each entry once

    def test_edges(self):
        at_horizon, mirror, below_wi, below_wo = answers(musurf("eval", stdin=[
            {"material": GGX, "wo": [1, 0, 0], "wm": UP, "wi": UP},
            {"material": microfacet(alpha=0), "wo": [1, 0, 1], "wm": UP, "wi": [-1, 0, 1]},
            {"material": GGX, "wo": UP, "wm": [0, 0, -1], "wi": [0, 1, -1]},
            {"material": GGX, "wo": [0, 1, -1], "wi": UP}]))
        self.assertIsNone(at_horizon["Lambda"])
        self.assertGreater(at_horizon["sigma"], 0)
        self.assertIs(mirror["delta"], True)
        self.assertEqual((mirror["f"], mirror["pdf"]), ([0, 0, 0], 0))
        self.assertNotIn("delta", at_horizon)
        for out in (at_horizon, below_wi, below_wo):
            self.assertEqual((out["f"], out["pdf"]), ([0, 0, 0], 0))
        self.assertEqual((below_wi["D"], below_wi["G1"], below_wi["Dv"]), (0, 0, 0))

    def test_precision(self):
        """Float differs from double, by rounding: 1e-4 is some thousand units of float's last place."""
        rng = random.Random(6)
        lines = [{"material": GGX, "wo": [rng.random(), rng.random(), rng.uniform(0.3, 1)], "wm": [0.1, 0.05, 1],
                  "wi": [-rng.random(), -rng.random(), rng.uniform(0.3, 1)]} for _ in range(50)]
        double, again, single = (answers(musurf("eval", *option, stdin=lines)) for option in
                                 ([], ["--precision", "double"], ["--precision=float"]))
        self.assertEqual(double, again)
        self.assertTrue(double != single)
        for a, b in zip(double, single):
            for key in ("sigma", "D", "G1", "Dv", "G2", "pdf"):
                self.assertTrue(math.isclose(a[key], b[key], rel_tol=1e-4), (key, a, b))

    def test_17_digits(self):
        out = musurf("eval", stdin=[{"material": microfacet(alpha=0.1), "wo": [0, 0.3, 0.7], "wm": UP}]).out
        for key, value in strict(out).items():
            self.assertIn(f'"{key}": {value:.17g}', out)


class Discrete(unittest.TestCase):
    def ask(self, precision, **parameters):
        material = microfacet(alpha=0.3, transform=[[1, 0.5], [0, 1]], **parameters)
        return answers(musurf("eval", "--precision", precision,
                              stdin=[{"material": material, "wo": [0.6, 0, 0.8], "wi": [-0.5, 0.2, 0.8], "wm": [0.1, 0, 1]}]))[0]

    def test_a_footprint_shows_flakes_and_no_footprint_none(self):
        """D and f are multiples, by whole numbers of flakes over their mean; what the sampler follows is smooth."""
        flakes = {"density": 1e4, "cone": 0.1}
        for precision, near in (("double", 1e-12), ("float", 1e-4)):
            smooth, afar = (self.ask(precision, ndf=ndf, **more) for ndf, more in (("ggx", {}), ("discrete_ggx", {"flakes": flakes})))
            shares = set()
            for k in range(40):
                few = self.ask(precision, ndf="discrete_ggx", flakes=flakes, footprint=[[k, 0.3], [0.05, 0.01], [0, 0.04]])
                for key in ("D", "Dv", "G1", "G2", "sigma", "pdf", "f"):
                    self.assertAlmostEqual(sum(afar[key]) / sum(smooth[key]) if key == "f" else afar[key] / smooth[key], 1,
                                           delta=near)
                    if key not in ("D", "f"):
                        self.assertEqual(few[key], afar[key])
                shares.add(few["D"] / afar["D"])
            step = min(share for share in shares if share > 0)  # 1 / E[K], or a small multiple
            self.assertGreater(len(shares), 3)
            for share in shares:
                self.assertLess(min(abs(share / step * n - round(share / step * n)) for n in (1, 2, 3)), 10 * near, shares)

    def test_what_is_refused(self):
        for parameters, words in (({"ndf": "ggx", "flakes": {"density": 3}}, "flakes.density: belongs to discrete_ggx"),
                                  ({"ndf": "ggx", "footprint": [[0, 0], [1, 0], [0, 1]]}, "footprint: belongs to discrete_ggx"),
                                  ({"ndf": "discrete_ggx", "flakes": {"density": 0}}, "flakes.density: is 0; it must be above 0"),
                                  ({"ndf": "discrete_ggx", "flakes": {"seed": 1.5}}, "flakes.seed: 1.5 is no whole number"),
                                  ({"ndf": "discrete_ggx", "footprint": [[0, 0], [1, 0]]}, "footprint: a footprint is its centre")):
            self.assertIn(words, self.ask("double", **parameters)["error"])


class Unused(unittest.TestCase):
    """A parameter that a distribution would ignore is an error, unless it says what the default says."""

    def ask(self, **parameters):
        return answers(musurf("eval", stdin=[{"material": microfacet(**parameters), "wo": [1, 0, 2], "wm": UP, "wi": [-1, 0, 2]}]))[0]

    def test_refused(self):
        of = {"gamma": ("gtr", "std"), "exponent": ("phong",)}
        for ndf in ("ggx", "beckmann", "gtr", "std", "phong", "sheen", "flat", "discrete_ggx", "discrete_beckmann"):
            for name, users in of.items():
                with self.subTest(ndf=ndf, name=name):
                    error = self.ask(ndf=ndf, **{name: 1.75}).get("error")
                    if ndf in users:
                        self.assertIsNone(error)
                    else:
                        self.assertIn(f"{name}: belongs to ndf", error)
                    default = {"gamma": 2, "exponent": 10}[name]
                    self.assertNotIn("error", self.ask(ndf=ndf, **{name: default}))
        for name in ("alpha", "roughness", "alpha_x", "alpha_y"):
            self.assertIn(f"{name}: belongs to ndf", self.ask(ndf="flat", **{name: 0.1})["error"])
        self.assertNotIn("error", self.ask(ndf="flat", alpha=0.3))

    def test_a_mirror_leans(self):
        for how in ({"ndf": "flat"}, {"ndf": "ggx", "alpha": 0}, {"ndf": "beckmann", "alpha": 0, "transform": [[1, 0], [0, 3]]}):
            level, leaning, away = (self.ask(tilt=tilt, **how) for tilt in ([0, 0], [0.25, 0], [3, 0]))
            self.assertTrue(level["delta"] and leaning["delta"])
            self.assertAlmostEqual(level["sigma"], 2 / 5 ** 0.5, delta=1e-15)
            self.assertEqual(level["Lambda"], 0)
            # sigma = wo.m / m.z, m along (-0.25, 0, 1)
            self.assertAlmostEqual(leaning["sigma"], (2 - 0.25) / 5 ** 0.5, delta=1e-6)
            self.assertEqual(away["sigma"], 0)

    def test_what_passes_straight_does_so_in_both_precisions(self):
        for index in (1, 1 + 1e-9, 1 - 1e-9, 1 + 5e-8, 1 + 7e-8, 1 - 2e-8, 1 - 4e-8, 1.0000002, 1.001, 1.5):
            line = {"material": microfacet(alpha=0.3, transmission=True, fresnel={"dielectric": index}), "wo": [1, 0, 2]}
            straight = struct.unpack("f", struct.pack("f", index))[0] == 1
            for precision in ("float", "double"):
                drawn = answers(musurf("sample", "--precision", precision, "-n", "50", stdin=[line]))
                passed = [x for x in drawn if x["wi"] and x["wi"][2] < 0]
                self.assertTrue(passed)
                self.assertEqual({bool(x.get("delta")) for x in passed}, {straight}, (index, precision))


class Partner(unittest.TestCase):
    def test_each_answer_comes_before_the_next_question(self):
        child = subprocess.Popen([MUSURF, "eval"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        for k in range(50):
            child.stdin.write(json.dumps({"id": k, "material": GGX, "wo": [0, k, 1]}).encode() + b"\n")
            child.stdin.flush()
            self.assertEqual(strict(child.stdout.readline())["id"], k)
        child.stdin.close()
        self.assertEqual(child.stdout.read(), b"")
        child.stdout.close()
        self.assertEqual(child.wait(timeout=60), 0)

    def test_many_materials_in_turn(self):
        """More materials than are kept compiled, in turn: each line is answered for its own."""
        materials = [microfacet(alpha=0.05 * (1 + k)) for k in range(20)]
        lines = [{"material": materials[k % 20], "wo": [0, 1, 1]} for k in range(200)]
        out = answers(musurf("eval", stdin=lines))
        alone = [answers(musurf("eval", stdin=[line]))[0] for line in lines[:20]]
        self.assertEqual(out, alone * 10)
        self.assertEqual(len({a["sigma"] for a in alone}), 20)


if __name__ == "__main__":
    sys.exit(unittest.main())
