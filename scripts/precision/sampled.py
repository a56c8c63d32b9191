# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Directions that `musurf sample` draws from hostile materials, by every sampler, of single and of multiple scattering.

Of each draw: numbers are finite, none is negative, wi is a unit vector, and the weight stays below its bound. It is F G2/G1 or
less, at most 1, of visible normals however they are drawn, and over 7/10 where 3/10 are uniform; F < 1 - F is spent on
the choice of a side. Radiance that is refracted carries 1/eta^2. A walk is worth at most that too. D cos and what is mixed with
it have no bound. Compensation draws each lobe as likely as it sends light on: no simple bound either.
Of single scattering, two draws of each material become questions: f, pdf and weight of the drawn direction, exactly. wi and wm say
the same twice, each rounded: how far the values are apart that both have counts among what rounding may move (a lobe narrower
than 2^-p hides between two neighbours of wi).
"""
import json
import math
import random
import subprocess
from concurrent.futures import ThreadPoolExecutor

import mpmath as mp
import smith  # of tests/reference
from bsdf import Bsdf, dot, unit
from conditioning import ROUNDINGS

from . import more
from .grid import law, point

SEED = 20261127
DRAWS, KEPT = 32, 2
BOUNDED = {"visible": 1, "folded": 1, "bounded": 1, "visible_uniform": 1 / 0.7, "folded_uniform": 1 / 0.7}
UNIT = {"double": 2.0**-53, "float": 2.0**-24}


def materials(count):
    """(material, wo, axes, name), `count` of them: every sampler, refraction, compensation and walks."""
    rng = random.Random(SEED)
    for number in range(count):
        how = ("visible", "visible", "tabulated", "samplers", "samplers", "compensated", "random_walk", "random_walk")[number % 8]
        m = more.histogram(rng) if how == "tabulated" else more.sampled_by(rng) if how == "samplers" else law(rng)
        while how != "tabulated" and m.get("alpha") == 0:
            m = law(rng)
        tilts = (0,) if m.get("sampler") == "bounded" or how == "compensated" else (0, 0, 10, 60)
        multiple = how in ("compensated", "random_walk")
        if multiple:
            m["multiple_scattering"] = how
        question, axes, name = point(rng, m, tilts=tilts, glass=0 if how == "samplers" else 0.3)
        if how == "random_walk":
            question["material"].pop("masking", None)  # the walk has its own
        if how == "compensated" and m["ndf"] == "ellipsoid":  # its own tilt may be beyond what tables can follow
            question["material"].update({"ndf": "ggx", "alpha": 0.5})
            for key in ("A", "alpha_x", "alpha_y", "theta_x", "theta_y", "theta_z"):
                question["material"].pop(key, None)
        yield question["material"], question["wo"], {**axes, "kind": "samples"}, name


def draw(program, material, wo, seed, precision):
    done = subprocess.run([program, "sample", "--n", str(DRAWS), "--seed", str(seed), "--precision", precision],
                          input=json.dumps({"material": material, "wo": wo}), text=True, capture_output=True)
    if done.returncode:
        return done.stderr.strip()
    return [json.loads(line) for line in done.stdout.splitlines()]


def most(material, wo):
    """The largest weight there may be, of reflection and of refraction; None: no bound."""
    multiple = material.get("multiple_scattering")
    bound = 1 if multiple == "random_walk" else None if multiple else BOUNDED.get(material.get("sampler", "visible"))
    if bound is None:
        return None
    eta = material["fresnel"]["dielectric"] if material.get("transmission") else 1
    eta = 1 / eta if wo[2] < 0 else eta
    return {False: bound, True: bound / eta**2}


def problems(material, wo, s, precision):
    """What is wrong with a draw by itself."""
    numbers = [*s["f"], s["pdf"], *s["weight"], *(s["wi"] or ())]
    if not all(isinstance(x, (int, float)) and math.isfinite(x) for x in numbers):
        return ["not finite"]
    found = ["negative"] if min(*s["f"], s["pdf"], *s["weight"]) < 0 else []
    if s["wi"] is None:
        return found
    # normalised, and turned about a unit normal where it was not: three roundings of each component
    if abs(math.hypot(*s["wi"]) - 1) > 8 * UNIT[precision]:
        found.append(f"|wi| - 1 = {math.hypot(*s['wi']) - 1:.3g}")
    bounds = most(material, wo)
    # a quotient of sums is clamped to 1; its products with F, 1/eta^2 and a share are rounded
    if bounds and max(s["weight"]) > bounds[s["wi"][2] * wo[2] < 0] * (1 + 32 * UNIT[precision]):
        found.append(f"weight {max(s['weight'])!r} above {bounds[s['wi'][2] * wo[2] < 0]}")
    return found


def sent(question):
    """Where wm sends wo, exactly; None: nowhere."""
    o, m, i = (unit([mp.mpf(x) for x in question[name]]) for name in ("wo", "wm", "wi"))
    c = dot(o, m)
    if o[2] * i[2] > 0:
        return [2 * c * p - q for p, q in zip(m, o)]
    eta = mp.mpf(question["material"]["fresnel"]["dielectric"])
    eta = 1 / eta if o[2] < 0 else eta
    square = 1 - (1 - c * c) / (eta * eta)
    return [(c / eta - mp.sqrt(square)) * p - q / eta for p, q in zip(m, o)] if square > 0 else None


def doubt(question, line, bits):
    """Adds to how ill-posed each exact value is what moves it from wi to where wm sends wo."""
    wi, key_of_c = sent(question), f"c{bits}"
    found = {} if wi is None else Bsdf(question["material"], question["wo"], question["wm"], wi, sampled=True).evaluate(
        lambda *where: smith.Lambda(*where[:-1], digits=20))
    for key, value in line["expect"].items():
        value = mp.mpf(value)
        if value and key in line[key_of_c]:
            moved = abs(found[key] / value - 1) * 2**bits / ROUNDINGS if key in found else mp.inf
            line[key_of_c][key] = float(min(mp.mpf(10) ** 99, line[key_of_c][key] + moved))
    return line


def examine(program, count, precision):
    """(number of draws, failures, questions, axes, answers of `sample`, of single scattering)."""
    cases = list(materials(count))
    with ThreadPoolExecutor(2) as pool:
        all_drawn = list(pool.map(lambda case: draw(program, case[1][0], case[1][1], case[0], precision), enumerate(cases)))
    total, failures, questions, axes, answers = 0, [], [], [], []
    for (material, wo, where, name), drawn in zip(cases, all_drawn):
        if isinstance(drawn, str):
            failures.append(f"sample of {name}: {drawn}")
            continue
        total += len(drawn)
        failures += [f"sample of {name}: {what}: {json.dumps(s)}" for s in drawn for what in problems(material, wo, s, precision)]
        single = [s for s in drawn if s["wi"] and not s.get("delta") and "multiple_scattering" not in material]
        for s in single[:KEPT]:
            label = f"draw {len(questions) + 1}: {name}"
            questions.append({"id": label, "material": material, "wo": wo, "wm": s["wm"], "wi": s["wi"], "sampled": True})
            axes.append(where)
            answers.append({"id": label, "f": s["f"], "F": [], "pdf": s["pdf"], "weight": s["weight"][0]})
    return total, failures, questions, axes, answers
