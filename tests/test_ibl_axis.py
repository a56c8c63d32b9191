#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf ibl axis` against tests/reference/major_axis.py, which finds everything by other ways to 60 digits and more.

A value v passes if |v - exact| <= C kappa 2^-53 + base scale, where
  kappa  is what one unit of relative change in every input number does to it, measured by moving each in the reference;
  C = 24 because an input meets at most 8 roundings until the view stands in the lobe's frame (read, squared, summed, root,
         divided: 5; turned: 3), 8 more in a, b and c of extrema.h, whose squares cancel (so twice), and nothing later
         amplifies what is not in kappa already;
  base   1e-14 is what the arithmetic after that may cost: 40 roundings of 2^-53 each, and twice that for their growth;
  scale  1 for vectors, t and delta, which are angles and cosines; |exact| for the others, and for tau and zeta, which are
         differences from 1/2 and 1, the larger of that and 1.
Where C kappa 2^-53 reaches 0.1 scale the inputs do not determine the value, which then need only be finite; few may be.
"""
import json
import math
import pathlib
import random
import sys
import unittest

from mpmath import mp

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "reference"))
import major_axis as reference  # noqa: E402
from command import answers, musurf  # noqa: E402

SEED = 20241105
C, BASE = 24, 1e-14
OWN_SIZE = ("width", "length", "radius")
UPRIGHT = {"angle": 0.0, "k": 1.0, "beta": 2.3}


def question(number, x, samples, shift):
    return {"id": number, "sigma": [x["su"], x["sv"]], "angle": x["angle"], "wo": [x["ox"], x["oy"], x["oz"]],
            "k": x["k"], "N": samples, "beta": x["beta"], "appendix_c": shift}


def direction(random_, z=None):
    phi = random_.uniform(0, 2 * math.pi)
    z = random_.random() if z is None else z
    s = math.sqrt(1 - z * z)
    return {"ox": s * math.cos(phi), "oy": s * math.sin(phi), "oz": z}


def ordinary(random_):
    """Section 4.1's parameters; every third view is grazing."""
    a, e = random_.uniform(0.02, 1) ** 2 / math.sqrt(2), random_.uniform(-0.98, 0.98)
    view = direction(random_, 10 ** random_.uniform(-6, -1) if random_.random() < 1 / 3 else None)
    return {"su": a * (1 + e), "sv": a * (1 - e), "angle": random_.uniform(-4, 4), **view,
            "k": random_.choice((1.0, random_.uniform(0.2, 3))), "beta": random_.choice((2.3, random_.uniform(0, 5)))}


def extreme(random_):
    """Any size of roughness and of the view's length, views along axes, across them and next to the normal."""
    view = direction(random_, random_.choice((1 - 10 ** random_.uniform(-15, -1), 10 ** random_.uniform(-15, 0), 0.0)))
    length = 10.0 ** random_.choice((0, random_.uniform(-30, 30)))
    for name in random_.choice(((), ("ox",), ("oy",), ("ox", "oy", "oz"))):
        if name != "oz" or view["oz"] == 0:
            view[name] *= 10.0 ** random_.uniform(-12, 0)
    su = 10 ** random_.uniform(-20, 12)
    sv = random_.choice((su, su * (1 + random_.uniform(-1e-9, 1e-9)), 10 ** random_.uniform(-20, 12), 0.0))
    return {"su": su, "sv": sv, "angle": random_.choice((0.0, random_.uniform(-4, 4), math.pi / 2, 1e6)),
            **{name: c * length for name, c in view.items()}, "k": 10 ** random_.uniform(-3, 3), "beta": 2.3}


