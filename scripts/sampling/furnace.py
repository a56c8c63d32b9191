# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Variance of one sample in a white furnace, by the benchmark of the C samplers (build/tests/bench_samplers --json)."""
import json
import math
import subprocess

ORDER = ("ndf", "mixed", "visible", "visible_uniform", "bounded", "folded")


def run(build):
    """{(group, alpha, gamma, transform, theta): {sampler: row}}"""
    done = subprocess.run([str(build / "tests" / "bench_samplers"), "--json"], text=True, capture_output=True, check=True)
    found = {}
    for line in done.stdout.splitlines():
        row = json.loads(line)
        key = (row["group"], row["alpha"], row["gamma"], tuple(map(tuple, row["transform"])), row["theta"])
        found.setdefault(key, {})[row["sampler"]] = row
    return found


def stretch(transform):
    """s of Eq. (31) for a map that is one, else None."""
    (a, b), (c, d) = transform
    return round(1 - d, 9) if b == c == 0 and d > 0 and abs(a * d - 1) < 1e-6 else None


def table(found):
    """The rows of GTR at alpha 0.3, as dictionaries: gamma, s, theta, and each sampler's variance."""
    return [{"gamma": key[2], "s": stretch(key[3]), "theta": key[4], **{name: row["variance"] for name, row in rows.items()}}
            for key, rows in found.items() if key[0] == "gtr"]


def bounded(found):
    """Of GGX: for each alpha and map the geometric means over the views of bounded over visible, and the worst."""
    groups = {}
    for (group, alpha, _, transform, _), rows in found.items():
        if group != "ggx":
            continue
        ratio = rows["bounded"]["variance"] / rows["visible"]["variance"]
        groups.setdefault((alpha, transform), []).append((ratio, ratio * rows["bounded"]["ns"] / rows["visible"]["ns"]))
    mean = lambda values: math.exp(sum(map(math.log, values)) / len(values))  # noqa: E731
    return [{"alpha": alpha, "transform": transform, "samples": mean([r[0] for r in v]), "worst": max(r[0] for r in v),
             "time": mean([r[1] for r in v])} for (alpha, transform), v in groups.items()]


def equal_time(found):
    """[(group, gamma, sampler, variance, variance times ns)], geometric means over views and maps, over those of mixed."""
    sums = {}
    for (group, _, gamma, _, _), rows in found.items():
        for name, row in rows.items():
            ratio = row["variance"] / rows["mixed"]["variance"]
            sums.setdefault((group, gamma, name), []).append((math.log(ratio), math.log(ratio * row["ns"] / rows["mixed"]["ns"]), row["ns"]))
    return [{"group": g, "gamma": c, "sampler": n, "variance": math.exp(sum(x[0] for x in v) / len(v)),
             "time": math.exp(sum(x[1] for x in v) / len(v)), "ns": sorted(x[2] for x in v)[len(v) // 2]} for (g, c, n), v in sums.items()]
