# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Writes the meshes, the direction map and the normal map that scenes/figures and scenes/ibl show; see --help."""
import argparse
import pathlib
import sys

from . import balloon, creatures, hammered, mesh, teapot, vase, wave

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "build" / "meshes"  # where the scene files look for them


def meshes(fine=1.0):
    """(file name, mesh) of all of them."""
    for name in creatures.POSES:
        for pose, shape in creatures.posed(name, fine).items():
            yield f"{name}-{pose}.ply", shape
    for k, shape in enumerate(balloon.frames(fine), 1):
        yield f"balloon-{k:02d}.ply", shape
    yield "vase.ply", vase.vase(fine)
    yield "teapot.ply", teapot.teapot(fine)


def write(folder=FOLDER, fine=1.0):
    """The files, in the order made."""
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    for name, shape in meshes(fine):
        files.append(folder / name)
        mesh.write(shape, files[-1])
    for name, picture in ("wave.png", wave.picture()), ("hammered.png", hammered.picture()):
        files.append(folder / name)
        wave.write(files[-1], picture)
    return files


def main(arguments):
    parser = argparse.ArgumentParser("scripts/meshes", description="Makes the meshes of scenes/figures and scenes/ibl by formulas: rubber animals in poses, a "
                                     "balloon in 24 states, a vase, a teapot; PLY with texture coordinates, the same bytes every time; and a direction map, wave.png, and a normal map, hammered.png. Prints their names. Exit 0; 2 on wrong usage.")
    parser.add_argument("-o", metavar="DIR", dest="output", type=pathlib.Path, default=FOLDER, help="default: build/meshes, where the scenes look")
    parser.add_argument("--fine", type=float, default=1.0, help="points along each direction, of the usual number (default: 1)")
    options = parser.parse_args(arguments)
    if not 0.1 <= options.fine <= 10:
        parser.error("--fine is from 0.1 to 10")
    try:
        for file in write(options.output, options.fine):
            print(file)
    except OSError as error:
        print(f"meshes: {error}", file=sys.stderr)
        return 1
    return 0
