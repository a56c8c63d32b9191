#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Makes eval.jsonl: inputs of `musurf eval` and what they must give, to 25 digits. About ten minutes on two cores.

    tests/reference/make_reference.py            after smith.py's cross-check has passed, which this runs first

Each line: {"id", "material", "wo", "wm", "wi"} as `musurf eval` takes it, "expect" (25 digits) and "c53", "c24":
how ill-posed each value is. c53 = sum over the input numbers of the relative change of the exact value when that
number moves by 8 units of 2^-53 (the worse of both signs), in such units; c24 likewise with 2^-24. The lengths of the
unit vectors wo and wi count as inputs: three rounded components never have length 1, and the half-vector cancels. A
program that rounds each input's path 8 times can not be held to less than 8 c 2^-p, whatever it does after.
"""
import json
import math
import multiprocessing
import pathlib
import random

import mpmath as mp

import smith
from model import Case

ALPHAS = (1.0, 0.5, 0.1, 0.01, 1e-4, 1e-7)
GAMMAS = (0.0, 1e-9, 0.3, 1 - 1e-9, 1.0, 1 + 1e-9, 1.5, 1.7, 2.0, 2.5, 3.0, 4.0, 10.0)
TRANSFORMS = {
    "identity": (1, 0, 0, 1),
    "stretch": (5, 0, 0, 1),
    "skew": (1, 2, 0, 1),  # (a, b, c, d) = (1, 0, 2, 1) of Figure 1, as rows
    "mirror": (-0.6, 0.8, 0.8, 0.6),
    "singular": (1, 1, 1, 1 + 1e-8),
    "large": (1e4, 0, 0, 1e4),
    "small": (1e-4, 2e-5, 0, 1e-4),
    "huge": (1e12, 0, 0, 1e12),
    "tiny": (1e-12, 0, 0, 1e-12),
    "random": None,
    "random mirror": None,
}
VIEWS = ("normal", 30, 60, 85, 89.99, "horizon")
FRESNEL = (
    ("none", [], "none"),
    ("schlick", [0.04, 0.5, 0.95], {"schlick": [0.04, 0.5, 0.95]}),
    ("dielectric", [1.5] * 3, {"dielectric": 1.5}),
    ("dielectric", [0.75] * 3, {"dielectric": 0.75}),
    ("conductor", [0.155, 0.117, 0.138, 4.83, 3.12, 2.15],
     {"conductor": {"n": [0.155, 0.117, 0.138], "k": [4.83, 3.12, 2.15]}}),
)
NOTHING = mp.mpf(10) ** -4000000000  # Beckmann's Lambda of a view that sees no slope at all
SEED = 20260722


def view(random_, kind):
    phi = random_.uniform(0, 2 * math.pi)
    if kind == "normal":
        return [0.0, 0.0, 1.0]
    if kind == "horizon":
        return [math.cos(phi), math.sin(phi), 1e-9]
    theta = math.radians(kind)
    return [math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)]


def scaled(random_, v):
    factor = random_.choice((1.0, 1.0, 3.7, 1e3))
    return [x * factor for x in v]


def micronormal(random_, alpha, transform, wo):
    """A normal that the material has: slopes of size alpha, moved by M^-T, mostly facing the viewer."""
    size, phi = alpha * random_.choice((0.0, 0.5, 1.0, 3.0, 30.0)), random_.uniform(0, 2 * math.pi)
    p, q = size * math.cos(phi), size * math.sin(phi)
    a, c, b, d = transform
    det = a * d - b * c
    sx, sy = (d * p - b * q) / det, (a * q - c * p) / det
    norm = math.hypot(sx, sy, 1)
    m = [-sx / norm, -sy / norm, 1 / norm]
    if sum(x * y for x, y in zip(m, wo)) < 0 and random_.random() < 0.8:
        m = [-m[0], -m[1], m[2]]
    return m


def light(random_, wo, wm):
    how = random_.random()
    if how < 0.15:
        return list(wo), "backscatter"
    if how < 0.25:
        return [-wo[0], -wo[1], wo[2]], "mirror"
    if how < 0.8:
        along = 2 * sum(x * y for x, y in zip(wo, wm))
        wi = [along * m - o for m, o in zip(wm, wo)]
        if wi[2] > 0:
            return wi, "reflected"
    kind = random_.choice(VIEWS)
    return view(random_, kind), str(kind)


def inputs():
    random_ = random.Random(SEED)
    number = 0
    laws = [("ggx", 2.0), ("beckmann", 2.0)] + [("gtr", gamma) for gamma in GAMMAS]
    for ndf, gamma in laws:
        for alpha in ALPHAS:
            for name, transform in TRANSFORMS.items():
                if transform is None:
                    sign = -1 if "mirror" in name else 1
                    while True:
                        transform = [round(random_.gauss(0, 2), 6) for _ in range(4)]
                        if sign * (transform[0] * transform[3] - transform[1] * transform[2]) > 0.05:
                            break
                # half of GTR's combinations keep the table small; GGX and Beckmann are few: twice each
                repeats = 2 if ndf != "gtr" else random_.randrange(2)
                for _ in range(repeats):
                    kind = random_.choice(VIEWS)
                    wo = view(random_, kind)
                    wm = micronormal(random_, alpha, transform, wo)
                    wi, how = light(random_, wo, wm)
                    fresnel = random_.choice(FRESNEL)
                    number += 1
                    material = {"material": "musurf.microfacet", "ndf": ndf, "alpha": alpha,
                                "transform": [list(map(float, transform[:2])), list(map(float, transform[2:]))],
                                "fresnel": fresnel[2]}
                    if ndf == "gtr":
                        material["gamma"] = gamma
                    yield {"id": f"{number}: {ndf} {gamma:.10g} alpha {alpha:g} {name}, wo {kind}, wi {how}",
                           "material": material, "wo": scaled(random_, wo), "wm": scaled(random_, wm),
                           "wi": scaled(random_, wi)}, (ndf, alpha, gamma, list(map(float, transform)), *fresnel[:2])


def reference(job):
    line, (ndf, alpha, gamma, transform, kind, values) = job
    case = Case(ndf, alpha, gamma, transform, kind, values, line["wo"], line["wm"], line["wi"])
    base = {}

    def exact(*arguments):
        *point, side = arguments
        value = smith.Lambda(*point)
        if value < NOTHING:
            value = mp.mpf(0)
        base[side] = (value, smith.derivatives(*point), point[1:])
        return base[side][0]

    def nearby(*arguments):
        """Lambda next to the base point, by its logarithmic derivatives: only how far values move is wanted."""
        *point, side = arguments
        value, slopes, origin = base[side]
        return value * mp.exp(sum(k * mp.log(x / x0) for k, x, x0 in zip(slopes, point[1:], origin) if k and x0))

    values = case.evaluate(exact)
    line["expect"] = {key: mp.nstr(value, 25) for key, value in values.items()}
    for bits in (53, 24):
        step = mp.mpf(8) / 2 ** bits
        moves = dict.fromkeys(values, mp.mpf(0))
        for i, number in enumerate(case.numbers):
            if number == 0:
                continue
            most = dict.fromkeys(values, mp.mpf(0))
            for sign in (1, -1):
                case.numbers[i] = number * (1 + sign * step)
                for key, value in case.evaluate(nearby).items():
                    most[key] = max(most[key], abs(value - values[key]))
            case.numbers[i] = number
            for key in moves:
                moves[key] += most[key]
        line[f"c{bits}"] = {key: 0.0 if values[key] == 0 else float(mp.nstr(min(
            moves[key] / abs(values[key]) / step, mp.mpf(10) ** 99), 3)) for key in values}
    return json.dumps(line)


def main():
    target = pathlib.Path(__file__).with_name("eval.jsonl")
    part = target.with_suffix(".part")
    with multiprocessing.Pool(2) as pool, open(part, "w") as out:
        checked = pool.apply_async(smith.crosscheck)
        for line in pool.imap(reference, inputs(), chunksize=4):
            out.write(line + "\n")
        checked.get()  # raises what it raised: then nothing is renamed
    part.rename(target)


if __name__ == "__main__":
    main()
