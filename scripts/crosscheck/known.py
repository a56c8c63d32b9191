# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""By how much Smith's model is known to be off, and who says so. Each answer is (lowest, highest, source) relative to Smith,
or None where no source covers the case.

Two sources, both older than any run of scripts/validate and neither POV-Ray:
- TABLE: an exact double-precision caster on Gaussian surfaces of N = 1024 and N = 512, apart from this code. Visibility per
  bin of slope along the view, at three nu = cot(theta)/alpha, on which alone the masking of a Gaussian surface depends.
  Its uncertainty, SPREAD, is what surfaces of N = 256 and of N = 1024 differed by: 4.6 %. Its albedos of single scattering
  lie above the height-correlated model by .2 to 1.1 % (alpha up to .3) and 1.1 to 1.8 % (alpha .6); GGX of alpha .3, one
  surface, by 1.1 to 3.1 %. ALBEDO rounds these up.
- known.json: crosscheck/prestudy.py, other surfaces than any validation's (seeds below 1000), with standard errors. Taken
  at its mean plus and minus four of them.
A range between two nu is the union of theirs: deviations change monotonically with nu in both sources.
"""
import functools
import json
import pathlib

import numpy as np

TABLE = {  # nu: visibility per bin, Smith's G1
    0.8932: ((0.987, 0.979, 0.965, 0.928, 0.784), 0.9625),  # alpha .3, 75 degrees
    0.2916: ((0.679, 0.658, 0.613, 0.497), 0.6458),  # alpha .3, 85 degrees
    0.1458: ((0.419, 0.409, 0.375, 0.296), 0.4039),  # alpha .6, 85 degrees
}
SPREAD = 0.046
ALBEDO = {"beckmann": ((0.1, 0.01), (0.3, 0.015), (0.6, 0.025)), "ggx": ((0.3, 0.04),)}
ERRORS = 4  # standard errors of the prestudy's that its own chance may have carried it
FILE = pathlib.Path(__file__).with_name("known.json")


@functools.cache
def prestudy():
    return json.loads(FILE.read_text())



def shape(parameters):
    """What fixes the masking as a function of nu: alpha only scales it, but for gtr and sheen."""
    keys = ("ndf", "gamma") if parameters["ndf"] in ("beckmann", "ggx", "std") else ("ndf", "gamma", "alpha", "exponent")
    return tuple(parameters.get(k) for k in keys)


def union(found, source):
    return (min(f[0] for f in found), max(f[1] for f in found), source) if found else None


def neighbours(cases, nu):
    """The ranges at the nu on both sides; flatter than all, where masking and Smith's error fade, 0 is on the far side."""
    above = [c for x, c in cases if x >= nu - 5e-4][:1]
    below = [c for x, c in cases if x <= nu + 5e-4][-1:]
    if not below:
        return []
    return below + (above or [(0.0, 0.0)])


def slope_bin(parameters, nu, index):
    """G1 of the facets in bin `index` of slope along the view."""
    if parameters is None or nu > 8:
        return None
    cases = []
    for entry in prestudy():
        if entry["kind"] == "bins" and shape(entry["surface"]) == shape(parameters) and index < len(entry["deviation"]):
            middle, error = entry["deviation"][index], ERRORS * entry["error"][index]
            cases.append((entry["nu"], (middle - error, middle + error)))
    found = neighbours(sorted(cases), nu)
    source = "prestudy"
    if parameters["ndf"] == "beckmann":
        cases = [(x, (v[index] / g1 - 1 - SPREAD, v[index] / g1 - 1 + SPREAD)) for x, (v, g1) in sorted(TABLE.items())
                 if index < len(v)]
        more = neighbours(cases, nu)
        found, source = found + more, "prestudy and table" if found and more else "table" if more else source
    return union(found, source)


def albedo(parameters, m):
    """Single scattering. m makes the surface rougher by at most 1/its least stretch; what the roughest direction has is allowed.

    The model is too dark, never too bright, as far as both sources know; 0 is included, where the error vanishes.
    """
    if parameters is None or "alpha" not in parameters:
        return None
    rough = parameters.get("alpha", 1.0) / np.linalg.svd(m, compute_uv=False)[1]
    found, source = [(0.0, 0.0)], []
    table = ALBEDO.get(parameters["ndf"], ())
    if table and rough <= table[-1][0] * 1.0001:
        found.append((0.0, float(np.interp(rough, *zip(*table)))))
        source.append("table")
    cases = prestudied("albedo", parameters, rough)
    if cases:
        source.append("prestudy")
    return union(found + cases, " and ".join(source)) if source else None


def prestudied(kind, parameters, rough):
    """Ranges over the prestudy's views and maps of the same distribution that are no rougher than the first as rough as this."""
    chosen = [(e["surface"]["alpha"] / (0.5 if e["map"] == "compression .5x" else 1), e) for e in prestudy()
              if e["kind"] == kind and shape(e["surface"]) == shape(parameters)]
    enough = [r for r, _ in chosen if r >= rough * 0.9999]
    errors = [(e["deviation"][0], ERRORS * e["error"][0]) for r, e in chosen if enough and r <= min(enough)]
    return [(middle - error, middle + error) for middle, error in errors]


def all_orders(kind, parameters, m):
    """"compensated" or "random_walk": the light left after all reflections."""
    if parameters is None or "alpha" not in parameters:
        return None
    rough = parameters.get("alpha", 1.0) / np.linalg.svd(m, compute_uv=False)[1]
    found = prestudied(kind, parameters, rough)
    return union([(0.0, 0.0), *found], "prestudy") if found else None
