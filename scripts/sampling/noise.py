# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Figure 10 measured: the noise that each sampler leaves on the torus knot, and the samples it needs for the noise of another.

Noise is the mean over the knot's pixels of the squared difference of luminance from a long reference, less the reference's
own variance; "relative" divides each pixel's by its squared luminance (and a hundredth of the mean, lest black pixels
decide). The renderer stratifies, so noise falls faster than 1/N: the samples that reach a given noise are read from each
sampler's own power law through its two sample counts, not from a ratio of variances.
"""
import dataclasses
import math

import numpy as np

from . import rendering

SAMPLERS = ("ndf", "mixed", "visible", "visible_uniform", "folded", "folded_uniform", "auto")
MODES = {"bsdf": False, "mis": True}  # is light sampled too?
GAMMAS, STRETCHES = (1, 0.1, 4), (0, 0.25, 0.5, 0.75)
BASE = "mixed"  # the paper's own


@dataclasses.dataclass
class Effort:
    size: tuple
    reference: int  # samples per pixel, of each of two renders
    counts: tuple  # samples per pixel
    seeds: int


FULL, QUICK = Effort((128, 96), 1024, (16, 64), 4), Effort((48, 36), 128, (4, 16), 1)


def errors(picture, right, inside, spare):
    """(absolute, relative) noise; `spare` is the variance of the reference itself, pixel by pixel."""
    square = ((picture - right) ** 2 - spare)[inside]
    floor = (0.1 * right[inside].mean()) ** 2
    return square.mean(), (square / (right[inside] ** 2 + floor)).mean()


def measure_one(musurf, mesh, effort, folder, description, right, spare, inside):
    """For each sample count the noise of each seed, and the processor seconds of one more sample per pixel."""
    noise, seconds = {n: [] for n in effort.counts}, {n: [] for n in effort.counts}
    for n in effort.counts:
        for seed in range(1, effort.seeds + 1):
            picture, _, spent, _ = rendering.render(musurf, description, folder, n, seed)
            noise[n].append(errors(picture, right, inside, spare))
            seconds[n].append(spent)
    low, high = effort.counts
    return {"noise": {n: np.mean(v, axis=0).tolist() for n, v in noise.items()},
            "spread": (np.std([e[0] for e in noise[high]]) / math.sqrt(effort.seeds)).item(),
            "seconds_per_sample": max((min(seconds[high]) - min(seconds[low])) / (high - low), 1e-6)}


def samples_for(rows, level, effort, metric):
    """Samples per pixel until the noise is `level`, on the line through both counts in logarithms. Noise that the
    reference cannot tell from none counts as next to none."""
    low, high = effort.counts
    first, last = (max(rows["noise"][n][metric], 1e-30) for n in (low, high))
    slope = min(max(math.log(first / last) / math.log(high / low), 0.5), 2)
    return high * (last / max(level, 1e-30)) ** (1 / slope)


def compare(rows, effort):
    """Adds to each sampler's row what it needs in units of what BASE needs at its larger count."""
    high = effort.counts[-1]
    for row in rows.values():
        row["samples"] = [samples_for(row, rows[BASE]["noise"][high][m], effort, m) / high for m in (0, 1)]
        row["variance"] = row["noise"][high][0] / rows[BASE]["noise"][high][0]
        row["time"] = row["samples"][0] * row["seconds_per_sample"] / rows[BASE]["seconds_per_sample"]


def run(musurf, mesh, effort, folder, say):
    """[{gamma, s, mode, samplers: {name: row}}]"""
    out = []
    for gamma in GAMMAS:
        for s in STRETCHES:
            say(f"torus knot, gamma {gamma}, s {s}")
            right, spare, inside = rendering.reference(musurf, mesh, effort.size, gamma, s, effort.reference, folder)
            for mode, lit in MODES.items():
                rows = {}
                for sampler in SAMPLERS:
                    description = rendering.scene(mesh, effort.size, rendering.material(gamma, s, sampler), lit)
                    rows[sampler] = measure_one(musurf, mesh, effort, folder, description, right, spare, inside)
                compare(rows, effort)
                out.append({"gamma": gamma, "s": s, "mode": mode, "reference_variance": spare[inside].mean().item(), "samplers": rows})
    return out


def average(settings, mode, sampler, key="samples", metric=0):
    values = [row["samplers"][sampler][key] for row in settings if row["mode"] == mode]
    return float(np.mean([v[metric] if key == "samples" else v for v in values]))
