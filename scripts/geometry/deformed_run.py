# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Renders deformed plates both ways and judges their highlights; see --help."""
import argparse
import json
import pathlib
import time

import numpy as np

from crosscheck import povray

from . import charts, deformed, deformed_tables, errors, highlight, render
from .run import SEED, Progress, attempt, count, write

TURN = np.radians(35)
DEFORMATIONS = [("stretch", ((2.5, 0), (0, 1))), ("shear", ((1, 1), (0, 1))),
                ("stretch, shear, turn", np.array(((np.cos(TURN), -np.sin(TURN)), (np.sin(TURN), np.cos(TURN)))) @ ((1.8, 0.6), (0, 0.9)))]


def facets(plate, eye, surfaces, options, musurf, folder, progress):
    found = []
    for k, surface in enumerate(surfaces):
        progress.say(f"{plate.name}: facets of surface {k + 1}")
        render.write_mesh(musurf, surface, plate.m, folder / "period.inc")
        text = deformed.pair.povray_scene(plate, eye, "period.inc", deformed.povray_lamp(plate.length), 1)
        found.append(render.render_geometry(text, folder, slug(plate), eye, options.fine)[0])
    return np.array(found)


def shaded(plate, eye, material, options, musurf, folder, tension):
    """Two pictures of independent noise."""
    name = slug(plate)
    for kind in ("rest", "deformed"):
        (folder / f"{name}-{kind}.obj").write_text(deformed.plate_obj(plate, kind == "deformed"))
    text = deformed.musurf_scene(plate, eye, (f"{name}-rest.obj", f"{name}-deformed.obj"), material, tension)
    return np.array([render.render_material(musurf, text, folder, f"{name}-{'tension' if tension else 'as-at-rest'}", options.samples, seed)[0] for seed in (1, 2)])


def slug(plate):
    return plate.name.replace(", ", "-")


def one(plate, eye, surfaces, law, options, musurf, folder, progress):
    geometry = facets(plate, eye, surfaces, options, musurf, folder, progress)
    whole, _, _ = eye.sees(plate, render.rise(surfaces))
    place, epsilon = highlight.places(eye, plate.length), highlight.tolerance(law, plate.m)
    progress.say(f"{plate.name}: material")
    material = {"material": "musurf.microfacet", **law}
    pictures = {tension: shaded(plate, eye, material, options, musurf, folder, tension) for tension in (True, False)}
    scale = errors.exposure(geometry.mean(0)[whole]) / 2
    flip, mean = errors.flip(geometry.mean(0), pictures[True].mean(0), whole, scale)
    return {"name": plate.name, "deformation": plate.m.tolist(), "tolerance": epsilon,
            "rows": highlight.rows(geometry, pictures[True], whole, place, epsilon),
            "as_at_rest": highlight.rows(geometry, pictures[False], whole, place, epsilon),
            "ellipses": {name: highlight.ellipse(picture.mean(0), whole, place)
                         for name, picture in (("facets", geometry), ("tension", pictures[True]), ("as at rest", pictures[False]))},
            "flip": mean, "flip_of_noise": errors.flip_floor(geometry, whole, scale),
            "picture": {"title": plate.name, "geometry": geometry.mean(0), "material": pictures[True].mean(0), "flip": flip, "exposure": scale}}


def run(options, build):
    musurf, folder, start = build / "musurf", pathlib.Path(options.output), time.monotonic()
    folder.mkdir(parents=True, exist_ok=True)
    povray.find()
    law = {"ndf": options.ndf, "alpha": options.alpha, **({"gamma": options.gamma} if options.gamma is not None else {})}
    length = options.periods * options.size
    plates = [deformed.Deformed(name, np.array(m, float), options.size, length) for name, m in DEFORMATIONS if not options.deformation or name in options.deformation]
    eye = deformed.camera(length, options.width, options.width)
    progress = Progress(options.realisations * (1 + len(plates)) + len(plates))
    surfaces = []
    for k in range(options.realisations):
        progress.say(f"surface {k + 1}")
        surfaces.append(folder / f"surface-{k + 1}.exr")
        render.make_surface(musurf, law, options.size, options.correlation, SEED + k, surfaces[-1])
    found = [one(plate, eye, surfaces, law, options, musurf, folder, progress) for plate in plates]
    picture = charts.strip([entry.pop("picture") for entry in found], folder / "deformed.png")
    result = {"command": options.command, "surface": {**law, "size": options.size, "correlation": options.correlation, "realisations": options.realisations},
              "pixels": [eye.width, eye.height], "rays_per_pixel": options.fine ** 2, "samples": 2 * options.samples, "level": highlight.LEVEL,
              "plates": found, "picture": picture, "seconds": round(time.monotonic() - start, 1)}
    write(folder / "deformed.json", json.dumps(result, indent=1))
    write(folder / "fragment.html", deformed_tables.fragment(result, folder))
    return result


def main(arguments, build):
    parser = argparse.ArgumentParser("scripts/geometry-tension", formatter_class=argparse.ArgumentDefaultsHelpFormatter, description="A plate with an explicit "
                                     "heightfield of mirror facets, deformed as a whole, in POV-Ray beside the deformed plate's mesh with \"tension\" in musurf: the highlight "
                                     "of a small lamp, its light, peak, place and second moments, with standard errors and verdicts; and, to see that the comparison can tell, "
                                     "the same with a material that stays as it was. Leaves scenes, deformed.json, deformed.png and fragment.html for scripts/report. Exit 0: nothing fails and the wrong material "
                                     "does; 1: otherwise, or a step failed; 2: wrong usage.")
    parser.add_argument("--quick", action="store_true", help="small and few: to see that it works")
    parser.add_argument("--ndf", default="beckmann", help="law of the surface's slopes")
    parser.add_argument("--alpha", type=float, default=0.15)
    parser.add_argument("--gamma", type=float)
    parser.add_argument("--size", type=count(32), default=256, help="cells of a period")
    parser.add_argument("--periods", type=count(2), default=48, help="periods along the plate's edge")
    parser.add_argument("--correlation", type=float, default=4.0, help="correlation length in cells")
    parser.add_argument("--realisations", type=count(2), default=10, help="independent surfaces; their spread gives the standard errors")
    parser.add_argument("--width", type=count(16), default=96, help="pixels, and as many high")
    parser.add_argument("--fine", type=count(1), default=16, help="POV-Ray's rays along a pixel's side")
    parser.add_argument("--samples", type=count(1), default=256, help="musurf's samples in a pixel, in each of two renders")
    parser.add_argument("--deformation", action="append", choices=[name for name, _ in DEFORMATIONS], help="only this one; may be repeated")
    parser.add_argument("-o", metavar="DIR", dest="output", default=str(build / "geometry-tension"))
    options = parser.parse_args(arguments)
    if options.quick:
        options.size, options.realisations, options.width, options.fine, options.samples = 128, 4, 48, 12, 64
    options.command = " ".join(["scripts/geometry-tension", *arguments])
    result = attempt(run, options, build)
    if isinstance(result, int):
        return result
    for line in deformed_tables.summary(result):
        print(line)
    print(pathlib.Path(options.output) / "deformed.json")
    good = all(row["verdict"] != highlight.FAILS for plate in result["plates"] for row in plate["rows"])
    told = all(any(row["verdict"] == highlight.FAILS for row in plate["as_at_rest"]) for plate in result["plates"])
    return 0 if good and told else 1
