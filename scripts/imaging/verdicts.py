# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What the paper claims and what was asked for, each with the numbers of this run and whether they bear it out.

Thresholds: the seed's form (major-axis, N = 16) takes at most 2.5 times the bent normal's frame; its mean FLIP is below the bent normal's for
alpha_lin < 0.5; the program's improved default has at most half the seed form's there at no higher cost, and is below the bent normal
above 0.5, too.
"""
from . import effort as efforts
from . import techniques

MOST_COST, SHARE = 2.5, 0.5


def of(found, **integrator):
    return next((entry for entry in found if entry["integrator"] == integrator), None)


def claim(name, text, number, holds):
    return {"name": name, "claim": text, "number": number, "holds": holds}


def judged(found, scenes):
    """[{"name", "claim", "number", "holds"}]."""
    seed, bent, default = of(found, by=techniques.SEED, reads=efforts.SEED), of(found, by=techniques.BASELINE), of(found, **techniques.DEFAULT)
    ratios = {"spheres": seed["frame"], **{s["name"]: of(s["techniques"], by=techniques.SEED, reads=efforts.SEED)["frame"] for s in scenes}}
    out = [claim("cost", f"A frame by the major axis (N = {efforts.SEED}) takes at most {MOST_COST:g} times one by the bent normal.",
                 ", ".join(f"{name} {ratio:.2f}" for name, ratio in ratios.items()), max(ratios.values()) <= MOST_COST)]
    mean = {key: (seed["flip_means"][key], bent["flip_means"][key]) for key in ("below", "above")}
    out.append(claim("seed", "For α_lin < 0.5 the major axis is nearer to the truth than the bent normal.", "mean FLIP {:.4f}, bent normal {:.4f}".format(*mean["below"]),
                     mean["below"][0] < mean["below"][1]))
    low, high = default["flip_means"]["below"], default["flip_means"]["above"]
    out.append(claim("half", "The default, lobe, halves the major axis’s FLIP for α_lin < 0.5 at no higher cost.",
                     f"mean FLIP {low:.4f}, {low / mean['below'][0]:.2f} of {mean['below'][0]:.4f}; frame {default['frame']:.2f}, major axis {seed['frame']:.2f}",
                     low <= SHARE * mean["below"][0] and default["frame"] <= seed["frame"]))
    return [*out, claim("above", "It is nearer to the truth than the bent normal above 0.5, too.", f"mean FLIP {high:.4f}, bent normal {mean['above'][1]:.4f}", high < mean["above"][1])]
