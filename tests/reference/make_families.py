#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Makes families.jsonl: what eval.jsonl has for GGX, Beckmann and GTR under M, for everything else a material may be.

    tests/reference/make_families.py            about four minutes on two cores

STD, Phong, sheen, ellipsoids (by A and by angles), anisotropy by alpha_x and alpha_y, tilt, every masking, refraction
from both sides to both sides, and opaque surfaces from behind. Lines are those of eval.jsonl; a value that the
definitions leave open (the azimuth of a view along the normal, F where nothing is refracted) is left out of "expect".
"Dh" is D at the half-vector and "sigma0" sigma before M, of a unit vector, roughly: where those leave a format's range,
what is made of them is not held to it.
"""
import json
import math
import multiprocessing
import pathlib
import random

import mpmath as mp

import conditioning
import questions
from bsdf import Bsdf
from make_reference import FRESNEL

SEED = 20260809
ALPHAS = (1.0, 0.5, 0.1, 0.01, 1e-4, 1e-7)
STD_GAMMAS = (1.5 + 1e-6, 1.6, 1.75, 2.0, 2.5, 4.0, 10.0, 100.0)
EXPONENTS = (0.0, 0.5, 1.0, 10.0, 100.0, 1e4, 1e6)
SHEENS = (0.01, 0.1, 0.3, 0.5, 1.0)
GTR_GAMMAS = (0.0, 0.3, 1.0, 1.7, 3.0, 10.0)
ETAS = (1.5, 1 / 1.5, 1.0001, 2.4)
TRANSFORMS = {
    "identity": (1.0, 0.0, 0.0, 1.0), "stretch": (5.0, 0.0, 0.0, 1.0), "skew": (1.0, 2.0, 0.0, 1.0),
    "mirror": (-0.6, 0.8, 0.8, 0.6), "singular": (1.0, 1.0, 1.0, 1 + 1e-8), "large": (1e4, 0.0, 0.0, 1e4),
    "small": (1e-4, 2e-5, 0.0, 1e-4), "huge": (1e12, 0.0, 0.0, 1e12), "tiny": (1e-12, 0.0, 0.0, 1e-12), "random": None,
}
MASKINGS = ("separable", "height_correlated", "direction_correlated")


def transform(rng, name):
    if name == "identity":
        return {}
    rows = TRANSFORMS[name]
    while rows is None or abs(rows[0] * rows[3] - rows[1] * rows[2]) < 0.05:
        if name != "random":
            break
        rows = tuple(round(rng.gauss(0, 2), 6) for _ in range(4))
    return {"transform": [list(rows[:2]), list(rows[2:])]}


def anisotropy(rng):
    x, y = rng.choice((0.01, 0.1, 0.4, 1.0)), rng.choice((0.02, 0.1, 0.3, 0.9))
    return {"alpha_x": x, "alpha_y": y, **({"rotation": rng.choice((math.pi / 2, round(rng.uniform(-3, 3), 4)))}
                                           if rng.random() < 0.7 else {})}


def tilt(rng):
    slope, phi = math.tan(math.radians(rng.choice((5, 20, 40, 60)))), rng.uniform(0, 2 * math.pi)
    return {"tilt": [slope * math.cos(phi), slope * math.sin(phi)]}


def ellipsoid(rng, by_matrix):
    ax, ay = rng.choice((1.0, 0.5, 0.1, 0.01, 1e-4)), rng.choice((0.9, 0.3, 0.1, 0.02))
    lean, phi = math.radians(rng.choice((0, 0, 10, 30, 60))), rng.uniform(0, 2 * math.pi)
    m = {"ndf": "ellipsoid", "alpha_x": ax, "alpha_y": ay, "theta_x": lean * math.cos(phi), "theta_y": lean * math.sin(phi),
         "theta_z": rng.uniform(-3, 3)}
    if not by_matrix:
        return m
    # rows turned and scaled at will: Q A and c A are the same ellipsoid
    c, s = math.cos(phi), math.sin(phi)
    r = questions.ellipsoid_rows(m)
    size = rng.choice((1.0, 1e-3, -40.0))
    return {"ndf": "ellipsoid", "A": [[size * (c * p - s * q) for p, q in zip(r[0], r[2])], [size * e for e in r[1]],
                                      [size * (s * p + c * q) for p, q in zip(r[0], r[2])]]}


def family(rng):
    """Any distribution at a roughness where refraction and tilt are worth looking at."""
    ndf = rng.choice(("ggx", "beckmann", "gtr", "gtr", "std", "phong", "sheen", "ellipsoid", "ellipsoid"))
    if ndf == "ellipsoid":
        return ellipsoid(rng, rng.random() < 0.5)
    if ndf == "phong":
        return {"ndf": ndf, "exponent": rng.choice((1.0, 10.0, 100.0, 1e4))}
    if ndf == "sheen":
        return {"ndf": ndf, "alpha": rng.choice((0.1, 0.3, 1.0))}
    m = {"ndf": ndf, "alpha": rng.choice((0.6, 0.3, 0.1, 0.01))}
    if ndf == "gtr":
        m["gamma"] = rng.choice(GTR_GAMMAS)
    if ndf == "std":
        m["gamma"] = rng.choice(STD_GAMMAS[1:])
    return m


def moved(rng, m, chance=0.5):
    """m with some of: transform, anisotropy, tilt, a masking."""
    if rng.random() < chance:
        m = {**m, **transform(rng, rng.choice(list(TRANSFORMS)))}
    if m["ndf"] not in ("ellipsoid", "phong") and rng.random() < chance:
        m = {**m, **anisotropy(rng)}
        if m["ndf"] not in ("std", "sheen") and rng.random() < 0.7:
            m.pop("alpha")  # sqrt(alpha_x alpha_y) then
    if rng.random() < chance:
        m = {**m, **tilt(rng)}
    if rng.random() < 0.7:
        m = {**m, "masking": rng.choice(MASKINGS)}
    return m


def materials(rng):
    """(label, material, from below) of every line, in order."""
    names = list(TRANSFORMS)
    for gamma in STD_GAMMAS:
        for alpha in ALPHAS:
            for name in rng.sample(names, 3):
                yield name, {"ndf": "std", "alpha": alpha, "gamma": gamma, **transform(rng, name)}, False
    for exponent in EXPONENTS:
        for name in (*names, *rng.sample(names, 4)):
            yield name, {"ndf": "phong", "exponent": exponent, **transform(rng, name)}, False
    for alpha in SHEENS:
        for name in (*names, *rng.sample(names, 6)):
            yield name, {"ndf": "sheen", "alpha": alpha, **transform(rng, name)}, False
    for repeat in range(14):
        for name in names:
            yield name, {**ellipsoid(rng, repeat % 2 == 0), **transform(rng, name)}, False
    for _ in range(210):
        yield "moved", moved(rng, family(rng)), False
    for repeat in range(220):
        glass = {"transmission": True, "fresnel": {"dielectric": rng.choice(ETAS)}}
        yield "transmitting", {**moved(rng, family(rng), 0.3), **glass}, repeat % 2 == 1
    for _ in range(16):
        yield "opaque from behind", family(rng), True


def inputs():
    rng = random.Random(SEED)
    for number, (label, m, below) in enumerate(materials(rng), 1):
        if "fresnel" not in m:
            m = {**m, "fresnel": rng.choice(FRESNEL)[2]}
        kind = rng.choice(questions.VIEWS)
        line, how = questions.ask(rng, m, kind, below)
        shape = " ".join(f"{key} {m[key]:.10g}" for key in ("alpha", "gamma", "exponent", "alpha_x", "alpha_y") if key in m)
        more = " ".join(key for key in ("tilt", "A") if key in m)
        yield {"id": f"{number}: {m['ndf']} {shape} {label} {more}, wo {kind}{' below' * below}, wi {how}", **line}


def reference(line):
    case = Bsdf(line["material"], line["wo"], line["wm"], line["wi"])
    values, c53, c24 = conditioning.measure(case)
    line["expect"] = {key: mp.nstr(value, 25) for key, value in values.items()}
    line["c53"], line["c24"] = c53, c24
    line["Dh"], line["sigma0"] = float(mp.nstr(case.density, 4)), float(mp.nstr(case.visible, 4))
    return json.dumps(line)


def main():
    target = pathlib.Path(__file__).with_name("families.jsonl")
    part = target.with_suffix(".part")
    with multiprocessing.Pool(2) as pool, open(part, "w") as out:
        for line in pool.imap(reference, inputs(), chunksize=4):
            out.write(line + "\n")
    part.rename(target)


if __name__ == "__main__":
    main()
