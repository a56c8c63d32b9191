# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The materials of a scene file as surfaces to look at: of those that a heightfield can be made for, base and map in all.

What a surface cannot have, the facets' reflectance or a sampler, is left out of the material before the core is asked;
what makes the microsurface, every parameter of distribution and map, is left in, so that the core composes M, too.
"""
import json
import pathlib

import numpy as np

from . import maps, surfaces

SHAPES = {"beckmann": ("alpha",), "ggx": ("alpha",), "gtr": ("alpha", "gamma"), "std": ("alpha", "gamma"), "sheen": ("alpha",),
          "phong": ("exponent",)}
DEFAULTS = {"ndf": "ggx", "alpha": 0.3, "gamma": 2.0, "exponent": 10.0}  # as in `musurf info`
MADE = {"material", "ndf", "alpha", "roughness", "gamma", "exponent", "alpha_x", "alpha_y", "rotation", "stretch", "transform"}
OPTICAL = {"fresnel", "sampler", "smith", "multiple_scattering", "masking", "label", "name", "description"}


class SceneError(Exception):
    """The scene cannot be read, or holds nothing that can be checked."""


def number(material, key, default=None):
    value = material.get(key, default)
    if value is not None and (isinstance(value, bool) or not isinstance(value, (int, float))):
        raise SceneError(f"{key} varies over the surface")
    return value


def own_map(m, alpha):
    """M = transform . stretch (Eq. 31) . R diag(alpha/alpha_x, alpha/alpha_y) R^T (Eq. 29)."""
    turn = maps.rotation(number(m, "rotation", 0.0))
    along = number(m, "alpha_x", alpha), number(m, "alpha_y", alpha)
    s = number(m, "stretch", 0.0)
    stretch = np.diag([1 / (1 - s), 1 - s] if s >= 0 else [1 + s, 1 / (1 + s)])
    transform = np.asarray(m.get("transform", np.eye(2)), float) if not isinstance(m.get("transform"), dict) else None
    if transform is None or transform.shape != (2, 2):
        raise SceneError("transform varies over the surface")
    return transform @ stretch @ turn @ np.diag([alpha / a for a in along]) @ turn.T


def surface(name, m, size, seed):
    """The Spec of one material; SceneError says why there is none."""
    if m.get("material") != "musurf.microfacet":
        raise SceneError(f"is of {m.get('material')}, which has no microsurface")
    ndf = m.get("ndf", DEFAULTS["ndf"])
    if ndf not in SHAPES:
        raise SceneError(f"ndf {ndf}: musurf surface make makes no such heightfield")
    strange = sorted(set(m) - MADE - OPTICAL)
    if strange:
        raise SceneError(f"{', '.join(strange)}: no single heightfield under one linear map has it")
    shape = {key: number(m, key, DEFAULTS[key]) for key in SHAPES[ndf]}
    if "alpha" in shape and "alpha" not in m:
        rough, x, y = (number(m, key) for key in ("roughness", "alpha_x", "alpha_y"))
        shape["alpha"] = rough**2 if rough is not None else (x * y) ** 0.5 if x is not None and y is not None else shape["alpha"]
    if not all(v > 0 for v in shape.values()):
        raise SceneError(f"{shape}: flat")
    spec = surfaces.Spec(name, size, seed, ndf=ndf, **{k: float(v) for k, v in shape.items()})
    spec.base = own_map(m, shape.get("alpha", 1.0))
    if not np.linalg.cond(spec.base) <= 1e3:
        raise SceneError(f"its M has condition {np.linalg.cond(spec.base):.3g}; explicit surfaces bear 1000")
    spec.whole = {k: v for k, v in m.items() if k in MADE}
    return spec


def materials(path, size, seed):
    """([Spec], {name of a material: why it is not checked})."""
    try:
        with open(path, encoding="utf-8") as file:
            found = json.load(file)
    except ValueError as error:
        raise SceneError(f"{path}: {error}") from None
    found = found.get("materials") if isinstance(found, dict) else None
    if not isinstance(found, dict) or not found:
        raise SceneError(f"{path}: has no materials")
    chosen, left = [], {}
    for name, material in found.items():
        try:
            if isinstance(material, dict) and "file" in material and "material" not in material:
                with open(pathlib.Path(path).parent / material["file"], encoding="utf-8") as file:
                    material = {k: v for k, v in json.load(file).items() if k not in ("$schema", "description")}
            chosen.append(surface(name, material, size, seed))
        except (SceneError, OSError, TypeError, ValueError, AttributeError) as error:
            left[name] = str(error)
    if not chosen:
        raise SceneError(f"{path}: none of its materials can be checked: " + "; ".join(f"{k}: {v}" for k, v in left.items()))
    return chosen, left
