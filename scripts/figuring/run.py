# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Makes the meshes, renders the scenes of scenes/figures and puts the pictures together; see --help."""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import time

import numpy as np

from modelling import balloon, creatures, make

from . import page, pictures, triangle

SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes" / "figures"
ANIMALS = [("birds", "bird", 0.25, 2.2), ("dogs", "dog", 0.16, 1.4)]
TRIANGLES = [("bird", "bowed"), ("bird", "elongated"), ("dog", "twisted"), ("dog", "puffed")]


class FigureError(Exception):
    """A program failed; the message holds its own words."""


def call(*command):
    done = subprocess.run([str(part) for part in command], stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode:
        raise FigureError(f"musurf {command[1]}: {' '.join((done.stderr or done.stdout).strip().splitlines()[-1:])}")
    return done.stdout


class Maker:
    def __init__(self, options, build):
        self.musurf, self.folder, self.quick = build / "musurf", pathlib.Path(options.output), options.quick
        self.samples = options.spp or (2 if options.quick else None)
        self.told = {}

    def work(self, scene):
        """Options of a render: the scene's own work, or less."""
        width, height = (scene["film"][key] for key in ("width", "height"))
        size = ["--size", f"{width // 5}x{height // 5}"] if self.quick else []
        return [*size, *(["--spp", self.samples] if self.samples else []), "--quiet"]

    def render(self, name):
        """(the picture, the scene)"""
        scene, image = json.loads((SCENES / f"{name}.json").read_text()), self.folder / f"{name}.exr"
        call(self.musurf, "render", SCENES / f"{name}.json", "-o", image, *self.work(scene))
        return pictures.of_exr(image), scene

    def wedge(self, name, vary, *options):
        """Cells as EXR into the folder of this name."""
        cells = self.folder / name
        shutil.rmtree(cells, ignore_errors=True)
        cells.mkdir()
        scene = json.loads((SCENES / f"{name}.json").read_text())
        call(self.musurf, "wedge", SCENES / f"{name}.json", "--vary", vary, "--cells", cells, *options, *self.work(scene))
        return sorted(cells.glob("*.exr"))

    def figure6(self):
        rows = []
        for name, animal, alpha, gamma in ANIMALS:
            plain, scene = self.render(name)
            tense, _ = self.render(f"{name}-tension")
            rows += [(f"{name}, α = {alpha}, γ = {gamma}: isotropic", plain),
                     ("left isotropic, right with the deformation", pictures.pieces([plain, tense], centres(scene, plain), 0.42 * plain.height, plain.width)),
                     ("microsurface deformed with the body", tense)]
            self.told[name] = {pose: self.stretch(animal, pose) for pose in creatures.POSES[animal][1]}
        pictures.save(pictures.stacked(rows), self.folder / "figure6.png")

    def stretch(self, animal, pose):
        """The least and the largest factor by which a length is stretched, and an area."""
        summary = json.loads(call(self.musurf, "tension", make.FOLDER / f"{animal}-rest.ply", make.FOLDER / f"{animal}-{pose}.ply"))["summary"]
        return {key: summary[key] for key in ("stretch", "area")}

    def figure7(self):
        os.environ.setdefault("MPLBACKEND", "Agg")
        import matplotlib.pyplot as plt

        shown, worst = [], 0.0
        for animal, pose in TRIANGLES:
            shapes = creatures.posed(animal)
            rest, deformed = (single(shapes[key]) for key in ("rest", pose))
            said = json.loads(call(self.musurf, "tension", make.FOLDER / f"{animal}-rest.ply", make.FOLDER / f"{animal}-{pose}.ply", "--json"))["faces"]
            found = [triangle.Pair(rest, deformed, k, np.reshape(said[k], (2, 2))) for k in range(0, len(said), max(1, len(said) // 500))]
            worst = max(worst, *(pair.difference for pair in found))
            shown.append((f"{animal}, {pose}", triangle.clearest(found)))
        triangle.draw(plt, shown, self.folder / "figure7.png")
        self.told["figure7"] = {"faces": [{"of": title, "T": pair.t.tolist()} for title, pair in shown], "largest_difference": worst}

    def figure8(self):
        self.wedge("vase", "alpha=.01:.04:.16,gamma=1:3.5", "--columns", 3, "--png", self.folder / "figure8.png")

    def balloon(self):
        chosen = range(1, balloon.FRAMES + 1) if not self.quick else (1, balloon.FRAMES // 2, balloon.FRAMES)
        states = ":".join(f"../../build/meshes/balloon-{k:02d}.ply" for k in chosen)
        frames = [pictures.of_exr(frame) for frame in self.wedge("balloon", f"$.meshes.balloon.file={states}", "-o", self.folder / "balloon.exr")]
        pictures.save(pictures.sheet([(f"{k} of {balloon.FRAMES}", frame) for k, frame in zip(chosen, frames)], 6), self.folder / "balloon.png")
        pictures.animate(frames, self.folder / "balloon.gif")
        self.told["balloon"] = {"frames": len(frames)}


def single(shape):
    """Rounded as in the file: floats."""
    return shape.moved(lambda p: p.astype(np.float32).astype(float))


def centres(scene, picture):
    """Pixels of the animals' middles, half a unit above their places."""
    camera = scene["camera"]
    eye, aim = np.array(camera["position"], float), np.array(camera["target"], float)
    ahead = (aim - eye) / np.linalg.norm(aim - eye)
    right = np.cross(ahead, (0, 0, 1)) / np.linalg.norm(np.cross(ahead, (0, 0, 1)))
    scale = picture.height / 2 / np.tan(np.radians(camera["fov"]) / 2)
    found = []
    for item in scene["objects"]:
        if "mesh" in item:
            d = np.array(item["transform"][-1]["translate"], float) + (0, 0, 0.5) - eye
            found.append((picture.width / 2 + scale * (d @ right) / (d @ ahead), picture.height / 2 - scale * (d @ np.cross(right, ahead)) / (d @ ahead)))
    return found


FIGURES = ("figure6", "figure7", "figure8", "balloon")


def main(arguments, build):
    parser = argparse.ArgumentParser("scripts/figures", description="Makes the meshes of scenes/figures and renders Figures 6, 7 and 8 of Microsurface Transformations and "
                                     "a balloon of 24 frames: figure6.png, figure7.png, figure8.png, balloon.png (all frames), balloon.gif, every image as EXR, "
                                     "figures.json, and fragment.html for scripts/report. Exit 0; 1 if something failed; 2 on wrong usage; 130 if interrupted.")
    parser.add_argument("--quick", action="store_true", help="small and noisy, 3 frames: to see that it works")
    parser.add_argument("--only", action="append", choices=FIGURES, help="only this one; may be repeated")
    parser.add_argument("--spp", type=int, metavar="N", help="samples per pixel instead of the scenes' own")
    parser.add_argument("-o", metavar="DIR", dest="output", default=str(build / "figures"))
    options = parser.parse_args(arguments)
    if options.spp is not None and options.spp < 1:
        parser.error("--spp is at least 1")
    start = time.monotonic()
    try:
        maker = Maker(options, build)
        maker.folder.mkdir(parents=True, exist_ok=True)
        make.write()
        chosen = [name for name in FIGURES if not options.only or name in options.only]
        for number, name in enumerate(chosen, 1):
            print(f"figures: [{number}/{len(chosen)}] {name}; {time.monotonic() - start:.0f} s", file=sys.stderr, flush=True)
            getattr(maker, name)()
        told = {"command": " ".join(["scripts/figures", *arguments]), **maker.told, "seconds": round(time.monotonic() - start, 1)}
        for name, text in (("figures.json", json.dumps(told, indent=1)), ("fragment.html", page.fragment(told, maker.folder, chosen))):
            (maker.folder / f"{name}.new").write_text(text, encoding="utf-8")
            (maker.folder / f"{name}.new").replace(maker.folder / name)
    except (OSError, KeyError, ValueError, FigureError) as error:
        print(f"figures: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    print(maker.folder / "figures.json")
    return 0
