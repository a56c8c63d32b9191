#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf eval` under thousands of extreme, wrong and broken lines, in both precisions.

Whatever comes in: the program ends by itself with 0 or 1, answers each line that is not blank by one line of strict JSON,
in order; no NaN, no Infinity, nothing negative, G1 and G2 and F at most 1; exit 1 exactly if a line was answered by an
error; and lines that must be errors are. Inputs come from a fixed generator.
"""
import json
import math
import os
import pathlib
import random
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / os.environ.get("BUILD", "build")
SEED = 4242

COORDINATES = (0.0, -0.0, 1.0, -1.0, 0.5, 1e-9, -1e-9, 1e-30, 5e-324, 1e-310, 2e-308, 1e300, -1e300, 1e38, 1e-45, 1e-160,
               1.7976931348623157e308, 3.5e38, 1e160)
ALPHAS = (0.0, 5e-324, 1e-300, 1e-40, 1e-20, 1e-7, 0.01, 0.5, 1 - 1e-16, 1.0, 10.0, 1e10, 1e300)
GAMMAS = (0.0, 5e-324, 1e-9, 0.5, 1 - 1e-16, 1.0, 1 + 1e-15, 2.0, 3.0, 50.0, 1e3, 1e6, 1e300)
ENTRIES = (0.0, 1.0, -1.0, 2.0, 1e-12, 1e12, 1e150, 1e-150, 1e300, 1e-300, 5e-324, 1 + 1e-8, 1 - 1e-8, 1e308)
ANYTHING = (None, True, "x", [], {}, [1], [1, 2], [1, 2, "3"], {"a": 1}, -1, 1e999, "NaN", [[1]], [[1, 0], [0]])

GARBAGE = ["", " ", "\t", "{", "}", "[", "null", "1", '"x"', "[]", "{}", "{{}}", "nan", "NaN", "{'id': 1}", '{"id": 1,}', "\x01\x02",
           '{"id": NaN}', '{"id": 5, "wo": [0,0,NaN]}', '{"wo": [0,0,Infinity]}', '{"id": "\\ud800"}', '{"id": "é"}', "[" * 5000,
           '{"a":' * 3000, "\ufeff{}", '{"id":1,"id":2}', "// comment", '{"id": 1} {"id": 2}', '{"id": 1} x', "0" * 400, "-" * 50]


def fresnel(random_):
    return random_.choice(("none", {"schlick": [random_.random() for _ in range(3)]}, {"dielectric": 10 ** random_.uniform(-2, 2)},
                           {"conductor": random_.choice(("Ag", "Al", "Au", "Cu", "Cr"))},
                           {"conductor": {"n": [1e-3, 1, 100], "k": [0, 1, 1e3]}}))


def extreme(random_, number):
    def vector():
        if random_.random() < 0.4:
            scale = 10.0 ** random_.uniform(-200, 200)
            return [random_.gauss(0, 1) * scale, random_.gauss(0, 1) * scale, abs(random_.gauss(0, 1)) * scale]
        return [random_.choice(COORDINATES) for _ in range(3)]

    ndf = random_.choice(("ggx", "ggx", "beckmann", "beckmann", "gtr"))  # a gtr builds its table: 20 ms
    material = {"material": "musurf.microfacet", "ndf": ndf, "fresnel": fresnel(random_),
                "alpha": random_.choice(ALPHAS) if random_.random() < 0.7 else 10 ** random_.uniform(-9, 0)}
    if ndf == "gtr":
        material["gamma"] = random_.choice(GAMMAS) if random_.random() < 0.7 else random_.uniform(0, 12)
        if random_.random() < 0.9:
            material["alpha"] = min(material["alpha"], 1.0)
    if random_.random() < 0.7:
        material["transform"] = [[random_.choice(ENTRIES), random_.choice(ENTRIES)],
                                 [random_.choice(ENTRIES), random_.choice(ENTRIES)]]
        if random_.random() < 0.5:
            scale = 10.0 ** random_.uniform(-14, 14)
            material["transform"] = [[random_.gauss(0, scale) for _ in range(2)] for _ in range(2)]
    line = {"id": number, "material": material, "wo": vector()}
    if random_.random() < 0.8:
        line["wm"] = vector()
    if random_.random() < 0.8:
        line["wi"] = line["wo"] if random_.random() < 0.1 else vector()
    if random_.random() < 0.15:  # something of a wrong type, missing or unknown
        target = random_.choice((line, material))
        key = random_.choice([key for key in target if key != "id"])
        how = random_.random()
        if how < 0.6:
            target[key] = random_.choice(ANYTHING)
        elif how < 0.8:
            del target[key]
        else:
            target["zz" + key] = 1
    return json.dumps(line)  # writes NaN and Infinity as such: not JSON, so an error


def must_fail(line):
    """Lines that no reading makes right."""
    if not isinstance(line, dict) or not isinstance(line.get("material"), dict) or "wo" not in line:
        return True
    for key in ("wo", "wm", "wi"):
        value = line.get(key, [0, 0, 1])
        numbers = isinstance(value, list) and len(value) == 3 and all(type(x) in (int, float) for x in value)
        if not numbers or not any(value) or not all(math.isfinite(x) for x in value):
            return True
    alpha = line["material"].get("alpha", 0.5)
    return type(alpha) not in (int, float) or not 0 <= alpha < math.inf


def strict(text):
    def refuse(name):
        raise ValueError(f"{name} is not JSON")
    return json.loads(text, parse_constant=refuse)


class Extremes(unittest.TestCase):
    def answers(self, lines, precision, *, blank=0):
        data = "\n".join(lines).encode("utf-8", "surrogatepass") + b"\n"
        done = subprocess.run([BUILD / "musurf", "eval", "--precision", precision], input=data, capture_output=True,
                              timeout=600)
        self.assertIn(done.returncode, (0, 1), done.stderr[-500:])
        answers = [strict(text) for text in done.stdout.decode().splitlines()]
        self.assertEqual(len(answers), len(lines) - blank)
        for answer in answers:
            self.check(answer)
        self.assertEqual(done.returncode, int(any("error" in answer for answer in answers)))
        return answers

    def check(self, answer):
        self.assertIsInstance(answer, dict)
        if "error" in answer:
            self.assertTrue(answer["error"] and "\n" not in answer["error"])
            return
        for key, value in answer.items():
            if key in ("id", "delta") or (key == "Lambda" and value is None):
                continue
            for number in value if isinstance(value, list) else [value]:
                self.assertTrue(isinstance(number, (int, float)) and math.isfinite(number), answer)
                below_zero = number < 0 and not (key in ("Lambda", "sigma"))  # of wo below the horizon
                self.assertFalse(below_zero, answer)
                if key in ("G1", "G2", "F"):
                    # one rounding of a quotient or a root may reach over 1
                    self.assertLessEqual(number, 1 + 1e-6, answer)

    def test_extremes(self):
        random_ = random.Random(SEED)
        lines = [extreme(random_, number) for number in range(2500)]
        for precision in ("double", "float"):
            answered = 0
            for text, answer in zip(lines, self.answers(lines, precision)):
                line = json.loads(text)
                self.assertEqual(answer["id"], line["id"])
                if must_fail(line):
                    self.assertIn("error", answer, text)
                answered += "error" not in answer
            self.assertGreater(answered, 600)  # the extremes are mostly legal

    def test_what_is_legal_is_answered(self):
        """Values that the documentation calls legal get an answer, not an error, at any length of the vectors."""
        lines = []
        for alpha in (0.0, 1e-300, 1e-40, 1e-7, 0.5, 1.0):
            for ndf, gammas in (("ggx", (None,)), ("beckmann", (None,)), ("gtr", (0.0, 1.0, 1.7, 2.0, 1e6))):
                for gamma in gammas:
                    if gamma is not None and 1 <= gamma < 2 and 0 < alpha < 1e-140:
                        continue  # documented as refused: no map holds such slopes
                    for length in (1e-300, 1.0, 1e300):
                        material = {"material": "musurf.microfacet", "ndf": ndf, "alpha": alpha}
                        if gamma is not None:
                            material["gamma"] = gamma
                        lines.append(json.dumps({"id": [ndf, alpha, gamma, length], "material": material,
                                                 "wo": [0.3 * length, 0, 0.7 * length], "wm": [0, 0, length],
                                                 "wi": [0, 0.2 * length, 0.9 * length]}))
        for answer in self.answers(lines, "double"):
            self.assertNotIn("error", answer)

    def test_garbage(self):
        good = json.dumps({"id": "good", "material": {"material": "musurf.microfacet"}, "wo": [0, 0, 1]})
        lines = [text for bad in GARBAGE for text in (bad, good)]
        blank = sum(not text.strip() for text in GARBAGE)
        answers = self.answers(lines, "double", blank=blank)
        self.assertEqual(sum(answer.get("id") == "good" and "error" not in answer for answer in answers), len(GARBAGE))
        self.assertEqual(sum("error" in answer for answer in answers), len(GARBAGE) - blank)

    def test_long_lines_and_no_lines(self):
        million = "x" * 1_000_000
        good = {"material": {"material": "musurf.microfacet"}, "wo": [0, 0, 1]}
        answers = self.answers([million, json.dumps({"id": million, **good}), json.dumps({"id": 1, **good, million: 1}),
                                json.dumps({"id": 2, **good})], "double")
        self.assertEqual([("error" in answer) for answer in answers], [True, False, True, False])
        self.assertEqual(answers[1]["id"], million)
        for data in (b"", b"\n\n", b'{"id": 1'):
            done = subprocess.run([BUILD / "musurf", "eval"], input=data, capture_output=True, timeout=60)
            self.assertEqual(done.returncode, int(b"{" in data))
            self.assertEqual(done.stdout.count(b"\n"), int(b"{" in data))

    def test_bytes(self):
        random_ = random.Random(SEED + 1)
        data = bytes(random_.choice(b'{}[]",:0123456789.eE+-naif \x00\x80\xff\n\\') for _ in range(200_000))
        done = subprocess.run([BUILD / "musurf", "eval"], input=data, capture_output=True, timeout=600)
        self.assertEqual(done.returncode, 1)
        answers = [strict(text) for text in done.stdout.decode().splitlines()]
        self.assertEqual(len(answers), sum(bool(line.strip(b" \t\r")) for line in data.split(b"\n")))
        self.assertTrue(all("error" in answer for answer in answers))


if __name__ == "__main__":
    unittest.main()
