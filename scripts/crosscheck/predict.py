# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What the core says: JSON lines through the command `musurf eval`, in double precision."""
import json
import os
import pathlib
import subprocess

import numpy as np


class PredictionError(Exception):
    """The command is missing, refused a line, or answered something that is no number."""


class Core:
    """The command `musurf` of a build folder; plugin_path, if given, is where it looks for material plugins first."""

    def __init__(self, program, plugin_path=None):
        self.program = pathlib.Path(program)
        self.environment = dict(os.environ, **({"MUSURF_PLUGIN_PATH": str(plugin_path)} if plugin_path else {}))
        if not os.access(self.program, os.X_OK):
            raise PredictionError(f"{self.program} is not built; run make")

    def evaluate(self, alpha, m, records):
        """Answers, in order, to records of wo and optional wm and wi, for the Beckmann surface of alpha under M."""
        material = {"material": "musurf.microfacet", "ndf": "beckmann", "alpha": alpha, "transform": m.tolist()}
        lines = [json.dumps({"id": k, "material": material, **{key: list(map(float, w)) for key, w in r.items()}})
                 for k, r in enumerate(records)]
        done = subprocess.run([str(self.program), "eval", "--precision", "double"], input="\n".join(lines) + "\n",
                              env=self.environment, capture_output=True, text=True)
        answers = [json.loads(line) for line in done.stdout.splitlines()]
        if done.returncode or len(answers) != len(records):
            wrong = next((a["error"] for a in answers if "error" in a), done.stderr.strip() or "no message")
            raise PredictionError(f"musurf eval ended with {done.returncode}, "
                                  f"{len(answers)} answers to {len(records)} lines: {wrong}")
        return answers

    def column(self, answers, name):
        values = np.array([a[name] if a.get(name) is not None else np.nan for a in answers], float)
        if not np.isfinite(values).all():
            raise PredictionError(f'musurf eval gave no finite "{name}" for line {int(np.argmin(np.isfinite(values)))}')
        return values

    def masking(self, alpha, m, directions):
        """G1 and sigma towards each direction; Smith's G1 is one for all normals that face it."""
        answers = self.evaluate(alpha, m, [{"wo": v, "wm": (0, 0, 1)} for v in directions])
        return self.column(answers, "G1"), self.column(answers, "sigma")

    def joint(self, alpha, m, a, b):
        """G2 of a as viewer and b as light, as asked for and as it stands in the BRDF, f = F D G2 / (4 cos cos).

        Where D underflows f tells nothing, and both are the former.
        """
        half = (np.asarray(a) + b) / np.linalg.norm(np.asarray(a) + b)
        answers = self.evaluate(alpha, m, [{"wo": a, "wi": b, "wm": half}])
        g2, d = (float(self.column(answers, name)[0]) for name in ("G2", "D"))
        if not d > 1e-280:
            return g2, g2
        fresnel, f = (float(answers[0][name][0]) for name in ("F", "f"))
        return g2, 4 * f * a[2] * b[2] / (d * fresnel)

    def distribution(self, alpha, m, normals):
        """D at normals [..., 3], 1/sr."""
        flat = normals.reshape(-1, 3)
        answers = self.evaluate(alpha, m, [{"wo": (0, 0, 1), "wm": n} for n in flat])
        return self.column(answers, "D").reshape(normals.shape[:-1])
