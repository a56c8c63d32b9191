# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Runs the studies and leaves ibl.json, fragment.html, pictures and curves; see --help."""
import argparse
import dataclasses
import json
import os
import pathlib
import shutil
import sys

from modelling import make
from reporting import readme

from . import draw, page, program, sheets, studies, verdicts
from . import effort as efforts
from .progress import Progress

PICTURE = pathlib.Path(__file__).resolve().parents[2] / "scenes" / "ibl" / "techniques.png"
CAPTIONS = {"maps": "Figure 19: mean FLIP × 1000 over α_lin and η, mean over the environments.",
            "sweeps": "Figures 13 and 14: FLIP of the major axis (N = 16) over β (k = 1) and over k (β = 2.3), under the first environment."}


def write(path, text):
    """Beside, then renamed."""
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = path.with_name(path.name + ".new")
    fresh.write_text(text, encoding="utf-8")
    fresh.replace(path)


def pictures(folder, grid, environments, noise, found, swept, made, whole):
    """Draws everything; [(file, caption)]."""
    os.environ.setdefault("MPLBACKEND", "Agg")
    import matplotlib.pyplot as plt

    chosen, listed = draw.shown(found), []
    if whole:
        rows = [("", sheets.compared(whole[name], name, chosen, maps=False)) for name in whole]
        sheets.pictures.save(sheets.pictures.stacked(rows), folder / "techniques.png")
    draw.maps(plt, grid, noise, found, folder / "maps")
    listed.append(("maps.png", CAPTIONS["maps"]))
    if swept:
        draw.sweeps(plt, grid, swept, folder / "sweeps")
        listed.append(("sweeps.png", CAPTIONS["sweeps"]))
    for name in whole:
        entries = [{"label": label} for _, label in whole[name] if label != "truth"]
        sheets.pictures.save(sheets.compared(whole[name], name, entries), folder / f"{name}.png")
        listed.append((f"{name}.png", f"{name}: the truth and the techniques, below them FLIP (black: none)."))
    cell = sheets.one(grid, made, environments[0], sheets.figure_21(found), 0.4, -0.8, folder / "figure21.png", max(1, 192 // grid.side))
    listed.append(("figure21.png", f"Figure 21: a sphere of α_lin {cell.roughness:g}, η {cell.anisotropy:g} under {environments[0]}, also by filtered importance sampling with {efforts.FILTERED} reads."))
    listed += [(file, f"Spheres under {file[8:-4]}, α_lin from top to bottom, η from left to right; below, FLIP.") for file in sheets.spheres(made, environments, chosen, folder)]
    return listed


def run(options, build):
    effort, folder, musurf, bench = efforts.QUICK if options.quick else efforts.FULL, pathlib.Path(options.output), build / "musurf", build / "tests" / "bench_ibl"
    env = dict(os.environ, BUILD=str(build), MUSURF_PLUGIN_PATH=str(build))
    progress = Progress(studies.weight(effort))
    make.write()
    truth = program.Truth(musurf, folder / "truth", effort.truth)
    grid, environments, noise, found, swept, made = studies.spheres(musurf, bench, truth, effort, folder, progress, env)
    scenes, whole = studies.whole(musurf, bench, truth, effort, folder, progress, env)
    noise_means = {key: studies.means(grid, noise[key]) for key in noise}
    result = {"command": options.command, "effort": dataclasses.asdict(effort), "environments": environments, "roughness": grid.rows, "anisotropy": grid.columns, "noise": noise,
              "noise_means": noise_means, "techniques": found, "sweeps": swept, "scenes": scenes, "claims": verdicts.judged(found, scenes), "truths_made": truth.made}
    result["seconds"] = round(progress.seconds(), 1)
    curves = list(draw.curves(found, noise_means, options.command))
    for name, curve in curves:
        write(folder / "curves" / f"{name}.json", json.dumps(curve, indent=1, ensure_ascii=False))
    listed = pictures(folder, grid, environments, noise, found, swept, made, {name: {key: value for key, value in whole.items() if key[0] == name} for name in dict.fromkeys(n for n, _ in whole)})
    write(folder / "ibl.json", json.dumps(result, indent=1, ensure_ascii=False, allow_nan=False))
    write(folder / "fragment.html", page.fragment(result, folder, [curve for _, curve in curves], listed))
    shutil.rmtree(folder / "work", ignore_errors=True)
    return result


def main(arguments, build):
    parser = argparse.ArgumentParser("scripts/ibl", description="Compares the techniques of musurf render --integrator with path tracing, on the scenes of scenes/ibl: FLIP and relative "
                                     "error for N = 1 ... 64 reads against the time of a frame in the same run; maps over roughness and anisotropy; sweeps over k and β; judges what is "
                                     "claimed. Leaves ibl.json, fragment.html for scripts/report, curves/*.json, plots (PNG, SVG) and contact sheets. Path-traced pictures are kept "
                                     "in truth/ under the hash of their settings: stopped and started again, a run makes none of them twice; delete them when the path tracer has changed. Exit 0: measured, whatever it says; 1: a step "
                                     "failed; 2: wrong usage; 130: interrupted.")
    parser.add_argument("--quick", action="store_true", help="four small spheres: to see that it works")
    parser.add_argument("-o", metavar="DIR", dest="output", default=str(build / "ibl"))
    parser.add_argument("--readme", action="store_true", help="write the table into core/ibl/README.md and the picture into scenes/ibl, too")
    parser.add_argument("--from", metavar="FILE", dest="again", help="an ibl.json, for --readme without measuring again")
    options = parser.parse_args(arguments)
    options.command = " ".join(["scripts/ibl", *arguments])
    try:
        result = json.loads(pathlib.Path(options.again).read_text()) if options.again else run(options, build)
        if options.readme:
            readme.write("ibl", page.readme(result))
            if result["scenes"]:
                shutil.copyfile(pathlib.Path(options.again or options.output + "/ibl.json").with_name("techniques.png"), PICTURE)
    except (OSError, KeyError, ValueError, program.ProgramError) as error:
        print(f"ibl: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    print("\n".join(page.summary(result)))
    print(pathlib.Path(options.output) / "ibl.json")
    return 0
