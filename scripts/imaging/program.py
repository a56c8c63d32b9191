# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Pictures of scenes: by paths, kept under the hash of all that they depend on, and by techniques, with what they cost."""
import hashlib
import json
import pathlib
import subprocess
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests"))
import exr  # noqa: E402


class ProgramError(Exception):
    """A program failed; the message holds its own words."""


def call(*command, env=None):
    done = subprocess.run([str(part) for part in command], stdin=subprocess.DEVNULL, capture_output=True, text=True, env=env)
    if done.returncode:
        raise ProgramError(f"{pathlib.Path(command[0]).name}: {' '.join((done.stderr or done.stdout).strip().splitlines()[-1:])}")
    return done.stdout


def picture(file):
    """(linear RGB [h, w, 3], where every ray hit [h, w])"""
    channels = exr.read(file)[1]
    return np.stack([channels[c].astype(float) for c in "RGB"], -1), channels["A"] == 1


def files_of(value):
    """Names of files in a scene."""
    if isinstance(value, (dict, list)):
        for inner in value.values() if isinstance(value, dict) else value:
            yield from files_of(inner)
    elif isinstance(value, str) and value.startswith("/"):
        yield value


class Truth:
    """Halves with seeds of their own; a half that was made is not made again. Beside OUT.exr stands OUT.json, what it is of."""

    def __init__(self, musurf, folder, samples):
        self.musurf, self.folder, self.samples, self.digests, self.made = musurf, folder, samples, {}, 0
        folder.mkdir(parents=True, exist_ok=True)
        self.version = json.loads(call(musurf, "info", "--json"))["build"]["version"]

    def digest(self, file):
        if file not in self.digests:
            self.digests[file] = hashlib.sha256(pathlib.Path(file).read_bytes()).hexdigest()
        return self.digests[file]

    def half(self, scene, seed):
        """A path of one event: no light comes from other parts of the object."""
        scene = {**scene, "integrator": {"samples": self.samples, "depth": 1, "roulette": 100, "seed": seed}}
        said = {"musurf": self.version, "scene": scene, "files": {file: self.digest(file) for file in files_of(scene)}}
        text = json.dumps(said, sort_keys=True, indent=1)
        out = self.folder / f"{hashlib.sha256(text.encode()).hexdigest()[:24]}.exr"
        if not out.exists():
            file = out.with_suffix(".scene.json")
            file.write_text(json.dumps(scene))
            fresh = out.with_name(f"{out.stem}.new.exr")
            call(self.musurf, "render", file, "-o", fresh, "--quiet")
            file.unlink()
            out.with_suffix(".json").write_text(text)
            fresh.replace(out)
            self.made += 1
        return picture(out)

    def halves(self, scene):
        """([a, b], where every ray of both hit)"""
        (a, inside), (b, also) = (self.half(scene, seed) for seed in (1, 2))
        return [a, b], inside & also


def by_techniques(bench, scenes, effort, folder, env=None):
    """[{"ns", "shading_ns", "rays_ns", "reads", "rounds", "picture", "inside"}], a frame for each scene; they differ in integrator and lights."""
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    for k, scene in enumerate(scenes):
        files.append(folder / f"{k:03d}.json")
        files[-1].write_text(json.dumps(scene))
    said = call(bench, "--json", "--images", "--rounds", effort.rounds, "--samples", effort.samples, *files, env=env)
    found = []
    for line, file in zip(said.splitlines(), files, strict=True):
        image = file.with_name(f"{file.name}.exr")
        rgb, inside = picture(image)
        found.append({**json.loads(line), "picture": rgb, "inside": inside})
        image.unlink()
        file.unlink()
    return found
