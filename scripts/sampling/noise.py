# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Figure 10 measured: the noise that each sampler leaves on the torus knot, and the samples it needs for the noise of another.

Noise is the mean over the knot's pixels of the squared difference of luminance from a long reference, less the reference's
own variance; "relative" divides each pixel's by its squared luminance (and a hundredth of the mean, lest black pixels
decide). An image sampler that stops each pixel of variance v at a noise level e, as the paper's does, takes v / e² samples
there: its samples per pixel, on average, go by the absolute noise. The renderer stratifies, so noise falls faster than 1/N: the samples that reach a given noise are read from each
sampler's own power law through its two sample counts, not from a ratio of variances.
"""
import dataclasses
import math

import numpy as np

from . import rendering

# How directions are drawn, and light: (sampler, candidates of each light sample). "auto" is one of the others, chosen by the plugin.
SAMPLERS = {name: (name, 1) for name in ("ndf", "mixed", "visible", "folded", "folded_uniform", "auto")}
# What only light sampling knows: the choice among four candidates, and all that the renderer does by itself.
LIT = {"mixed, 4 candidates": ("mixed", 4), "as rendered": (None, 4)}
MODES = {"mis": {**SAMPLERS, **LIT}, "bsdf": SAMPLERS}  # is light sampled too?
GAMMAS, STRETCHES = (1, 0.1, 4), (0, 0.25, 0.5, 0.75)
BASE = "mixed"  # the paper's own


@dataclasses.dataclass
class Effort:
    size: tuple
    reference: int  # samples per pixel, of each of two renders
    counts: tuple  # samples per pixel
    seeds: int


FULL, QUICK = Effort((96, 72), 512, (16, 64), 4), Effort((48, 36), 128, (4, 16), 2)


def errors(picture, right, inside, spare):
    """(absolute, relative) noise; `spare` is the variance of the reference itself, pixel by pixel."""
    square = ((picture - right) ** 2 - spare)[inside]
    floor = (0.1 * right[inside].mean()) ** 2
    return square.mean(), (square / (right[inside] ** 2 + floor)).mean()


def measure_one(musurf, effort, folder, description, right, spare, inside):
    """For each sample count the noise of each seed, their mean, and the processor seconds of one more sample per pixel."""
    noise, seconds = {n: [] for n in effort.counts}, {n: [] for n in effort.counts}
    for n in effort.counts:
        for seed in range(1, effort.seeds + 1):
            picture, _, spent, _ = rendering.render(musurf, description, folder, n, seed)
            noise[n].append(errors(picture, right, inside, spare))
            seconds[n].append(spent)
    low, high = effort.counts
    return {"seeds": {n: [list(map(float, e)) for e in v] for n, v in noise.items()},
            "noise": {n: np.mean(v, axis=0).tolist() for n, v in noise.items()},
            "seconds_per_sample": max((min(seconds[high]) - min(seconds[low])) / (high - low), 1e-6)}


def without(row, seed):
    """The row's noise with one seed left out."""
    return {"noise": {n: np.mean([e for k, e in enumerate(v) if k != seed], axis=0).tolist() for n, v in row["seeds"].items()}}


def samples_for(rows, level, effort, metric):
    """Samples per pixel until the noise is `level`, on the line through both counts in logarithms. Noise that the
    reference cannot tell from none counts as next to none."""
    low, high = effort.counts
    first, last = (max(rows["noise"][n][metric], 1e-30) for n in (low, high))
    slope = min(max(math.log(first / last) / math.log(high / low), 0.5), 2)
    return high * (last / max(level, 1e-30)) ** (1 / slope)


def needed(row, base, effort):
    """Samples for the noise of base at its larger count, in units of that count: by absolute and by relative noise."""
    high = effort.counts[-1]
    return [samples_for(row, base["noise"][high][m], effort, m) / high for m in (0, 1)]


def compare(rows, effort):
    """Adds to each row what it needs in units of what BASE needs at its larger count; `left_out`: the same without each seed."""
    high, base = effort.counts[-1], rows[BASE]
    for row in rows.values():
        row["samples"] = needed(row, base, effort)
        row["left_out"] = [needed(without(row, k), without(base, k), effort) for k in range(effort.seeds)] if effort.seeds > 1 else []
        row["variance"] = row["noise"][high][0] / base["noise"][high][0]
        row["time"] = row["samples"][0] * row["seconds_per_sample"] / base["seconds_per_sample"]


def run(musurf, mesh, effort, folder, say):
    """[{gamma, s, mode, chosen, samplers: {name: row}}]; `chosen` is what auto was."""
    out = []
    for gamma in GAMMAS:
        for s in STRETCHES:
            say(f"torus knot, gamma {gamma}, s {s}")
            right, spare, inside = rendering.reference(musurf, mesh, effort.size, gamma, s, effort.reference, folder)
            chosen = rendering.chosen(musurf, rendering.scene(mesh, effort.size, rendering.material(gamma, s, None)), folder)
            for mode, names in MODES.items():
                rows = {}
                for name, (sampler, candidates) in names.items():
                    if name == "auto":  # the same bits
                        rows[name] = dict(rows[chosen])
                        continue
                    description = rendering.scene(mesh, effort.size, rendering.material(gamma, s, sampler), mode == "mis", candidates)
                    rows[name] = measure_one(musurf, effort, folder, description, right, spare, inside)
                compare(rows, effort)
                out.append({"gamma": gamma, "s": s, "mode": mode, "chosen": chosen, "reference_variance": spare[inside].mean().item(),
                            "samplers": rows})
    return out


def average(settings, mode, sampler, key="samples", metric=0):
    values = [row["samplers"][sampler][key] for row in settings if row["mode"] == mode]
    return float(np.mean([v[metric] if key == "samples" else v for v in values]))


def standard_error(settings, mode, sampler, metric=0):
    """Of the average of samples: the jackknife over the seeds, which all settings share. None of a single seed."""
    left_out = np.array([[v[metric] for v in row["samplers"][sampler]["left_out"]] for row in settings if row["mode"] == mode])
    if left_out.size == 0:
        return None
    means = left_out.mean(0)
    return float(np.sqrt((len(means) - 1) / len(means) * ((means - means.mean()) ** 2).sum()))