def degenerate():
    """Named: sigma, view; what is special about them."""
    def at(su, sv, ox, oy, oz, **other):
        return {**UPRIGHT, "su": su, "sv": sv, "ox": ox, "oy": oy, "oz": oz, **other}

    return {
        "isotropic at normal incidence": at(0.3, 0.3, 0, 0, 1), "turned": at(0.3, 0.3, 0, 0, 1, angle=1.0),
        "phi2 = 0 at normal incidence, U longer": at(0.4, 0.1, 0, 0, 1), "V longer": at(0.1, 0.4, 0, 0, 1),
        "phi2 = 0 by o.y = 0": at(0.2, 0.3, 0.6, 0, 0.8), "by o.x = 0": at(0.2, 0.3, 0, 0.6, 0.8),
        "o.x = 0, phi1 < 0": at(0.1, 0.5, 0, 0.6, 0.8), "o.y = 0, phi1 < 0": at(0.1, 0.5, 0.1, 0, 0.99),
        "both ends cut": at(2.0, 1.5, 0.3, 0.2, 0.9), "both ends cut, steep": at(30.0, 20.0, 0.1, 0.7, 0.7),
        "both ends cut at normal incidence": at(3.0, 2.0, 0, 0, 1),
        "zero roughness": at(0, 0, 0.3, 0.4, 0.5), "zero roughness, normal": at(0, 0, 0, 0, 1), "zero, horizon": at(0, 0, 1, 0, 0),
        "zero along U": at(0, 0.3, 0.3, 0.4, 0.5), "zero along V": at(0.3, 0, 0.3, 0.4, 0.5),
        "zero along V, from U": at(0.75, 0, 0.6, 0, 0.8), "zero along U, from U": at(0, 0.75, 0.6, 0, 0.8),
        "horizon": at(0.3, 0.1, 0.6, 0.8, 0), "horizon along U": at(0.3, 0.1, 1, 0, 0), "horizon along V": at(0.3, 0.1, 0, 1, 0),
        "horizon, isotropic": at(0.2, 0.2, 0.6, 0.8, 0), "horizon, turned back": at(0.2, 0.3, -0.6, -0.8, 0),
        "a needle": at(1e-12, 1e3, 0.3, 0.4, 0.5),
    }


def beyond_squares():
    return {"almost the horizon": {**UPRIGHT, "su": 0.3, "sv": 0.1, "ox": 0.6, "oy": 0.8, "oz": 1e-300},
            "almost smooth": {**UPRIGHT, "su": 1e-200, "sv": 2e-201, "ox": 0.3, "oy": 0.4, "oz": 0.5},
            "a cliff": {**UPRIGHT, "su": 1e200, "sv": 1e190, "ox": 0.3, "oy": 0.4, "oz": 0.5}}


def exact(x, samples, shift, digits):
    with mp.workdps(digits):
        x = {name: mp.mpf(value) for name, value in x.items()}
        values = reference.major_axis(x, samples, shift)
        return values, reference.conditions(x, samples, shift, values)


