# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Renders the pairs and measures how far they are apart; see --help."""
import argparse
import json
import pathlib
import subprocess
import sys
import time

import numpy as np

from crosscheck import povray

from . import charts, errors, pair, render, tables

MAPS = [("identity", ((1, 0), (0, 1))), ("stretch 3", ((3, 0), (0, 1))), ("skew", ((1, 2), (0, 1))), ("mirror", ((-0.6, 0.3), (0.2, 1)))]
# what is compared: reflections after which POV-Ray's light is lost (19 leave less than 1e-4), the material's own account of them
COMPARISONS = [("one reflection", 1, "none"), ("all, random walk", 19, "random_walk"), ("all, compensated", 19, "compensated")]
SEED = 1  # of the first realisation; the others follow


class Progress:
    """Lines on standard error with the time left, by the processor time that finished parts took."""

    def __init__(self, parts):
        self.parts, self.done, self.start = parts, 0, time.monotonic()

    def say(self, what):
        spent = time.monotonic() - self.start
        left = f", about {spent / self.done * (self.parts - self.done):.0f} s left" if self.done else ""
        print(f"geometry: [{self.done}/{self.parts}] {what}; {spent:.0f} s{left}", file=sys.stderr, flush=True)
        self.done += 1


def surrounding(options, build):
    """A photograph; a missing one is an error that says what to do. None for white."""
    if options.environment == "white":
        return None
    path = pathlib.Path(options.environment or build / "environments" / "forest.exr").resolve()
    if path.suffix not in (".exr", ".hdr"):
        raise ValueError(f"{path}: --environment takes an .exr or .hdr image that both programs read")
    if not path.exists():
        raise FileNotFoundError(2, "no such image; `make deps` fetches the photographs, --environment names another", str(path))
    return path


