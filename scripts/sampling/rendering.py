# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Scenes of the torus knot, rendered by `musurf render`: the picture, and the processor time that it took."""
import json
import os
import pathlib
import subprocess
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests"))
import exr  # noqa: E402

LUMINANCE = (0.2126, 0.7152, 0.0722)


class RenderError(Exception):
    pass


def scene(mesh, size, material, light_sampling=True, candidates=4):
    """The knot, lit by one rectangle from above and aside, seen from above the front. Two bounces: what one limb reflects of
    another is part of the noise."""
    return {
        "musurf": 1,
        "camera": {"position": [0.3, -3.4, 4.4], "target": [0, 0, 0], "fov": 33},
        "film": {"width": size[0], "height": size[1], "filter": "box", "pixels": "float"},
        "integrator": {"depth": 2, "roulette": 2, "light_sampling": light_sampling, "light_candidates": candidates},
        "meshes": {"knot": {"file": str(mesh)}},
        "materials": {"knot": material},
        "objects": [{"mesh": "knot", "material": "knot"}],
        # its +z, toward which it shines, points down at the knot
        "lights": [{"type": "rectangle", "size": [3, 2], "radiance": 4,
                    "transform": [{"rotate": [1, 0, 0, 180]}, {"rotate": [0, 1, 0, 15]}, {"translate": [0.9, 0.6, 3.2]}]}],
    }


def material(gamma, s, sampler, alpha=0.3):
    """sampler None: the renderer's own choice."""
    out = {"material": "musurf.microfacet", "ndf": "gtr", "alpha": alpha, "gamma": gamma, "stretch": s}
    return {**out, "sampler": sampler} if sampler else out


def chosen(musurf, description, folder):
    """The sampler that the renderer chooses for the only material."""
    file = folder / "scene.json"
    file.write_text(json.dumps(description))
    done = subprocess.run([str(musurf), "render", str(file), "--explain"], capture_output=True, text=True, check=True)
    return json.loads(done.stdout)["materials"][0]["sampler"].split(":")[0]


def render(musurf, description, folder, spp, seed, threads=None):
    """(luminance of each pixel, whether the knot is all there is in it, seconds of processor time, the command)."""
    file, image = folder / "scene.json", folder / "picture.exr"
    file.write_text(json.dumps(description))
    command = [str(musurf), "render", str(file), "-o", str(image), "--spp", str(spp), "--seed", str(seed), "--quiet"]
    command += ["--threads", str(threads)] if threads else []
    child = subprocess.Popen(command, stdin=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        raise RenderError(f"{' '.join(command)}: exit {child.returncode}")
    _, channels = exr.read(image)
    picture = sum(w * channels[c].astype(float) for w, c in zip(LUMINANCE, "RGB"))
    return picture, channels["A"] == 1, usage.ru_utime + usage.ru_stime, command


def reference(musurf, mesh, size, gamma, s, spp, folder):
    """Mean of two renders, and each pixel's estimate of the variance that the mean still has, from their difference."""
    description = scene(mesh, size, material(gamma, s, "visible"))
    first, inside, _, _ = render(musurf, description, folder, spp, 900001)
    second, _, _, _ = render(musurf, description, folder, spp, 900002)
    return (first + second) / 2, (first - second) ** 2 / 4, inside


def preview(musurf, mesh, size, gamma, s, folder, spp=256):
    picture, _, _, _ = render(musurf, scene(mesh, size, material(gamma, s, "visible")), folder, spp, 1)
    return np.clip(picture, 0, None)
