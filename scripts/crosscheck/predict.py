# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What the core says: JSON lines through the commands `musurf eval` and `musurf sample`, in double precision.

Answers are kept in the store under the bytes of the program and of the material plugin, so another core is asked anew.
"""
import json
import os
import pathlib
import subprocess

import numpy as np

from . import store


class PredictionError(Exception):
    """The command is missing, refused a line, or answered something that is no number."""


class Core:
    """The command `musurf` of a build folder; plugin_path, if given, is where it looks for material plugins first."""

    def __init__(self, program, where, plugin_path=None):
        self.program, self.store = pathlib.Path(program), where
        self.environment = dict(os.environ, **({"MUSURF_PLUGIN_PATH": str(plugin_path)} if plugin_path else {}))
        if not os.access(self.program, os.X_OK):
            raise PredictionError(f"{self.program} is not built; run make")
        self.version = store.of_files(self.program)
        said = subprocess.run([str(self.program), "info", "--json"], env=self.environment, capture_output=True, text=True)
        if said.returncode:
            raise PredictionError(f"musurf info ended with {said.returncode}: {said.stderr.strip()}")
        self.plugin = store.of_files(json.loads(said.stdout)["plugin"]["file"])

    def run(self, arguments, text):
        done = subprocess.run([str(self.program), *arguments], input=text, env=self.environment, capture_output=True, text=True)
        answers = [json.loads(line) for line in done.stdout.splitlines()]
        wrong = next((a["error"] for a in answers if "error" in a), None)
        if done.returncode or wrong:
            raise PredictionError(f"musurf {arguments[0]} ended with {done.returncode}: "
                                  f"{wrong or done.stderr.strip() or 'no message'}")
        return answers

    def ask(self, material, wanted, wo, wm=None, wi=None):
        """{name: values} for the names wanted, one per direction: arrays [..., 3] that broadcast; colours by their first."""
        given = {k: np.asarray(w, float) for k, w in (("wo", wo), ("wm", wm), ("wi", wi)) if w is not None}
        shape = np.broadcast_shapes(*(w.shape for w in given.values()))
        given = {k: np.broadcast_to(w, shape).reshape(-1, 3) for k, w in given.items()}
        key = store.digest(self.version, self.plugin, material, wanted, given)

        def make():
            head = json.dumps({"material": material})[:-1]
            lines = [head + "".join(f', "{k}": [{w[i, 0]!r}, {w[i, 1]!r}, {w[i, 2]!r}]' for k, w in plain.items()) + "}"
                     for i in range(len(next(iter(plain.values()))))]
            answers = self.run(["eval", "--precision", "double"], "\n".join(lines) + "\n")
            if len(answers) != len(lines):
                raise PredictionError(f"musurf eval gave {len(answers)} answers to {len(lines)} lines")
            return {name: column(answers, name) for name in wanted}

        plain = {k: w.tolist() for k, w in given.items()}
        plain = {k: np.array(w, dtype=object) for k, w in plain.items()}
        return {k: v.reshape(shape[:-1]) for k, v in self.store.get("core", key, make).items()}

    def walk(self, material, wo, count, seed):
        """(albedo, its standard error) from the weights of `count` samples."""
        key = store.digest(self.version, self.plugin, material, np.asarray(wo), count, seed)

        def make():
            line = json.dumps({"material": material, "wo": [float(x) for x in wo]})
            answers = self.run(["sample", "--n", str(count), "--seed", str(seed)], line + "\n")
            weights = np.array([np.ravel(a["weight"])[0] for a in answers], float)
            return {"mean": weights.mean(), "error": weights.std(ddof=1) / np.sqrt(len(weights))}

        said = self.store.get("walk", key, make)
        return float(said["mean"]), float(said["error"])


def column(answers, name):
    values = np.array([np.nan if a.get(name) is None else np.ravel(a[name])[0] for a in answers], float)
    if not np.isfinite(values).all():
        raise PredictionError(f'musurf eval gave no finite "{name}" for line {int(np.argmin(np.isfinite(values)))}')
    return values
