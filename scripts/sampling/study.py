# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Runs the study from the command line to the files it leaves: efficiency.json, fragment.html, pictures."""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

from reporting import readme

from . import charts, equation2, furnace, knot, masking, noise, rendering, tables

GOAL = 0.75  # of the samples that mixed needs, on average; checked, never tuned for


def write(path, text):
    """Beside, then renamed."""
    fresh = path.with_name(path.name + ".new")
    fresh.write_text(text, encoding="utf-8")
    fresh.replace(path)


def verdict(settings):
    """Averages over the settings of Figure 10 in units of what mixed needs."""
    out = {}
    for mode, names in noise.MODES.items():
        out[mode] = {name: {"samples": noise.average(settings, mode, name), "standard_error": noise.standard_error(settings, mode, name),
                            "samples_relative_noise": noise.average(settings, mode, name, metric=1),
                            "time": noise.average(settings, mode, name, "time"), "variance": noise.average(settings, mode, name, "variance")}
                     for name in names}
    return out


def run(options, build):
    start, folder, musurf = time.monotonic(), pathlib.Path(options.output), build / "musurf"
    effort = noise.QUICK if options.quick else noise.FULL
    say = lambda text: print(f"[{time.monotonic() - start:4.0f} s] {text}", file=sys.stderr, flush=True)  # noqa: E731
    folder.mkdir(parents=True, exist_ok=True)
    say("masking: spline against exact")
    exact, spline, worst = masking.run(musurf)
    charts.figure_9(exact, spline, folder / "figure9.png")
    say("masking: Eq. (2)")
    away, defining = equation2.run(musurf)
    charts.equation_2(away, folder / "equation2.png")
    say("samplers in a white furnace")
    found = furnace.run(build)
    with tempfile.TemporaryDirectory(prefix="musurf-knot-") as scratch:
        scratch = pathlib.Path(scratch)
        mesh = knot.write(scratch / "knot.ply")
        say("the torus knot")
        size = (80, 60) if options.quick else (240, 180)
        charts.knots([(s, rendering.preview(musurf, mesh, size, 1, s, scratch, 16 if options.quick else 256)) for s in noise.STRETCHES],
                     folder / "knot.png")
        settings = noise.run(musurf, mesh, effort, scratch, say)
    charts.figure_10(settings, folder / "figure10.png")
    averages = verdict(settings)
    result = {"command": options.command, "effort": vars(effort), "goal": GOAL,
              "reached": {mode: {name: averages[mode][name]["samples"] <= GOAL for name in ("auto", "as rendered") if name in noise.MODES[mode]}
                          for mode in noise.MODES},
              "averages": averages, "figure9": worst, "equation2": defining, "figure10": settings, "furnace": furnace.table(found),
              "bounded": furnace.bounded(found), "equal_time": furnace.equal_time(found), "seconds": round(time.monotonic() - start, 1)}
    write(folder / "efficiency.json", json.dumps(result, indent=1))
    write(folder / "fragment.html", tables.fragment(result, folder))
    return result


def main(arguments, build):
    parser = argparse.ArgumentParser("scripts/efficiency", description="What exact masking and visible normals are worth: redraws Figure 9 (masking by "
                                     "the spline of Appendix A against the exact one) and measures Figure 10 (noise of the samplers on a "
                                     "torus knot, against a long reference, by BSDF sampling alone and as rendered). Leaves efficiency.json, "
                                     "fragment.html for scripts/report, and pictures. Exit 0: measured, whatever it says; 1: a step failed.")
    parser.add_argument("--quick", action="store_true", help="small pictures and few samples: to see that it works")
    parser.add_argument("-o", metavar="DIR", dest="output", default=str(build / "efficiency"))
    parser.add_argument("--readme", action="store_true", help="write the averages into README.md, too")
    parser.add_argument("--from", metavar="FILE", dest="again", help="an efficiency.json, for --readme without measuring again")
    options = parser.parse_args(arguments)
    options.command = " ".join(["scripts/efficiency", *arguments])
    try:
        result = json.loads(pathlib.Path(options.again).read_text()) if options.again else run(options, build)
    except (OSError, rendering.RenderError) as error:
        print(f"efficiency: {error}", file=sys.stderr)
        return 1
    except subprocess.CalledProcessError as error:
        print(f"efficiency: {error.cmd[0]}: exit {error.returncode}: {(error.stderr or '').strip()}", file=sys.stderr)
        return 1
    if options.readme:
        readme.write("efficiency", tables.readme(result))
    for line in tables.summary(result):
        print(line)
    print(pathlib.Path(options.output) / "efficiency.json")
    return 0
