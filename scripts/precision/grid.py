# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The questions: a fixed-seed sample of the product of everything that may go wrong.

Families x alpha x gamma x M (condition to 1e8, scale 1e+-12, turned, mirrored) x tilt to 60 degrees x maskings x views to 1e-9
from the horizon x lights (wo itself, almost wo, mirrored, over the viewer's back at grazing, reflected or refracted by a
micronormal the material has, anywhere) x both sides of a dielectric.
"""
import math
import random

import questions  # of tests/reference
from make_families import MASKINGS, anisotropy, ellipsoid
from make_reference import FRESNEL

SEED = 20260815
ALPHAS = (0.0, 1e-7, 1e-4, 0.01, 0.1, 0.5, 1 - 1e-7, 1.0)
GAMMAS = (0.0, 1e-9, 1 - 1e-9, 1 + 1e-9, 1.5, 2 - 1e-9, 2 + 1e-9, 3.0, 4.0, 10.0)
STD_GAMMAS = (1.5 + 1e-6, 2 - 1e-9, 2 + 1e-9, 3.0, 4.0, 10.0)
EXPONENTS = (0.0, 1.0, 30.0, 1e3, 1e6)
CONDITIONS = (1.0, 1.0, 10.0, 1e4, 1e8)
SCALES = (1.0, 1.0, 1.0, 1e-12, 1e12)
TILTS = (0, 0, 0, 10, 30, 60)
COSINES = (1.0, math.cos(math.radians(1)), 0.8, 0.5, 0.1, 1e-2, 1e-4, 1e-6, 1e-9)
ETAS = (1.5, 1 / 1.5, 1.0001, 2.4)
LAWS = ("ggx", "beckmann", "gtr", "gtr", "gtr", "std", "std", "phong", "sheen", "ellipsoid", "ellipsoid")


def direction(rng, cosine):
    phi, sine = rng.uniform(0, 2 * math.pi), math.sqrt((1 - cosine) * (1 + cosine))
    return [sine * math.cos(phi), sine * math.sin(phi), cosine]


def turned(v, angle):
    c, s = math.cos(angle), math.sin(angle)
    return [c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]]


def transform(rng):
    """scale R(a) diag(sqrt k, 1/sqrt k) R(b), half of them mirrored, and its condition and scale."""
    k, scale = rng.choice(CONDITIONS), rng.choice(SCALES)
    if k == 1 and scale == 1 and rng.random() < 0.5:
        return {}, 1.0, 1.0
    (c, s), (e, f) = ((math.cos(x), math.sin(x)) for x in (rng.uniform(0, 7), rng.uniform(0, 7)))
    p, q = scale * math.sqrt(k), scale / math.sqrt(k) * rng.choice((-1, 1))
    return {"transform": [[c * p * e - s * q * f, -c * p * f - s * q * e],
                          [s * p * e + c * q * f, c * q * e - s * p * f]]}, k, scale


def law(rng):
    ndf = rng.choice(LAWS)
    if ndf == "ellipsoid":
        return ellipsoid(rng, rng.random() < 0.5)
    if ndf == "phong":
        return {"ndf": ndf, "exponent": rng.choice(EXPONENTS)}
    m = {"ndf": ndf, "alpha": rng.choice(ALPHAS if ndf != "sheen" else ALPHAS[1:])}
    if ndf in ("gtr", "std"):
        m["gamma"] = rng.choice(GAMMAS if ndf == "gtr" else STD_GAMMAS)
    return m


def light(rng, material, wo, wm, eta):
    how = rng.choice(("wo", "almost wo", "grazing half-vector", "any", "micronormal", "micronormal", "micronormal"))
    if how == "wo":
        return list(wo), how
    if how == "almost wo":
        return questions.unit([x + 1e-6 * rng.gauss(0, 1) for x in wo[:2]] + [wo[2]]), how
    if how == "grazing half-vector":  # beside the viewer, as low: the half-vector is as low too; or straight across
        level = direction(rng, rng.choice(COSINES[-4:]))
        return (turned([math.hypot(*level[:2]), 0.0, level[2]], math.atan2(wo[1], wo[0]) +
                       rng.choice((0.01, 1.0, 2.0, math.pi, math.pi - 1e-6)))), how
    if how == "any":
        wi = direction(rng, rng.choice(COSINES))
        return ([wi[0], wi[1], -wi[2]] if eta and rng.random() < 0.5 else wi), how
    return questions.light(rng, material, wo, wm, eta)


def clear(m):
    """Whether the surface is a mirror or a pane, whose one direction no eval shows."""
    return m["ndf"] == "flat" or m.get("alpha") == 0


def point(rng, m, tilts=TILTS, glass=0.25, cosines=COSINES):
    """A material with a law of normals, moved and put before directions: (question, where on the axes it lies, its name)."""
    M, k, scale = transform(rng)
    m.update(M)
    if m["ndf"] not in ("ellipsoid", "phong") and m.get("alpha", 0) > 0 and rng.random() < 0.2:
        m.update(anisotropy(rng))
    lean = rng.choice(tilts)
    if lean:
        slope, phi = math.tan(math.radians(lean)), rng.uniform(0, 2 * math.pi)
        m["tilt"] = [slope * math.cos(phi), slope * math.sin(phi)]
    if rng.random() < 0.5:
        m["masking"] = rng.choice(MASKINGS)
    below, eta = False, None
    if rng.random() < glass:
        eta, below = rng.choice(ETAS), rng.random() < 0.5
        m.update({"transmission": True, "fresnel": {"dielectric": eta}})
        eta = 1 / eta if below else eta
    elif rng.random() < 0.3:
        m["fresnel"] = rng.choice(FRESNEL)[2]
    cosine = rng.choice(cosines)
    wo = direction(rng, cosine)
    wm = direction(rng, rng.choice(COSINES)) if clear(m) else questions.micronormal(rng, m, wo)
    wi, how = light(rng, m, wo, wm, eta)
    sign = -1 if below else 1
    wo, wm, wi = ([sign * x for x in v] for v in (wo, wm, wi))
    rows = m.get("transform", [[1, 0], [0, 1]])
    alpha = None if m["ndf"] in ("ellipsoid", "tabulated", "flat") else \
        m["alpha"] if m["ndf"] != "phong" else math.sqrt(2 / (m["exponent"] + 2))
    axes = {"family": m["ndf"], "alpha": alpha, "gamma": m.get("gamma"), "cos": cosine, "cond": k, "scale": scale, "tilt": lean,
            "light": how, "refraction": sign * wi[2] < 0, "below": below, "sampler": m.get("sampler", "visible"),
            "smith": m.get("smith", "exact"), "masking": m.get("masking", "height_correlated"),
            "mirrored": rows[0][0] * rows[1][1] < rows[0][1] * rows[1][0]}
    text = ", ".join(f"{key} {value if isinstance(value, str) else format(value, '.10g')}" for key, value in m.items()
                     if isinstance(value, float) or key in ("sampler", "smith", "multiple_scattering"))
    name = f"{m['ndf']} {text}; M cond {k:g} scale {scale:g}; tilt {lean}; wo.z {sign * cosine:g}; wi {how}"
    return {"material": {"material": "musurf.microfacet", **m}, "wo": wo, "wm": wm, "wi": wi}, axes, name


def points(count):
    """(question of `musurf eval`, where on the axes it lies), `count` of them, always the same."""
    rng = random.Random(SEED)
    for number in range(1, count + 1):
        question, axes, name = point(rng, law(rng))
        yield {"id": f"{number}: {name}", **question}, axes
