# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Figure 9 measured: G1 of GTR by the spline of Appendix A against the exact one, both as `musurf eval` says them."""
import json
import subprocess

import numpy as np

ALPHAS = (0.01, 0.03, 0.1, 0.3)
GAMMAS = np.linspace(0, 4, 81)
ANGLES = np.concatenate([np.arange(0, 80, 4.0), np.arange(80, 89.6, 0.5), [89.9, 89.99]])  # degrees


def ask(musurf, smith):
    """G1[alpha, gamma, angle]."""
    lines = []
    for alpha in ALPHAS:
        for gamma in GAMMAS:
            material = {"material": "musurf.microfacet", "ndf": "gtr", "alpha": alpha, "gamma": float(gamma), "smith": smith}
            for theta in np.radians(ANGLES):
                lines.append(json.dumps({"material": material, "wo": [np.sin(theta), 0, np.cos(theta)], "wm": [0, 0, 1]}))
    done = subprocess.run([str(musurf), "eval"], input="\n".join(lines) + "\n", text=True, capture_output=True, check=True)
    return np.array([json.loads(line)["G1"] for line in done.stdout.splitlines()]).reshape(len(ALPHAS), len(GAMMAS), len(ANGLES))


def run(musurf):
    exact, spline = ask(musurf, "exact"), ask(musurf, "spline")
    rows = []
    for k, alpha in enumerate(ALPHAS):
        away = np.abs(spline[k] - exact[k])
        g, a = np.unravel_index(away.argmax(), away.shape)
        share = away[:, a] / np.maximum(exact[k, :, a], 1e-300)
        rows.append({"alpha": alpha, "largest": float(away[g, a]), "gamma": float(GAMMAS[g]), "theta": float(ANGLES[a]),
                     "exact": float(exact[k, g, a]), "spline": float(spline[k, g, a]), "relative": float(share[g]),
                     "at_1": float((spline[k] >= 1)[:, ANGLES > 0].mean()), "mean": float(away.mean()),
                     "at_integers": float(away[::20].max())})
    return exact, spline, rows
