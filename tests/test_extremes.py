#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Thousands of random and extreme questions to `musurf eval` and `musurf sample`: every answer is finite, no density is
negative, no masking leaves [0, 1], and what is refused is a singular M or a zero vector, by name."""
import math
import random
import sys
import unittest

from command import answers, microfacet, musurf

SEED, COUNT = 20261123, 3000


def number(rng):
    return rng.choice([0, 1, -1, 1e-9, 1e-5, -1e-5, 0.3, -0.7, rng.gauss(0, 1),
                       rng.gauss(0, 1) * 10 ** rng.uniform(-12, 0)])


def direction(rng):
    """Of any length. Not nearer to the horizon than 1e-13: f, without its cosine, grows as 1/cos there and overflows."""
    length = rng.choice([1, 1, 1e-290, 1e290])
    v = [length * number(rng) for _ in range(3)]
    return v if rng.random() < 0.2 else [v[0], v[1], abs(v[2])]


def material(rng):
    ndf = rng.choice(["ggx", "beckmann", "gtr"])
    m = {"ndf": ndf, "alpha": rng.choice([0, 1, 1e-7, 1e-3, 1 - 1e-7, rng.random()] + [1e3, 1e8] * (ndf != "gtr"))}
    if ndf == "gtr":
        m["gamma"] = rng.choice([0, 1, 2, 1.5, 1e-9, 1 + 1e-9, 1 - 1e-9, 2 + 1e-9, 3, 10, 4 * rng.random()])
    if rng.random() < 0.7:
        scale = rng.choice([1, 1e-4, 1e4, 1e12, 1e-12])
        entry = (lambda: number(rng)) if rng.random() < 0.3 else (lambda: scale * rng.gauss(0, 1))
        m["transform"] = [[entry(), entry()], [entry(), entry()]]
    m["fresnel"] = rng.choice(["none", {"schlick": [0.1, 0.5, 1]}, {"dielectric": rng.choice([1.5, 1, 0.5, 1000, 0.001])},
                               {"conductor": "Au"}, {"conductor": {"n": 1e-3, "k": 0}}])
    return microfacet(**m)


class Extremes(unittest.TestCase):
    def test_eval(self):
        rng = random.Random(SEED)
        lines = []
        for _ in range(COUNT):
            wo = direction(rng)
            wi = rng.choice([direction(rng), wo, [-wo[0], -wo[1], wo[2]], [-x for x in wo]])
            lines.append({"material": material(rng), "wo": wo, "wm": direction(rng), "wi": wi})
        # F is a mean of two squares, each of a quotient of sums: a dozen roundings may lift it above 1.
        for precision, rounding in (("double", 12 * 2**-53), ("float", 12 * 2**-24)):
            refused = 0
            out = answers(musurf("eval", "--precision", precision, stdin=lines))
            for line, answer in zip(lines, out, strict=True):
                if "error" in answer:
                    self.assertRegex(answer["error"], "is singular|is the zero vector", line)
                    refused += 1
                    continue
                for key in ("sigma", "D", "G1", "Dv", "G2", "pdf"):
                    self.assertGreaterEqual(answer[key], 0, (key, line))
                for key in ("G1", "G2"):
                    self.assertLessEqual(answer[key], 1, (key, line))
                self.assertLessEqual(max(answer["F"]), 1 + rounding, line)
                self.assertGreaterEqual(min(answer["f"] + answer["F"]), 0, line)
            self.assertLess(refused, COUNT / 4)

    def test_sample(self):
        rng = random.Random(SEED + 1)
        for _ in range(100):
            done = musurf("sample", "--n", 20, "--precision", rng.choice(["double", "float"]),
                          stdin=[{"material": material(rng), "wo": direction(rng)}])
            if done.returncode:
                self.assertRegex(done.err, "is singular|is the zero vector")
                continue
            for s in answers(done):
                self.assertGreaterEqual(min(s["f"] + s["weight"] + [s["pdf"]]), 0)
                if s["wi"] is None:
                    self.assertEqual((s["f"], s["weight"], s["pdf"]), ([0] * 3, [0] * 3, 0))
                else:
                    self.assertGreater(s["wi"][2], 0)
                    self.assertTrue(math.isclose(math.hypot(*s["wi"]), 1, rel_tol=1e-6))
                self.assertLessEqual(max(s["weight"]), 1 + 1e-6)  # F G2 / G1 <= 1; float rounds to 6e-8 each


if __name__ == "__main__":
    sys.exit(unittest.main())
