# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What has no independent value here, before the maps, tilts and directions of grid.py: only what must hold of any answer.

Compensated scattering and random walks: f and pdf are finite and not negative; a compensated f is the largest number of the
format only where single scattering's is, since its lobe is smooth. Flakes of a footprint: that, and their mean
over many footprints is the smooth f, exactly, by the definition of D K / E[K].
"""
import math
import random

from . import measure, more
from .grid import clear, law, point

SEED = 20261128
FOOTPRINTS, RARE = 400, 20


def scattering(count):
    """(question, kind) of compensated surfaces, each before 8 pairs of directions, and of walks."""
    rng = random.Random(SEED)
    for number in range(count):
        kind = ("compensated", "random_walk")[number % 2]
        m = law(rng) if kind == "random_walk" else more.rough(rng, ("ggx", "beckmann", "gtr", "std"))
        while clear(m):  # a mirror scatters singly
            m = law(rng)
        question, _, name = point(rng, {**m, "multiple_scattering": kind}, tilts=(0,) if kind == "compensated" else (0, 10, 60))
        if kind == "random_walk":
            question["material"].pop("masking", None)
        for turn in range(8):
            _, _, other = point(rng, dict(m), tilts=(0,), glass=0)
            fresh = point(rng, dict(m), tilts=(0,), glass=0)[0] if turn else question
            sign = math.copysign(1, question["wo"][2]) if question["material"].get("transmission") else 1
            yield {**question, "id": f"{kind} {number}.{turn}: {name}", "wi": fresh["wi"],
                   "wo": [sign * x for x in fresh["wo"]] if turn else question["wo"]}, kind


def flakes(program, precision):
    """(number of values, failures): the mean of f over footprints side by side against the smooth f."""
    rng, total, measured, failures = random.Random(SEED + 1), 0, 0, []
    for number in range(8):
        ndf, alpha = ("discrete_ggx", "discrete_beckmann")[number % 2], rng.choice((0.01, 0.1, 0.5))
        flake, how, half = {"density": 1e6, "cone": rng.choice((0.05, 0.3)), "seed": 7 + number}, None, 0.03
        while how != "reflected":  # a half-vector that the surface has
            m = {"ndf": ndf, "alpha": alpha, "flakes": flake}
            question, axes, name = point(rng, m, tilts=(0, 10), glass=0, cosines=(0.8, 0.5, 0.1))
            how = axes["light"]
        ask = [question] + [{**question, "material": {**question["material"], "footprint": [
            [2 * half * (k % 20), 2 * half * (k // 20)], [half, 0], [0, half]]}} for k in range(FOOTPRINTS)]
        smooth, *found = measure.ask(program, ask, precision)
        total += len(found)
        bad = [problem for answer in found for problem in measure.ranges(answer, precision)]
        failures += [f"flakes of {name}: {problem}" for problem in bad[:3]]
        if bad or smooth["f"][0] < 1e-30:
            continue
        ratio = [answer["f"][0] / smooth["f"][0] for answer in found]
        if sum(r > min(ratio) for r in ratio) < RARE:
            continue  # the mean is made of events too rare to meet among so many footprints
        measured += 1
        mean = sum(ratio) / len(ratio)
        error = math.sqrt(sum((r - mean) ** 2 for r in ratio)) / len(ratio)
        if abs(mean - 1) > 5 * error + 1e-4:  # beyond 1e6 flakes f is the smooth one, in float to 1e-4
            failures.append(f"flakes of {name}: their mean is {mean:.6g} +- {error:.2g} of the smooth f")
    return total, failures if measured >= 4 else [*failures, f"flakes: a mean of only {measured} of 8 surfaces is measured"]


def saturated(program, pairs, precision):
    """Failures: compensated (question, answer) with an f that is as large as the format goes, though single scattering's is not."""
    large = measure.bound.FORMATS[precision][3]
    pairs = [(question, answer) for question, answer in pairs if max(answer["f"]) > large]
    single = measure.ask(program, [{**question, "material": {**question["material"], "multiple_scattering": "none"}}
                                   for question, _ in pairs], precision)
    return [f"{question['id']}: f = {answer['f']}, of single scattering {alone.get('f', alone)}"
            for (question, answer), alone in zip(pairs, single, strict=True) if not max(alone.get("f", [0])) > large]


def check(program, count, precision):
    """{kind: number of answers}, failures"""
    pairs = list(scattering(count))
    answers = measure.ask(program, [question for question, _ in pairs], precision)
    numbers, failures = {"compensated": 0, "random_walk": 0}, []
    for (question, kind), answer in zip(pairs, answers, strict=True):
        if "error" in answer:
            failures.append(f"{question['id']}: {answer['error']}")
            continue
        numbers[kind] += 1
        failures += [f"{question['id']}: {problem}" for problem in measure.ranges(answer, precision)]
    failures += saturated(program, [(question, answer) for (question, kind), answer in zip(pairs, answers, strict=True)
                                    if kind == "compensated" and "error" not in answer], precision)
    numbers["flakes"], more_failures = flakes(program, precision)
    return numbers, failures + more_failures
