# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Error against run time, from the benchmarks: each curve's error and time come from the same run.

A curve is a JSON object: "title", "text", "command"; "x" and "y": {"label", "log"}; "series": [{"name", "line", "points": [{"x",
"y", "label"}]}]; more than that, such as "rows", is for readers of the JSON alone, except that a series may have a power law, "fit":
{"slope", "error", "factor"}, and points "y_error" (one standard error) and what they took: "seconds", "cpu_seconds", "megabytes". scripts/reporting/curves.py draws every file
of that form in a folder, in the order of their names.
"""
import argparse
import json
import os
import pathlib
import subprocess
import sys

from . import compensation, page


def lines_of(program):
    done = subprocess.run([str(program), "--json"], text=True, capture_output=True, check=True)
    return [json.loads(line) for line in done.stdout.splitlines()]


def named(program):
    return f"{os.path.join(os.path.basename(os.path.dirname(program)), os.path.basename(program))} --json"


def series(name, rows, x, label, line=True):
    return {"name": name, "line": line, "points": [{"x": r[x], "y": max(r["error"], 1e-17), "label": label(r)} for r in rows]}


def masking_series(rows, x):
    of = {kind: [r for r in rows if r["kind"] == kind] for kind in ("quadrature", "table", "exact", "spline (approximate)")}
    out = []
    if x == "ns":
        out.append(series("quadrature in double, by its step h", of["quadrature"], x, lambda r: f"h {r['step']:.3g}"))
    out.append(series("float table, by octaves more or fewer", of["table"], x, lambda r: f"{r['octaves']:+.0f}, {r['bytes']:.0f} B"))
    for kind in ("exact", "spline (approximate)"):
        for row in of[kind]:
            name = f"{kind}, {'float' if row['bits'] == 32 else 'double'}, as shaded"
            out.append(series(name, [row], x, lambda r: f"{r['bytes']:.0f} B", line=False))
    return out


def masking(program):
    rows, text = lines_of(program), ("Largest error of G1 of GTR over alpha from 1e-4 to 1, gamma from 0 to 4, to 89.99°, against the rule at half "
                                     "the step. The table is timed alone, the rest with all that musurf.h does around it.")
    common = {"command": named(program), "y": {"label": "largest error of G1", "log": True}}
    yield "1-masking-time", dict(common, title="Masking: error against the time of one value", text=text, series=masking_series(rows, "ns"),
                                 x={"label": "nanoseconds of processor time", "log": True})
    yield "2-masking-compile", dict(common, title="Masking: error against what a material costs to compile", series=masking_series(rows, "compile_us"),
                                    text="The same values against the time that making the material takes, with the bytes of its tables.",
                                    x={"label": "microseconds to compile a material", "log": True})


def samplers(program):
    found = {}
    for row in lines_of(program):
        key = row["group"], row["alpha"], row["gamma"], json.dumps(row["transform"]), row["theta"]
        found.setdefault(key, {})[row["sampler"]] = row
    groups = {}
    for (group, _, gamma, _, _), rows in found.items():
        for name, row in rows.items():
            groups.setdefault(name, {}).setdefault(f"{group} {gamma:g}" if group in ("gtr", "std") else group, []).append(row)
    out = []
    for name, of in groups.items():
        points = [{"x": sum(r["ns"] for r in rows) / len(rows), "y": sum(r["variance"] for r in rows) / len(rows), "label": label}
                  for label, rows in of.items()]
        out.append({"name": name, "line": False, "points": points})
    yield "3-samplers", {"title": "Samplers: variance against the time of one sample", "command": named(program), "series": out,
                         "text": "Mean over views to 87° and maps, in a white furnace, float. Equal variance times time is equal worth where rays "
                                 "cost nothing; where they cost most, variance alone counts.",
                         "x": {"label": "nanoseconds of processor time", "log": True}, "y": {"label": "variance of one sample", "log": True}}


def compensated(program):
    return compensation.curves(lines_of(program), named(program))


def main(arguments, build):
    parser = argparse.ArgumentParser("scripts/curves", description="Measures error against run time with the benchmarks of the build folder and "
                                     "writes one JSON file for each curve. Exit 0; 1 if a benchmark is missing or fails; 2 on wrong usage.")
    parser.add_argument("-o", metavar="DIR", dest="output", default=str(build / "curves"))
    options = parser.parse_args(arguments)
    try:
        for make, program in ((masking, "bench_masking"), (samplers, "bench_samplers"), (compensated, "bench_albedo")):
            for name, curve in make(build / "tests" / program):
                path = pathlib.Path(options.output) / f"{name}.json"
                page.write(path, json.dumps(curve, indent=1, ensure_ascii=False))
                print(path)
    except OSError as error:
        print(f"curves: {error.filename}: {error.strerror}; `make report` builds the benchmarks", file=sys.stderr)
        return 1
    except (subprocess.CalledProcessError, ValueError, KeyError) as error:
        print(f"curves: {error}", file=sys.stderr)
        return 1
    return 0
