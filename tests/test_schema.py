#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf info --schema` and the reader of materials come from one table and must judge alike: random material objects,
good and spoilt, are shown to both."""
import json
import random
import sys
import unittest

from command import answers, musurf, strict

# What only a plugin can judge, by parameters together; the schema cannot say it.
BEYOND_A_SCHEMA = ("not both", "phong has an exponent", "needs both n and k", "is singular", "is defined for", "belongs to the ellipsoid",
                   "an ellipsoid has", "A says all", "all three above 0", "a singular A", "is symmetric", "positive definite",
                   "needs alpha above 0", "needs a dielectric", "needs the visible sampler", "needs a histogram",
                   "belongs to ndf", "has no meaning here", "all weights are 0", "is not a row of", "but weights has",
                   "x_min, x_max, y_min, y_max: the second", "cannot be read as an OpenEXR image", "at least 1e-30 wide",
                   "is no whole number", "belongs to discrete_ggx", "compensated needs", "a random walk", "a tilted mirror",
                   "spline approximates", "the spline of Appendix A",
                   "spline needs", "spline knows", "bounded is known", "bounded needs", "is no formula", "no such file",
                   "cannot vary here", "beside a picture only", "cannot vary too", "comes from vertices",
                   "the second must not be less")


def valid(schema, value):
    """The keywords that the schema uses, after JSON Schema draft 2020-12; an unknown keyword is an error here."""
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    checks = {
        "type": lambda t: {"number": number, "boolean": isinstance(value, bool), "array": isinstance(value, list),
                           "object": isinstance(value, dict), "string": isinstance(value, str),
                           "integer": number and isinstance(value, int)}[t],
        "const": lambda c: value == c,
        "enum": lambda e: isinstance(value, str) and value in e,
        "minimum": lambda m: not number or value >= m,
        "maximum": lambda m: not number or value <= m,
        "exclusiveMinimum": lambda m: not number or value > m,
        "exclusiveMaximum": lambda m: not number or value < m,
        "items": lambda s: not isinstance(value, list) or all(valid(s, v) for v in value),
        "minItems": lambda n: not isinstance(value, list) or len(value) >= n,
        "maxItems": lambda n: not isinstance(value, list) or len(value) <= n,
        "properties": lambda p: not isinstance(value, dict) or all(valid(p[k], v) for k, v in value.items() if k in p),
        "additionalProperties": lambda a: not isinstance(value, dict) or set(value) <= set(schema["properties"]),
        "minProperties": lambda n: not isinstance(value, dict) or len(value) >= n,
        "required": lambda r: not isinstance(value, dict) or set(r) <= set(value),
        "anyOf": lambda s: any(valid(one, value) for one in s),
        "oneOf": lambda s: sum(valid(one, value) for one in s) == 1,
        "title": lambda _: True, "description": lambda _: True, "$schema": lambda _: True,
    }
    return all(checks[keyword](argument) for keyword, argument in schema.items())


def example(schema, rng):
    """A value that the schema allows."""
    for keyword in ("anyOf", "oneOf"):
        if keyword in schema and "type" not in schema:
            return example(rng.choice(schema[keyword]), rng)
    if "const" in schema:
        return schema["const"]
    if "enum" in schema:
        return rng.choice(schema["enum"])
    kind = schema["type"]
    if kind == "boolean":
        return rng.random() < 0.5
    if kind == "string":
        return rng.choice(["there/is/none.exr", "x"])
    if kind == "integer":
        return rng.randint(schema["minimum"], min(schema["maximum"], schema["minimum"] + 3))
    if kind == "array":
        return [example(schema["items"], rng) for _ in range(schema["minItems"])]
    if kind == "object":
        one = [choice["required"][0] for choice in schema.get("oneOf", [])]
        share = rng.choice((0.05, 0.2, 0.5))  # few members rarely contradict one another
        names = [rng.choice(one)] if one else [n for n in schema["properties"] if rng.random() < share]
        names = names or sorted(schema["properties"])[:schema.get("minProperties", 0)]
        names += [n for n in schema.get("required", []) if n not in names]
        return {name: example(schema["properties"][name], rng) for name in names}
    low = schema.get("minimum", schema.get("exclusiveMinimum", -10))
    high = schema.get("maximum", schema.get("exclusiveMaximum", max(low, 0) + 10))
    return rng.choice([rng.uniform(low, high), low if "minimum" in schema else (low + high) / 2])


def spoil(value, rng):
    """The same with one thing changed somewhere; mostly wrong, now and then still right."""
    if isinstance(value, dict) and value and rng.random() < 0.8:
        name = rng.choice(list(value))
        if rng.random() < 0.3:
            return {**{k: v for k, v in value.items() if k != name}, name + "x": value[name]}
        return {**value, name: spoil(value[name], rng)}
    if isinstance(value, list) and value and rng.random() < 0.7:
        at = rng.randrange(len(value))
        return value[:at] + [spoil(value[at], rng)] + value[at + 1:]
    return rng.choice([-1, 0, 1e9, -0.5, "ggx", "none", "Ag", True, None, [], {}, [1, 2, 3], [[1, 0], [0, 1]]])


class Schema(unittest.TestCase):
    def compare(self, material, seed, count):
        schema = strict(musurf("info", "--schema", material).out)
        rng = random.Random(seed)
        objects = [example(schema, rng) for _ in range(count)]
        objects = [spoil(o, rng) if k % 2 else o for k, o in enumerate(objects)]
        for o in objects:  # its tables take seconds each: test_bsdf_varying.c judges them, and dozens of them are no better
            if isinstance(o, dict) and o.get("multiple_scattering") == "compensated":
                o.pop("jacobian", None)
                for name in [n for n, value in o.items() if isinstance(value, dict) and "attribute" in value]:
                    o.pop(name)
        out = answers(musurf("eval", stdin=[{"material": o, "wo": [0, 0, 1]} for o in objects]))
        judged = {True: 0, False: 0}
        for o, answer in zip(objects, out, strict=True):
            error = answer.get("error", "")
            accepted = not error or "does not offer musurf.probe" in error or "vary over the surface" in error
            if valid(schema, o) and not accepted:
                # Only what no schema can say may be refused beyond it, at its place and in the plugin's words.
                self.assertTrue(any(word in error for word in BEYOND_A_SCHEMA), (o, error))
                continue
            self.assertEqual(valid(schema, o), accepted, (o, error))
            judged[accepted] += 1
        self.assertGreater(min(judged.values()), count // 20, judged)

    def test_microfacet(self):
        self.compare("musurf.microfacet", 11, 2000)

    def test_lambert(self):
        self.compare("template.lambert", 12, 400)

    def test_examples_of_the_documentation(self):
        schema = strict(musurf("info", "--schema").out)
        good = {"material": "musurf.microfacet", "ndf": "gtr", "alpha": 0.0121, "gamma": 1.7,
                "transform": [[1, 2], [0, 1]], "fresnel": {"conductor": "Ag"},
                "jacobian": {"map": "power_shear", "amount": 2, "exponent": 5}}
        self.assertTrue(valid(schema, good))
        for change in ({"ndf": "gtx"}, {"alpha": -1}, {"fresnel": {"conductor": "Ag", "dielectric": 1.5}}, {"x": 1},
                       {"material": "musurf.velvet"}, {"transform": [1, 2, 0, 1]}, {"jacobian": {"map": "power_shear"}}):
            self.assertFalse(valid(schema, {**good, **change}), change)
        self.assertEqual(json.loads(json.dumps(schema)), schema)


if __name__ == "__main__":
    sys.exit(unittest.main())
