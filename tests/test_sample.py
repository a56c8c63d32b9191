#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf sample`: what its lines mean, and that they are a function of (seed, index) alone."""
import math
import sys
import unittest

from command import answers, microfacet, musurf

QUERY = {"id": "q", "material": microfacet(ndf="ggx", alpha=0.5, transform=[[1, 2], [0, 1]]), "wo": [0.3, -2, 0.7]}


def draw(*arguments, query=QUERY):
    done = musurf("sample", *arguments, stdin=[query])
    assert done.returncode == 0, done.err
    return answers(done)


class Sample(unittest.TestCase):
    def test_lines(self):
        out = draw("--n", 500, "--seed", 3)
        self.assertEqual(len(out), 500)
        rejected = [s for s in out if s["wi"] is None]
        self.assertTrue(0 < len(rejected) < 250)
        for s in out:
            self.assertEqual(list(s), ["id", "wi", "wm", "f", "pdf", "weight"])
            self.assertEqual(s["id"], "q")
            self.assertAlmostEqual(math.hypot(*s["wm"]), 1, delta=1e-14)
            if s["wi"] is None:
                self.assertEqual((s["f"], s["pdf"], s["weight"]), ([0, 0, 0], 0, [0, 0, 0]))
            else:
                self.assertAlmostEqual(math.hypot(*s["wi"]), 1, delta=1e-14)
                self.assertGreater(s["pdf"], 0)

    def test_seed_and_index(self):
        self.assertEqual(draw("--n", 10, "--seed", 7), draw("--n", 1000, "--seed", 7)[:10])
        self.assertEqual(draw(), draw("--n", 1, "--seed", 0))
        self.assertNotEqual(draw("--n", 10, "--seed", 7), draw("--n", 10, "--seed", 8))
        self.assertEqual(len(draw("--n", 3, "--seed", 2**64 - 1)), 3)
        self.assertEqual(draw("--n", 0), [])

    def test_samples_agree_with_eval(self):
        """f and pdf are those that eval gives for the sampled direction; weight is f cos / pdf."""
        out = [s for s in draw("--n", 300, "--seed", 5) if s["wi"]]
        values = answers(musurf("eval", stdin=[{**QUERY, "wi": s["wi"]} for s in out]))
        for s, v in zip(out, values, strict=True):
            # eval forms the half-vector anew from wo and wi: some 1e-16 over its length and over wi.z.
            near = 1e-11 / min(s["wi"][2], 0.1)
            self.assertTrue(math.isclose(s["pdf"], v["pdf"], rel_tol=near), (s, v))
            for k in range(3):
                self.assertTrue(math.isclose(s["f"][k], v["f"][k], rel_tol=near), (s, v))
                self.assertTrue(math.isclose(s["weight"][k] * s["pdf"], s["f"][k] * s["wi"][2], rel_tol=near), s)

    def test_mirror(self):
        for s in draw("--n", 5, query={"material": microfacet(alpha=0, fresnel="none"), "wo": [1, 2, 2]}):
            self.assertIs(s["delta"], True)
            for got, expected in zip(s["wi"], [-1 / 3, -2 / 3, 2 / 3]):
                self.assertAlmostEqual(got, expected, delta=1e-15)
            self.assertEqual((s["f"], s["pdf"], s["weight"]), ([0, 0, 0], 1, [1, 1, 1]))

    def test_float(self):
        """Float sampling gives single-precision numbers near those of double."""
        double, single = (draw("--n", 200, "--precision", p) for p in ("double", "float"))
        both = [(a, b) for a, b in zip(double, single) if a["wi"] and b["wi"]]
        self.assertGreater(len(both), 50)
        self.assertTrue(double != single)
        # The uniforms are cut to 24 bits, and wi moves by at most some tens of that, save where sampling is steep.
        near = sum(math.dist(a["wi"], b["wi"]) < 1e-4 for a, b in both)
        self.assertGreater(near, 0.95 * len(both))

    def test_bad_input(self):
        for text, words in (("", "stdin:1:1: $: is empty"), ('{"material": 3', "is not closed"), ("{}", "$.wo: is missing"),
                            ('{"wo": [0,0,1]}', "$.material: is missing"),
                            ('{"wo": [0,0,1], "wi": [0,0,1]}', "$.wi: this key is not known"),
                            ("{}\n{}", "stdin:2:1: $: more text")):
            done = musurf("sample", stdin=text)
            self.assertEqual((done.returncode, done.out), (2, ""), text)
            self.assertEqual(done.err.count("\n"), 1)
            self.assertIn(words, done.err)


if __name__ == "__main__":
    sys.exit(unittest.main())
