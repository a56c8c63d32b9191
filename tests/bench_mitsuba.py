#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What a sample costs in Mitsuba with our plugin, over Mitsuba's own roughconductor in the same evaluated mode; and in its fused mode, where
loops are recorded and no plugin can be called, which is what evaluated mode itself costs.

One scene of nothing but such surfaces, every path shaded five times; renders are taken in turn, medians of wall and processor time. Judged by
processor time, which other programs disturb less. Exit code 1 unless ours takes at most GOAL times as long as Mitsuba's; 0 where Mitsuba is not
installed.
"""
import statistics
import sys
import time

import mitsuba_host

if not mitsuba_host.PYTHON.exists():
    print("bench_mitsuba: left out: Mitsuba is not installed (make mitsuba)")
    sys.exit(0)
mi, musurf_mitsuba = mitsuba_host.enter()
import contextlib  # noqa: E402
import gc  # noqa: E402

import numpy as np  # noqa: E402

GOAL, SIZE, SAMPLES, REPEATS = 2, 256, 16, 5
mitsuba_host.listen(mi)
SAME = {"type": "musurf", "ndf": "ggx", "alpha_x": 0.15, "alpha_y": 0.45, "masking": "separable", "fresnel": "conductor", "fresnel_conductor": "Au"}
OWN = {"type": "roughconductor", "distribution": "ggx", "alpha_u": 0.15, "alpha_v": 0.45, "material": "Au"}
ROWS = {"Mitsuba's roughconductor, evaluated": (OWN, True), "ours, the same surface": (SAME, True),
        "ours, GTR 1.5 under a skew": ({"type": "musurf", "ndf": "gtr", "alpha": 0.3, "gamma": 1.5, "transform": "1 2 0 1"}, True),
        "Mitsuba's roughconductor, fused": (OWN, False)}


def scene(bsdf):
    look = mi.ScalarTransform4f().look_at
    return mi.load_dict({
        "type": "scene", "integrator": {"type": "path", "max_depth": 6, "rr_depth": 99},
        "sensor": {"type": "perspective", "fov": 40, "to_world": look([0, -3, 1.5], [0, 0, 0.5], [0, 0, 1]),
                   "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}}},
        "box": {"type": "cube", "flip_normals": True, "to_world": mi.ScalarTransform4f().scale(4), "bsdf": bsdf},
        "ball": {"type": "sphere", "radius": 0.7, "center": [0, 0, 0.5], "bsdf": bsdf},
        "lamp": {"type": "rectangle", "to_world": look([2, -1, 3], [0, 0, 0], [0, 0, 1]), "emitter": {"type": "area", "radiance": 9.0}}})


def once(bsdf, evaluated, seed):
    """The scene is alive for the while only: recorded calls go through every BSDF that is, and ours cannot be recorded."""
    gc.collect()
    built = scene(bsdf)
    wall, processor = time.perf_counter(), time.process_time()
    with musurf_mitsuba.evaluated() if evaluated else contextlib.nullcontext():
        assert np.isfinite(np.array(mi.render(built, spp=SAMPLES, seed=seed))).all()
    return time.perf_counter() - wall, time.process_time() - processor


def main():
    for some in ROWS.values():
        once(*some, 0)  # kernels are compiled now
    taken = {name: [] for name in ROWS}
    for i in range(REPEATS):
        for name, some in ROWS.items():
            taken[name].append(once(*some, i + 1))
    count = SIZE * SIZE * SAMPLES
    median = {name: [statistics.median(column) / count * 1e9 for column in zip(*rows)] for name, rows in taken.items()}
    base = next(iter(median.values()))
    print(f"{'Mitsuba ' + mi.__version__ + ', a sample of 5 bounces':40} {'ns':>7} {'ratio':>6} {'cpu ns':>7} {'ratio':>6}  goal: at most")
    for i, (name, (wall, processor)) in enumerate(median.items()):
        print(f"{name:40} {wall:7.0f} {wall / base[0]:6.2f} {processor:7.0f} {processor / base[1]:6.2f}" + (f"  {GOAL}" if i == 1 else ""))
    return 1 if median["ours, the same surface"][1] > GOAL * base[1] else 0


if __name__ == "__main__":
    sys.exit(main())
