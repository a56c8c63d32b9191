# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Asks, judges, and writes build/stability/: stability.json, .md, .html and pictures; see scripts/stability."""
import argparse
import json
import multiprocessing
import os
import pathlib
import sys
import time

import numpy as np
from reporting import page, readme

from . import exact, extremes, grid, measure, more, pictures, report, sampled, tables

POINTS = 3000
# What the questions must hold. A mirror is alpha = 0; "wo" is wi = wo.
WANTED = {
    "family": ("ggx", "beckmann", "gtr", "std", "phong", "sheen", "ellipsoid", "tabulated", "discrete_ggx", "discrete_beckmann", "flat"),
    "alpha": grid.ALPHAS, "gamma": tuple(sorted({*grid.GAMMAS, *grid.STD_GAMMAS})), "cos": grid.COSINES, "cond": (1.0, 10.0, 1e4, 1e8),
    "scale": (1.0, 1e-12, 1e12), "mirrored": (True,), "tilt": (0, 10, 30, 60), "masking": grid.MASKINGS,
    "light": ("wo", "almost wo", "grazing half-vector", "any", "reflected", "refracted", "backscatter", "mirror"),
    "refraction": (True,), "below": (True,), "sampler": ("visible", *more.SAMPLERS), "smith": ("exact", "spline")}


def draws(program, count, folder, say):
    """{precision: (questions, axes, exact answers, answers)} of drawn directions, and what they were held to besides."""
    found, checks = {}, {}
    for precision in tables.FORMATS:
        total, failures, questions, axes, answers = sampled.examine(program, count, precision)
        known = exact.answers(questions, folder, say, f"draws-{precision}")
        known = [sampled.doubt(question, line, measure.bits(precision)) for question, line in zip(questions, known, strict=True)]
        numbers, other = extremes.check(program, count // 4, precision)
        checks[precision] = {"numbers": {"draws of `sample`": total, **numbers}, "lines": failures + other, "failures": {
            "draws of `sample`": len(failures), **{name: sum(line.startswith(name) for line in other) for name in numbers}}}
        found[precision] = (questions, axes, known, answers)
    return found, checks


def approximation(known, answers):
    pairs = measure.approximation(known, answers)
    if not pairs:
        return None
    absolute, relative = (np.array(column) for column in zip(*pairs))
    return {"values": len(pairs), "median": float(np.median(absolute)), "p99": float(np.percentile(absolute, 99)),
            "worst": float(absolute.max()), "relative": float(relative.max())}


def measure_all(program, points, folder, say):
    start = time.monotonic()
    plain = list(grid.points(points))
    questions, axes = zip(*plain, *more.points(len(plain) + 1, points // more.SHARE))
    axes = [{"kind": "families", **where} for where in axes]
    known = exact.answers(list(questions), folder, say)
    say(f"exact answers after {time.monotonic() - start:.0f} s")
    drawn, checks = draws(program, max(8, points // 20), folder, say)
    say(f"draws after {time.monotonic() - start:.0f} s")
    records, failures, spline = [], [], None
    for precision in tables.FORMATS:
        answers = measure.ask(program, questions, precision)
        if precision == "double":
            spline = approximation(known, answers)
        for part in ((known, axes, answers), drawn[precision][2:0:-1] + drawn[precision][3:]):
            found, wrong = measure.judge(*part, precision)
            records += found
            failures += [f"{precision}: {failure}" for failure in wrong]
        failures += [f"{precision}: {line}" for line in checks[precision].pop("lines")]
    coverage = tables.coverage(records, axes, WANTED)
    if points >= POINTS:
        failures += [f"{axis} {value}: {asked} questions, {judged} values judged" for axis, value, asked, judged in coverage
                     if not asked or not judged]
    asked = [question["id"] for question in (*questions, *(q for p in tables.FORMATS for q in drawn[p][0]))]
    return {"points": len(questions), "drawn": sum(len(drawn[p][0]) for p in tables.FORMATS), "summary": tables.summary(records),
            "failures": failures, "checks": checks, "coverage": coverage, "spline": spline, "told": [report.HELD, report.spline_line(spline)], "ids": asked, "records": records}


def main(arguments, build):
    parser = argparse.ArgumentParser("scripts/stability", description="Measures the numerical stability of `musurf eval` and `musurf "
                                     "sample`. Exit 0; 1 if a value is not finite, of the wrong sign, out of range, or wrong beyond the bound.")
    parser.add_argument("--points", metavar="N", type=int, default=POINTS, help=f"how many (default {POINTS}), and a quarter more beyond the families")
    parser.add_argument("--readme", action="store_true", help="write the short table into README.md")
    parser.add_argument("-o", metavar="DIR", dest="output", default=str(build / "stability"))
    options = parser.parse_args(arguments)
    folder = pathlib.Path(options.output)

    def say(text):
        print(f"stability: {text}", file=sys.stderr, flush=True)

    found = measure_all(build / "musurf", options.points, folder, say)
    with multiprocessing.Pool(min(len(pictures.AXES), os.cpu_count())) as pool:
        pool.starmap(pictures.draw, [(found["records"], axis, folder / f"{axis}.png") for axis in pictures.AXES])
    place = {name: number for number, name in enumerate(found["ids"])}
    slim = [{**r, "id": place[r["id"]]} for r in found["records"]]
    page.write(folder / "stability.json", json.dumps({**found, "records": slim}))
    intro = report.EXPLANATION.format(count=found["points"], drawn=found["drawn"])
    report.write(found, intro, list(pictures.AXES), folder)
    short, failures = tables.markdown(*tables.short(found["summary"])), found["failures"]
    print(short, end="")
    print(report.spline_line(found["spline"]))
    for failure in failures[:20]:
        print(f"FAILED {failure}")
    print(f"{len(found['records'])} values, {len(failures)} failures; {folder / 'stability.html'}")
    if options.readme:
        readme.write("stability", f"{intro}\n{short}\n{report.spline_line(found['spline'])}\n\n{report.HELD}")
    return 1 if failures else 0
