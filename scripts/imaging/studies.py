# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Spheres over roughness and anisotropy under several environments, and whole scenes: errors of every technique against the truth, and times.

A frame's time is in units of the bent normal's of the same round. Errors are means over a sphere; "below" and "above" are means over spheres of
alpha_lin < 0.5 and > 0.5 and all environments.
"""
import dataclasses
import pathlib
import statistics

import numpy as np

from . import errors, program, scene, techniques

HALF = 0.5
MORE = 3  # times as many rounds of a whole scene as of the spheres, which are seen under several environments


def costs(found, runs):
    """Into found[k]: medians over the rounds of several runs of the same techniques."""
    base = next(k for k, entry in enumerate(found) if entry["integrator"] == {"by": techniques.BASELINE})
    for k, entry in enumerate(found):
        ratios = [t / b for run in runs for t, b in zip(run[k]["rounds"], run[base]["rounds"])]
        entry["frame"], entry["frame_spread"] = statistics.median(ratios), [min(ratios), max(ratios)]
        for key in ("ns", "shading_ns", "rays_ns", "reads"):
            entry[key] = statistics.median(run[k][key] for run in runs)


def spheres(musurf, bench, truth, effort, folder, progress, env=None):
    """(grid, environments, noise, [technique], {"k": [...], "beta": [...]}, pictures)"""
    grid, lights = scene.Spheres(effort), scene.environments(effort.environments)
    chosen, sweeps = techniques.all_of(musurf, effort), techniques.sweeps(effort)
    found = [{"integrator": i, "label": techniques.label(i), "flip": {}, "relative": {}} for i in chosen]
    swept = {key: [{"integrator": i, "label": techniques.label(i), "value": i[key], "flip": {}, "relative": {}} for i in some] for key, some in sweeps.items()}
    noise, pictures, shape = {"flip": {}, "relative": {}}, {}, (len(grid.rows), len(grid.columns))
    truths, jobs = {}, []
    for number, (name, light) in enumerate(lights):
        for k in range(len(grid.cells)):
            progress.step(f"truth under {name}: sphere {k + 1} of {len(grid.cells)}", truth_weight(effort.cell ** 2, effort))
            truths.setdefault(name, []).append(truth.halves(grid.alone(k, light)))
        off = [errors.noise(halves, inside) for halves, inside in truths[name]]
        for key in noise:
            noise[key][name] = np.reshape([o[key] for o in off], shape).tolist()
        more = [] if number else [entry for entries in swept.values() for entry in entries]
        jobs.append((name, found + more, [scene.by(grid.sheet(light), entry["integrator"]) for entry in found + more]))
    progress.step("techniques", technique_weight(len(grid.cells), len(lights), effort))
    made = iter(program.by_techniques(bench, [one for *_, scenes in jobs for one in scenes], effort, folder / "work", env))
    runs = []
    for name, entries, scenes in jobs:
        runs.append([next(made) for _ in scenes])
        progress.step(f"errors under {name}", error_weight(len(grid.cells), len(scenes)))
        for entry, run in zip(entries, runs[-1]):
            of = [errors.both((halves[0] + halves[1]) / 2, grid.of_sheet(run["picture"], k), inside & grid.of_sheet(run["inside"], k))
                  for k, (halves, inside) in enumerate(truths[name])]
            for key in ("flip", "relative"):
                entry[key][name] = np.reshape([o[key] for o in of], shape).tolist()
            pictures[name, entry["label"]] = run["picture"]
        means_of = [(a + b) / 2 for (a, b), _ in truths[name]]
        pictures[name, "truth"] = np.concatenate([np.concatenate(means_of[r * shape[1]:(r + 1) * shape[1]], 1) for r in range(shape[0])], 0)
    costs(found, runs)
    for entry in [*found, *(entry for entries in swept.values() for entry in entries)]:
        for key in ("flip", "relative"):
            entry[f"{key}_means"] = means(grid, entry[key])
    return grid, [name for name, _ in lights], noise, found, swept, pictures


def means(grid, by_environment):
    """{"below", "above"}; None where there is no such sphere."""
    values, rows = np.array(list(by_environment.values())), np.array(grid.rows)
    return {name: float(values[:, which].mean()) if which.any() else None for name, which in (("below", rows < HALF), ("above", rows > HALF))}


def whole(musurf, bench, truth, effort, folder, progress, env=None):
    """([{"name", "environment", "noise", "techniques"}], pictures) of teapot and plate."""
    told, pictures = [], {}
    for name, width, height in effort.scenes:
        given = scene.load(name)
        light = given["lights"][0]
        if not pathlib.Path(light["image"]).exists():
            light = {"type": "studio"}
        given = scene.under(given, {key: light[key] for key in light if key != "fallback"}, width, height)
        progress.step(f"{name}: truth", 1.6 * truth_weight(width * height, effort))
        halves, inside = truth.halves(given)
        progress.step(f"{name}: techniques", technique_weight(1, 1, effort))
        found = [{"integrator": i, "label": techniques.label(i)} for i in techniques.contenders(musurf)]
        run = program.by_techniques(bench, [scene.by(given, entry["integrator"]) for entry in found], dataclasses.replace(effort, rounds=MORE * effort.rounds), folder / "work", env)
        mean = (halves[0] + halves[1]) / 2
        costs(found, [run])
        for entry, made in zip(found, run):
            entry.update(errors.both(mean, made["picture"], inside & made["inside"]))
            pictures[name, entry["label"]] = made["picture"]
        pictures[name, "truth"] = mean
        told.append({"name": name, "environment": pathlib.Path(light.get("image", "studio")).stem, "noise": errors.noise(halves, inside), "techniques": found})
    return told, pictures


def truth_weight(pixels, effort):
    """Seconds or so of one core: two halves of paths of 2 microseconds, and reading the environment."""
    return 2 * (0.25 + 2e-6 * pixels * effort.truth)


def technique_weight(materials, lights, effort):
    """Tables of albedos, filtering, frames."""
    return 1.5 * materials + lights * (3 + 1e-6 * 30 * effort.samples * effort.rounds * materials * effort.cell ** 2)


def error_weight(cells, pictures):
    return 0.02 * cells * pictures


def weight(effort):
    cells, lights = (len(effort.roughness) or 6) * (len(effort.anisotropy) or 5), len(effort.environments)
    return (cells * lights * truth_weight(effort.cell ** 2, effort) + technique_weight(cells, lights, effort) + lights * error_weight(cells, 30)
            + sum(1.6 * truth_weight(w * h, effort) + technique_weight(1, 1, effort) for _, w, h in effort.scenes))
