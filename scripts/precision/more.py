# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Questions beyond those of grid.py: what else a material may be, before the same maps, tilts and directions.

Samplers other than visible normals, histograms of slopes, the spline of Appendix A, discrete distributions without a
footprint (their mean), what is flat. And materials to draw from, single and multiple scattering: see sampled.py.
"""
import random

from .grid import ALPHAS, GAMMAS, STD_GAMMAS, law, point

SEED = 20261126
UPRIGHT = (0,)
SAMPLERS = ("ndf", "mixed", "visible_uniform", "folded", "folded_uniform", "bounded")
SHARE = 4  # a question of these for so many of grid.py


def rough(rng, ndfs):
    """A law of these families, with a roughness."""
    ndf = rng.choice(ndfs)
    m = {"ndf": ndf, "alpha": rng.choice(ALPHAS[1:])}
    if ndf in ("gtr", "std"):
        m["gamma"] = rng.choice(GAMMAS if ndf == "gtr" else STD_GAMMAS)
    return m


def histogram(rng):
    """From 1 to 8 cells a side; even, random, a narrow ridge with empty cells, or far from 0."""
    columns, rows = rng.choice((1, 2, 5, 8)), rng.choice((1, 3, 8))
    width = rng.choice((1e-4, 0.1, 1.0, 30.0))
    at = [rng.choice((0.0, 0.0, 0.7, -3.0)) * width for _ in range(2)]
    how = rng.choice(("even", "random", "ridge"))
    weights = [[1.0 if how == "even" else rng.random() if how == "random" else float(abs(i - j) <= 1) * (1 + i)
                for i in range(columns)] for j in range(rows)]
    if not any(map(any, weights)):
        weights[0][0] = 1.0
    bounds = [at[0] - width, at[0] + width, at[1] - width / 2, at[1] + width]
    return {"ndf": "tabulated", "histogram": {"bounds": bounds, "weights": weights}}


def sampled_by(rng):
    sampler = rng.choice(SAMPLERS)
    m = rough(rng, ("ggx",) if sampler == "bounded" else ("ggx", "beckmann", "gtr", "std", "sheen"))
    if sampler not in ("mixed", "bounded") and rng.random() < 0.2:
        m = law(rng)
    return {**m, "sampler": sampler}


def spline(rng):
    gamma = rng.choice([g for g in GAMMAS if g <= 4] + [0.5, 2.5, 3.5])
    return {"ndf": "gtr", "alpha": rng.choice(ALPHAS), "gamma": gamma, "smith": "spline", "sampler": rng.choice(("ndf", "mixed"))}


def discrete(rng):
    ndf = rng.choice(("discrete_ggx", "discrete_beckmann"))
    return {"ndf": ndf, "alpha": rng.choice(ALPHAS), "flakes": {"density": 1e6, "cone": 0.02, "seed": 1}}


KINDS = (("samplers", sampled_by), ("samplers", sampled_by), ("tabulated", histogram), ("tabulated", histogram), ("spline", spline),
         ("discrete", discrete), ("flat", lambda rng: {"ndf": "flat"}))


def points(first, count):
    """Like grid.points, with the kind among the axes."""
    rng = random.Random(SEED)
    for number in range(count):
        kind, make = KINDS[number % len(KINDS)]
        m = make(rng)
        plain = m.get("sampler", "visible") == "visible" and kind != "spline"
        if kind == "tabulated" and rng.random() < 0.3:
            m["sampler"], plain = rng.choice(("ndf", "folded", "visible_uniform")), False
        question, axes, name = point(rng, m, tilts=UPRIGHT if m.get("sampler") == "bounded" or kind == "flat" else (0, 0, 10, 60),
                                     glass=0.25 if plain else 0)
        yield {"id": f"{first + number}: {name}", **question}, {**axes, "kind": kind}
