# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Runs the studies and leaves costs.json, fragment.html and, for each picture, a curve as scripts/reporting/curves.py draws it."""
import argparse
import json
import pathlib
import sys
import tempfile
import time

import numpy as np

from crosscheck import povray

from . import choose, draw, effort as efforts, image, process, studies, tables
from .laboratory import Laboratory, root, squares


def images(lab, plan):
    """Images against 225 points a facet by the exact tracer: resolutions that no grid divides, and multiples of the grid's."""
    series = {"pixels apart from the grid's": plan.pixels, "multiples of the grid": plan.aligned}
    found, cost = {name: {r: [] for r in pixels} for name, pixels in series.items()}, {}
    for seed in range(efforts.IMAGES, efforts.IMAGES + plan.images_of):
        file = lab.make(plan.image_size, seed)[0]
        reference = lab.measure(file, "own", efforts.REFERENCE)[0]
        for name, pixels in series.items():
            for r in pixels:
                g1, used = image.measure(lab, file, r)
                found[name][r].append(g1 / reference)
                cost.setdefault(r, []).append(used)
    return {"size": plan.image_size, "series": {name: [studies.point(f"{r}²", root(squares(values, 1.0)), process.mean(cost[r]), pixels=r)
                                                       for r, values in of.items()] for name, of in found.items()}}


def tried(lab, choice, truth, unknown, groups, seed):
    """A choice run anew, in groups of its realisations: its error against the truth (which is off by `unknown`), standard error, and time of a group."""
    values, costs = [], []
    for group in range(groups):
        runs = []
        for k in range(choice["realisations"]):
            at = seed + group * choice["realisations"] + k
            file, made = lab.make(choice["size"], at)
            g1, measured, _ = lab.measure(file, choice["tracer"], choice["points"])
            lab.forget(choice["size"], at)
            runs.append(g1)
            costs.append(process.total([made, measured]))
        values.append(np.nanmean(runs, axis=0))
    error, spread = root(squares(values, truth), unknown ** 2)
    return {"measured": error, "measured_error": spread, "groups": groups, **{f"measured_{u}": sum(c[u] for c in costs) / groups for u in choose.UNITS[:2]}}


def choices(lab, plan, found, clock):
    errors, rows, seed = choose.Errors(found["sizes"], found["samples"]), [], efforts.TRIALS
    truth = found["sizes"]["reference"] / (1 + found["samples"]["laws"][9]["ratio"])
    for tracer, points in found["samples"]["series"].items():
        runs = [(found["samples"]["size"], p["points"], p) for p in points]
        runs += [(r["size"], r["points"], r) for r in found["scales"]["rows"] if r["tracer"] == tracer and r["map"] == "identity"]
        costs = choose.Costs(found["sizes"]["makes"], runs)
        for wanted in choose.TARGETS:
            choice = choose.best(errors, costs, wanted, clock)
            rows.append({"tracer": tracer, **(choice or {"wanted": wanted, "size": None})})
            # what the reference itself does not know cannot be tried; four groups tell the error to about a third of it
            unknown = found["sizes"]["reference_error"]
            if choice and choice[clock] * 4 < plan.check and unknown < 0.7 * wanted:
                rows[-1].update(tried(lab, rows[-1], truth, unknown, 4, seed))
                seed += 4 * choice["realisations"]
    return {"rows": rows, "parts": {str(k): {"bias": b, "scatter": s} for k, (b, s) in sorted(errors.parts.items())}, "law": errors.law}


def run(options, build):
    start, plan, folder = time.monotonic(), efforts.QUICK if options.quick else efforts.FULL, pathlib.Path(options.output)
    say = lambda text: print(f"[{time.monotonic() - start:4.0f} s] {text}", file=sys.stderr, flush=True)  # noqa: E731
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="musurf-costs-") as scratch:
        lab = Laboratory(build / "musurf", pathlib.Path(scratch).resolve())
        tracers = lab.tracers()
        say("grid sizes")
        found = {"sizes": studies.sizes(lab, plan)}
        say("points per facet by " + ", ".join(tracers))
        found["samples"] = studies.subsamples(lab, plan, tracers)
        say("realisations")
        found["pool"] = studies.realisations(lab, plan)
        say("tracers over the size")
        found["scales"] = studies.scales(lab, plan, tracers)
        try:
            say("image resolution, by POV-Ray")
            found["images"] = images(lab, plan)
        except povray.PovrayError as error:
            say(f"left out: {error}")
            found["images"] = None
        say("what to choose")
        found["choices"] = choices(lab, plan, found, options.clock)
    curves = list(draw.curves(found, options.clock, options.command))
    for name, curve in curves:
        write(folder / "curves" / f"{name}.json", curve)
    used = [p for points in found["pool"]["series"].values() for p in points]
    result = {"command": options.command, "clock": options.clock, "tracers": found["scales"]["versions"], "choices": found["choices"],
              "busy": sum(p["seconds"] for p in used) / sum(p["cpu_seconds"] for p in used), "scales": found["scales"]["rows"],
              "images": {name: choose.pixels(points, options.clock) for name, points in found["images"]["series"].items()} if found["images"] else {},
              "image_size": plan.image_size, "slopes": {curve["title"]: {s["name"]: s["fit"] for s in curve["series"] if s.get("fit")} for _, curve in curves},
              "reference_error": found["sizes"]["reference_error"], "seconds": round(time.monotonic() - start, 1)}
    write(folder / "costs.json", result)
    text = tables.fragment(result, [curve for _, curve in curves])
    (folder / "fragment.html.new").write_text(text, encoding="utf-8")
    (folder / "fragment.html.new").replace(folder / "fragment.html")
    return result


def write(path, value):
    """Beside, then renamed."""
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = path.with_name(path.name + ".new")
    fresh.write_text(json.dumps(value, indent=1, ensure_ascii=False, allow_nan=False), encoding="utf-8")
    fresh.replace(path)


def main(arguments, build):
    parser = argparse.ArgumentParser("scripts/costs", description="What accuracy costs on explicit surfaces: varies the grid, the points per facet, the number of "
                                     "realisations, the pixels of an image and the tracer, and measures error, time and memory of each; fits power laws and says "
                                     "what to choose for a wanted error. One thread; run it on an idle machine. Leaves costs.json, fragment.html for scripts/report and "
                                     "curves/*.json. Exit 0: measured; 1: a step failed; 2: wrong usage.")
    parser.add_argument("--quick", action="store_true", help="small surfaces, few of them: to see that it works")
    parser.add_argument("--clock", choices=("wall", "cpu"), default="wall", help="the time that is drawn and minimised; both are told (default: %(default)s)")
    parser.add_argument("-o", metavar="DIR", dest="output", default=str(build / "costs"))
    options = parser.parse_args(arguments)
    options.command, options.clock = " ".join(["scripts/costs", *arguments]), {"wall": "seconds", "cpu": "cpu_seconds"}[options.clock]
    try:
        result = run(options, build)
    except (OSError, process.ProgramError) as error:
        print(f"costs: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    print("\n".join(tables.summary(result)))
    print(pathlib.Path(options.output) / "costs.json")
    return 0
