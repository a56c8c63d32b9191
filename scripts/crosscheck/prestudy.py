# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""How far Smith is off on explicit surfaces, measured apart from POV-Ray: writes known.json.

    python -m crosscheck.prestudy BUILD [SURFACES]        (in scripts/)

Surfaces of seeds that scripts/validate does not use (below 1000 there: its seeds times 1000), seen by the exact caster of
`musurf surface measure` and followed by `musurf surface statistics`, both in double precision. Kept are deviations from
the core's Smith model as it was then, which tests hold to references of 30 digits; with standard errors over surfaces.
"""
import concurrent.futures
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

from . import expect, maps, measure, plan, predict, store, surfaces

HERE = pathlib.Path(__file__).parent
SEED = 100
REFLECTING = 5  # of the surfaces, for these take longer
MIRROR_MAPS = {"identity": np.eye(2), "compression .5x": np.diag([1.0, 0.5])}
MIRROR_THETAS = (30, 60, 75)
LAWS = {"none": 1, f"dielectric:{measure.INDEX:g}": 20}  # and the reflections to follow


def asked(core, *words):
    done = subprocess.run([str(core.program), "surface", *words, "--threads", "1"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)


def comma(numbers):
    return ",".join(format(float(x), ".17g") for x in np.ravel(numbers))


def bins(core, spec, files):
    """Mean visibility of the facets per slope along the view against Smith's G1."""
    for theta in (60, 75, 85):
        view = maps.direction(theta, 33)
        cuts = measure.edges(measure.nu(view, spec.alpha))
        limits = [-1e9, *(e * spec.alpha for e in cuts[1:-1]), 1e9]
        found = [asked(core, "measure", f, f"--view={comma(view)}", f"--bins={comma(limits)}")["views"][0]["bins"] for f in files]
        values = np.array([[b["G1"] for b in one] for one in found])
        g1 = expect.masking(core, spec, np.eye(2), [view])[0][0]
        yield {"kind": "bins", "nu": measure.nu(view, spec.alpha), **summary(values, g1)}


def summary(values, model):
    return {"deviation": np.atleast_1d(values.mean(0) / model - 1).tolist(),
            "error": np.atleast_1d(values.std(0, ddof=1) / np.sqrt(len(values)) / model).tolist()}


def reflections(core, spec, files):
    views = [maps.direction(theta, 33) for theta in MIRROR_THETAS]
    for name, m in MIRROR_MAPS.items():
        said = {law: [asked(core, "statistics", f, *(f"--view={comma(v)}" for v in views), f"--transform={comma(m)}",
                            f"--bounces={count}", f"--fresnel={law}")["views"] for f in files]
                for law, count in LAWS.items()}
        for k, (view, theta) in enumerate(zip(views, MIRROR_THETAS)):
            model = expect.reflection(core, spec, m, view)
            once, every = ([one[k]["reflection"][0] for one in found] for found in said.values())
            once = np.array([r["orders"][0]["albedo"] for r in once])
            every = np.array([r["escaped"] for r in every])
            for kind, values, value in (("albedo", once, model["bins"].sum()), ("compensated", every, model["compensated"]),
                                        ("random_walk", every, model["walk"])):
                yield {"kind": kind, "map": name, "theta": theta, **summary(values, value)}


def study(core, name, parameters, count):
    spec, entries = surfaces.Spec(name, 256, SEED, **parameters), []
    with tempfile.TemporaryDirectory() as folder:
        files = [f"{folder}/{k}.exr" for k in range(count)]
        for k, file in enumerate(files):
            asked_make = [f"--{key}={value}" for key, value in parameters.items()]
            subprocess.run([str(core.program), "surface", "make", *asked_make, "--size=256", f"--seed={SEED + k}", "-o", file],
                           check=True, capture_output=True)
        for entry in (*bins(core, spec, files), *reflections(core, spec, files[:REFLECTING])):
            entries.append({"surface": parameters, **entry})
            print(json.dumps(entries[-1]), flush=True)
    return entries


def main(build, count=16):
    build = pathlib.Path(build)
    core = predict.Core(build / "musurf", store.Store(build / "prestudy"))
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        found = pool.map(lambda item: study(core, *item, int(count)), plan.DISTRIBUTIONS["full"].items())
        entries = [e for one in found for e in one]
    (HERE / "known.json").write_text("[\n" + ",\n".join(json.dumps(e) for e in entries) + "\n]\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