class Axis(unittest.TestCase):
    def compare(self, cases, digits):
        """cases: (name, inputs, N, form). Returns how many numbers were compared, and how many no input determines."""
        got = answers(musurf("ibl", "axis", stdin=[question(*case) for case in cases]))
        self.assertEqual([answer.get("id") for answer in got], [case[0] for case in cases])
        floor = mp.mpf(10) ** (20 - digits)  # what the reference itself knows
        compared = free = 0
        for (name, x, samples, shift), answer in zip(cases, got):
            self.assertNotIn("error", answer)
            values, kappa = exact(x, samples, shift, digits)
            self.assertEqual(set(answer), set(values) | {"id"})
            for key, value in values.items():
                numbers = reference.flat(answer[key])
                self.assertEqual(len(numbers), len(reference.flat(value)))
                for number, right, k in zip(numbers, reference.flat(value), kappa[key]):
                    self.assertTrue(math.isfinite(number), f"{name}: {key} = {number}")
                    scale = abs(right) if key in OWN_SIZE else max(abs(right), 1)
                    doubt = C * k * mp.mpf(2) ** -53
                    compared += 1
                    if doubt > 0.1 * scale:
                        free += 1
                        continue
                    self.assertLessEqual(abs(number - right), doubt + BASE * scale + floor,
                                         f"{name}: {key} = {number}, exactly {mp.nstr(right, 17)}, kappa {mp.nstr(k, 3)}; {x}")
        return compared, free

    def random(self, make, count, digits, seed):
        random_ = random.Random(SEED + seed)
        return self.compare([(i, make(random_), random_.randint(1, 5), random_.choice(("printed", "symmetric")))
                             for i in range(count)], digits)

    def test_ordinary(self):
        compared, free = self.random(ordinary, 40, 60, 0)
        self.assertLess(free, compared / 1000)

    def test_extreme(self):
        compared, free = self.random(extreme, 40, 130, 1)
        self.assertLess(free, compared / 5)

    def test_degenerate(self):
        for shift in ("printed", "symmetric"):
            compared, free = self.compare([(name, x, 3, shift) for name, x in degenerate().items()], 60)
            self.assertLess(free, compared / 100)

    def test_beyond_the_range_of_squares(self):
        """1e-300 beside 1, and 1e-200 squared, need as many digits to be seen, and those of a derivative."""
        compared, free = self.compare([(name, x, 2, "symmetric") for name, x in beyond_squares().items()], 800)
        self.assertLess(free, compared / 100)

    def test_turning_everything_changes_nothing(self):
        random_ = random.Random(SEED + 2)
        lines, turns = [], []
        for number in range(40):
            x, turn = ordinary(random_), random_.uniform(-3, 3)
            c, s = math.cos(turn), math.sin(turn)
            y = {**x, "angle": x["angle"] + turn, "ox": c * x["ox"] - s * x["oy"], "oy": s * x["ox"] + c * x["oy"]}
            lines += [question(number, x, 4, "symmetric"), question(number, y, 4, "symmetric")]
            turns.append((x, c, s))
        got = answers(musurf("ibl", "axis", stdin=lines))
        for (x, c, s), one, other in zip(turns, got[::2], got[1::2]):
            _, kappa = exact(x, 4, "symmetric", 40)
            for key in one:
                if key == "id":
                    continue
                a, b = reference.flat(one[key]), reference.flat(other[key])
                if key in ("near", "far", "far_clamped", "samples"):
                    a = [v for p in one[key] for v in (c * p[0] - s * p[1], s * p[0] + c * p[1], p[2])]
                doubt = 4 * C * float(max(kappa[key])) * 2**-53 + 1e-13  # both turns are rounded, and both answers
                for p, q in zip(a, b):
                    self.assertLessEqual(abs(p - q), doubt, (key, x))

    def test_bad_lines_are_told(self):
        good = {"sigma": [0.1, 0.2], "wo": [0, 0, 1]}
        bad = [{**good, "sigma": [0.1]}, {**good, "sigma": [-0.1, 0.1]}, {"sigma": [0.1, 0.1]}, {**good, "wo": [0, 0, 0]},
               {**good, "wo": [0, 1, -0.1]}, {**good, "k": 0}, {**good, "N": 0}, {**good, "N": 1.5}, {**good, "beta": -1},
               {**good, "appendix_c": "smooth"}, {**good, "angel": 1}, {"wo": [0, 0, 1]}, {**good, "N": 1000000}]
        done = musurf("ibl", "axis", stdin=[{**line, "id": i} for i, line in enumerate(bad)] + [{**good, "id": "good"}])
        got = answers(done)
        self.assertEqual(done.returncode, 1)
        self.assertEqual([answer["id"] for answer in got], [*range(len(bad)), "good"])
        self.assertTrue(all(set(answer) == {"id", "error"} for answer in got[:-1]))
        self.assertNotIn("error", got[-1])
        self.assertIn("appendix_c", got[9]["error"])
        self.assertEqual(musurf("ibl", "axis", stdin=[good]).returncode, 0)
        self.assertEqual(json.loads(musurf("ibl", "axis", stdin=[good]).out).get("id"), None)
        self.assertEqual(musurf("ibl", "axis", "a", "b").returncode, 2)
        self.assertEqual(musurf("ibl").returncode, 2)
        self.assertIn('did you mean "axis"', musurf("ibl", "axes").err)

    def test_defaults(self):
        given = {"sigma": [0.3, 0.2], "wo": [0.5, 0.1, 0.4]}
        full = {**given, "angle": 0, "k": 1, "N": 16, "beta": 2.3, "appendix_c": "symmetric"}
        one, other = (musurf("ibl", "axis", stdin=[line]).out for line in (given, full))
        self.assertEqual(one, other)
        self.assertEqual(len(json.loads(one)["samples"]), 16)


if __name__ == "__main__":
    unittest.main()