def plates(options):
    length = options.periods * options.size
    chosen = [(name, m) for name, m in MAPS if not options.map or name in options.map]
    return [pair.Plate(name, np.array(m, float), options.size, length) for name, m in chosen], pair.Camera(length, options.width, options.width * 3 // 4)


def one(plate, camera, surfaces, material, sky, options, musurf, folder, progress):
    """Both pictures of one M for each comparison, and the numbers."""
    slug = plate.name.replace(" ", "-")
    (folder / f"{slug}.obj").write_text(pair.plate_obj(plate))
    pictures, took = {}, {"povray": 0.0, "musurf": 0.0}
    for bounces in sorted({bounces for _, bounces, _ in COMPARISONS}):
        found = []
        for k, surface in enumerate(surfaces):
            progress.say(f"{plate.name}: facets of surface {k + 1}, {'one reflection' if bounces == 1 else 'all reflections'}")
            render.write_mesh(musurf, surface, plate.m, folder / "period.inc")
            text = pair.povray_scene(plate, camera, "period.inc", pair.povray_sky(sky), bounces)
            image, used = render.render_geometry(text, folder, f"{slug}-{bounces}", camera, options.fine)
            took["povray"] += used["cpu_seconds"]
            found.append(image)
        pictures[bounces] = np.array(found)
    whole, beyond, angle = camera.sees(plate, render.rise(surfaces))
    entries, rows = [], []
    for name, bounces, scattering in COMPARISONS:
        progress.say(f"{plate.name}: material, {name}")
        text = pair.musurf_scene(plate, camera, f"{slug}.obj", sky, dict(material, multiple_scattering=scattering))
        found = []
        for seed in (1, 2):
            image, used = render.render_material(musurf, text, folder, f"{slug}-{scattering}", options.samples, seed)
            took["musurf"] += used["cpu_seconds"]
            found.append(image)
        geometry, twice = pictures[bounces], np.array(found)
        scale = errors.exposure(geometry.mean(0)[whole])
        flip, mean = errors.flip(geometry.mean(0), twice.mean(0), whole, scale)
        deviation, error = errors.ratio(geometry, twice, whole)
        rows.append({"comparison": name, "deviation": deviation, "error": error, "flip": mean,
                     "flip_of_noise": errors.flip_floor(geometry, whole, scale), "by_angle": errors.by_angle(geometry, twice, whole, angle, options.bins)})
        entries.append({"title": name, "geometry": geometry.mean(0), "material": twice.mean(0), "flip": flip, "exposure": scale})
    seen = twice.mean(0)[beyond]
    background = float(np.abs(pictures[1].mean(0)[beyond] - seen).mean() / seen.mean())
    picture = charts.strip(entries, folder / f"{slug}.png")
    return {"name": plate.name, "transform": plate.m.tolist(), "picture": picture, "rows": rows, "background": background, "cpu_seconds": took}


def run(options, build):
    musurf, folder, start = build / "musurf", pathlib.Path(options.output), time.monotonic()
    folder.mkdir(parents=True, exist_ok=True)
    povray.find()
    sky = surrounding(options, build)
    law = {"ndf": options.ndf, "alpha": options.alpha, **({"gamma": options.gamma} if options.gamma is not None else {})}
    stages, camera = plates(options)
    progress = Progress(options.realisations * (1 + 2 * len(stages)) + len(COMPARISONS) * len(stages) + 1)
    surfaces = []
    for k in range(options.realisations):
        progress.say(f"surface {k + 1}")
        surfaces.append(folder / f"surface-{k + 1}.exr")
        render.make_surface(musurf, law, options.size, options.correlation, SEED + k, surfaces[-1])
    progress.say("fit")
    material, fitted = render.fit(musurf, surfaces[0])
    found = [one(stage, camera, surfaces, material, sky, options, musurf, folder, progress) for stage in stages]
    angles = charts.angles([(entry["name"], [(row["comparison"], row["by_angle"]) for row in entry["rows"]]) for entry in found], folder / "angles.png")
    result = {"command": options.command, "surface": {**law, "size": options.size, "correlation": options.correlation, "realisations": options.realisations},
              "environment": sky.name if sky else "white", "pixels": [camera.width, camera.height], "rays_per_pixel": options.fine ** 2, "samples": 2 * options.samples,
              "material": material, "fit": fitted, "plates": found, "angles": angles, "seconds": round(time.monotonic() - start, 1)}
    write(folder / "geometry.json", json.dumps(result, indent=1))
    write(folder / "fragment.html", tables.fragment(result, folder))
    return result


def write(path, text):
    fresh = path.with_name(path.name + ".new")
    fresh.write_text(text, encoding="utf-8")
    fresh.replace(path)


def count(low):
    def read(text):
        if not text.isdigit() or int(text) < low:
            raise argparse.ArgumentTypeError(f"{text} is no whole number from {low} on")
        return int(text)
    return read


def attempt(comparison, options, build):
    """Its result; or, where something stopped it, one line on stderr and the exit code."""
    try:
        return comparison(options, build)
    except (OSError, ValueError, KeyError, render.RenderError, povray.PovrayError, subprocess.TimeoutExpired) as error:
        print(f"geometry: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130


def main(arguments, build):
    parser = argparse.ArgumentParser("scripts/geometry-pair", formatter_class=argparse.ArgumentDefaultsHelpFormatter, description="A plate of explicit "
                                     "mirror facets in POV-Ray beside the same plate with the fitted material in musurf: same camera, same "
                                     "photographed surrounding, four M. Leaves the scene pairs, pictures, geometry.json and fragment.html for "
                                     "scripts/report. Exit 0: measured, whatever it says; 1: a step failed; 2: wrong usage.")
    parser.add_argument("--quick", action="store_true", help="small pictures, few rays: to see that it works")
    parser.add_argument("--ndf", default="ggx", help="law of the surface's slopes")
    parser.add_argument("--alpha", type=float, default=0.2)
    parser.add_argument("--gamma", type=float)
    parser.add_argument("--size", type=count(32), default=512, help="cells of a period")
    parser.add_argument("--periods", type=count(1), default=24, help="periods along the plate's edge under M = 1")
    parser.add_argument("--correlation", type=float, default=4.0, help="correlation length in cells")
    parser.add_argument("--realisations", type=count(2), default=4, help="independent surfaces; their spread gives the standard errors")
    parser.add_argument("--width", type=count(16), default=96, help="pixels; the height is 3/4 of it")
    parser.add_argument("--fine", type=count(1), default=24, help="POV-Ray's rays along a pixel's side")
    parser.add_argument("--samples", type=count(1), default=1024, help="musurf's samples in a pixel, in each of two renders")
    parser.add_argument("--bins", type=count(1), default=8, help="of the view's angle")
    parser.add_argument("--map", action="append", choices=[name for name, _ in MAPS], help="only this M; may be repeated")
    parser.add_argument("--environment", metavar="FILE", help="latitude-longitude .exr or .hdr, or white; None: the photographed forest")
    parser.add_argument("-o", metavar="DIR", dest="output", default=str(build / "geometry"))
    options = parser.parse_args(arguments)
    if options.quick:
        options.size, options.realisations, options.width, options.fine, options.samples = 256, 2, 48, 8, 64
    options.command = " ".join(["scripts/geometry-pair", *arguments])
    result = attempt(run, options, build)
    if isinstance(result, int):
        return result
    for line in tables.summary(result):
        print(line)
    print(pathlib.Path(options.output) / "geometry.json")
    return 0
