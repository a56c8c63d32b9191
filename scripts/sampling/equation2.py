# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Eq. (2), which defines masking: the integral of D(m) G1(v) max(0, v.m) over the micronormals is cos theta_v. How far the
spline of Appendix A and the exact masking are from that, with D and G1 as `musurf eval` says them.

GTR is isotropic, so the azimuth integrates in closed form, and D is asked for once per material, at Gauss's nodes: panels in
t = asinh(tan theta_m / alpha), broken where a view's horizon meets the micronormals (theta_m = 90 degrees - theta_v).
"""
import json
import subprocess

import numpy as np

from . import masking

GAMMAS = np.linspace(0, 4, 17)
ANGLES = np.array([0, 30, 60, 75, 85, 88, 89.5])  # degrees
NODES, WIDEST, FARTHEST = 12, 0.5, 1e9  # of each panel; in t; tan theta_m, beyond which 1e-9 of the hemisphere lies


def nodes(alpha):
    """theta_m and the weights of d theta_m, alike for every gamma."""
    breaks = np.unique(np.arcsinh(np.r_[0, 1 / np.tan(np.radians(ANGLES[1:])), FARTHEST] / alpha))
    edges = np.concatenate([np.linspace(a, b, int(np.ceil((b - a) / WIDEST)) + 1)[:-1] for a, b in zip(breaks, breaks[1:])] + [breaks[-1:]])
    x, w = np.polynomial.legendre.leggauss(NODES)
    half = np.diff(edges) / 2
    t = (edges[:-1] + half)[:, None] + half[:, None] * x
    slope = alpha * np.sinh(t)
    return np.arctan(slope).ravel(), (half[:, None] * w * alpha * np.cosh(t) / (1 + slope**2)).ravel()


def facing(theta_v, theta_m):
    """max(0, v.m) integrated over the azimuth of m."""
    level, across = np.cos(theta_v) * np.cos(theta_m), np.sin(theta_v) * np.sin(theta_m)
    edge = np.arccos(np.clip(-level / np.maximum(across, 1e-300), -1, 1))
    return 2 * (level * edge + across * np.sin(edge))


def eval_all(musurf, questions, key):
    done = subprocess.run([str(musurf), "eval"], input="".join(json.dumps(q) + "\n" for q in questions), text=True, capture_output=True,
                          check=True)
    return np.array([json.loads(line)[key] for line in done.stdout.splitlines()])


def direction(theta):
    return [float(np.sin(theta)), 0, float(np.cos(theta))]


def material(alpha, gamma, smith):
    return {"material": "musurf.microfacet", "ndf": "gtr", "alpha": alpha, "gamma": float(gamma), "smith": smith}


def run(musurf):
    """({smith: error[alpha, gamma, angle] of Eq. (2) relative to cos theta_v}, the worst of each alpha and smith)."""
    away, views = {"exact": [], "spline": []}, np.radians(ANGLES)
    for alpha in masking.ALPHAS:
        theta, weight = nodes(alpha)
        questions = [{"material": material(alpha, g, "exact"), "wo": [0, 0, 1], "wm": direction(m)} for g in GAMMAS for m in theta]
        D = eval_all(musurf, questions, "D").reshape(len(GAMMAS), -1)
        seen = np.array([D @ (weight * np.sin(theta) * facing(v, theta)) for v in views]).T  # [gamma, angle]
        for smith, rows in away.items():
            G1 = eval_all(musurf, [{"material": material(alpha, g, smith), "wo": direction(v), "wm": [0, 0, 1]} for g in GAMMAS for v in views],
                          "G1").reshape(len(GAMMAS), -1)
            rows.append(G1 * seen / np.cos(views) - 1)
    away = {smith: np.array(rows) for smith, rows in away.items()}
    worst = []
    for k, alpha in enumerate(masking.ALPHAS):
        for smith, errors in away.items():
            g, a = np.unravel_index(np.abs(errors[k]).argmax(), errors[k].shape)
            worst.append({"alpha": alpha, "smith": smith, "largest": float(abs(errors[k, g, a])), "gamma": float(GAMMAS[g]),
                          "theta": float(ANGLES[a]), "mean": float(np.abs(errors[k]).mean())})
    return away, worst
