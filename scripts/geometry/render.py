# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Runs the three programs of the comparison; pictures are [row, column, RGB] arrays of linear radiance."""
import json
import os
import pathlib
import subprocess
import sys
import time

import numpy as np

from crosscheck import povray

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests"))
import exr  # noqa: E402

FINEST = 2  # hours after which POV-Ray is taken to hang


class RenderError(Exception):
    """A program failed; the message holds its own words."""


def call(*command, folder=None):
    """Runs it; returns (its standard output, seconds of processor time and wall time)."""
    start, before = time.monotonic(), os.times()
    done = subprocess.run([str(part) for part in command], cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          timeout=3600 * FINEST)
    after = os.times()
    if done.returncode:
        raise RenderError(f"{pathlib.Path(command[0]).name} {command[1]}: exit {done.returncode}: {povray.complaint(done.stderr)}")
    used = after.children_user + after.children_system - before.children_user - before.children_system
    return done.stdout, {"cpu_seconds": round(used, 2), "seconds": round(time.monotonic() - start, 2)}


def make_surface(musurf, law, size, correlation, seed, file):
    options = [part for key, value in law.items() for part in (f"--{key}", value)]
    return call(musurf, "surface", "make", *options, "--size", size, "--correlation", correlation, "--seed", seed, "-o", file)[1]


def fit(musurf, file):
    """The material that explains the surface best, and what the fit said of it."""
    found = json.loads(call(musurf, "surface", "fit", file)[0])
    return found["material"], found


def rise(files):
    """The largest range of heights, cells."""
    return max(float(np.ptp(next(iter(exr.read(file)[1].values())))) for file in files)


def write_mesh(musurf, file, m, mesh):
    call(musurf, "surface", "mesh", file, "--transform", ",".join(repr(float(x)) for x in np.ravel(m)), "--format", "pov", "-o", mesh)


def picture(file):
    _, channels = exr.read(file)
    return np.stack([channels[c].astype(float) for c in "RGB"], -1)


def render_geometry(text, folder, name, camera, fine):
    """Explicit facets by POV-Ray, fine x fine rays a pixel; (picture, what it took)."""
    (folder / f"{name}.pov").write_text(text)
    output = folder / f"{name}.exr"
    used = call(povray.find(), f"+I{name}.pov", f"+O{output.name}", "+FE", f"+W{camera.width * fine}", f"+H{camera.height * fine}",
                "-A", "-D", "-C", "-P", "-GD", "-GR", "-V", "File_Gamma=1", folder=folder)[1]
    image = picture(output)
    output.unlink()  # large; the mean over pixels is kept
    return image.reshape(camera.height, fine, camera.width, fine, 3).mean((1, 3)), used


def render_material(musurf, text, folder, name, samples, seed):
    scene, output = folder / f"{name}.json", folder / f"{name}.exr"
    scene.write_text(text)
    used = call(musurf, "render", scene, "-o", output, "--spp", samples, "--seed", seed, "--quiet")[1]
    return picture(output), used
