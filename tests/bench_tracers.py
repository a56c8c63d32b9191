#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Rays per second and core of the exact caster of surfaces against POV-Ray's, on the same triangles and points in one run.

    tests/bench_tracers.py [--size 1024] [--repeats 3]

A surface as of `musurf surface make` (Beckmann, alpha 0.3), three directions (60, 75, 85 degrees), 9 points per triangle.
POV-Ray renders the scene that `--tracer povray` gives it, on one thread, and says itself how many camera and
shadow rays it traced in how many processor seconds. musurf's rays are the points of facets that face a view; its seconds
are the difference of whole runs, on one thread, with and without more points per facet, so that reading cancels. Runs are
taken in turn; medians. Exit code 1 unless the caster is GOAL times as fast and sees a whole view in VIEW seconds.
"""
import argparse
import json
import os
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile

GOAL, VIEW = 3, 2.0
MUSURF = str(pathlib.Path(os.environ.get("BUILD", "build")).resolve() / "musurf")
VIEWS = ["--view=0.8138,0.2962,0.5", "--view=-0.7399,0.6209,0.2588", "--view=-0.1730,-0.9811,0.0872"]
FEW, MANY = 9, 25  # points per facet
WRAPPER = """#!/bin/sh
[ "$1" = --version ] && exec povray --version
povray "$@" >stdout 2>stderr
code=$?
cat stderr >> "{log}"
exit $code
"""


def run(*arguments, **env):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run([MUSURF, "surface", *arguments], capture_output=True, text=True, env={**os.environ, **env})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        sys.exit(f"bench_tracers: {done.stderr}")
    return json.loads(done.stdout), after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def caster(file):
    """Rays and processor seconds of the points that the longer run has more."""
    few, many = (run("measure", file, *VIEWS, "--threads=1", f"--subsamples={k}") for k in (FEW, MANY))
    rays = sum(view["front_facing"] for view in few[0]["views"]) * (MANY - FEW)
    return rays, many[1] - few[1]


def povray(file, folder):
    log = folder / "log"
    log.unlink(missing_ok=True)
    program = folder / "povray"
    program.write_text(WRAPPER.format(log=log))
    program.chmod(0o755)
    run("measure", file, *VIEWS, "--threads=1", f"--subsamples={FEW}", "--tracer=povray", POVRAY=str(program))
    text = log.read_text()
    number = lambda pattern: float(re.search(pattern, text).group(1))
    rays = number(r"\nRays:\s+(\d+)") + number(r"Shadow Ray Tests:\s+(\d+)")
    return rays, number(r"Trace Time:[^\n]*\n[^\n]*with ([\d.]+) CPU-seconds")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", type=int, default=1024)
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    runs = {"own": [], "povray": []}
    with tempfile.TemporaryDirectory(prefix="musurf-tracers-") as name:
        folder = pathlib.Path(name)
        file = str(folder / "h.exr")
        run("make", "--ndf=beckmann", "--alpha=0.3", f"--size={options.size}", "--passes=10", "-o", file)
        for _ in range(options.repeats):
            runs["own"].append(caster(file))
            runs["povray"].append(povray(file, folder))
    rate = {who: statistics.median(rays / seconds for rays, seconds in rows) for who, rows in runs.items()}
    one = statistics.median(seconds for _, seconds in runs["own"]) / (MANY - FEW) / len(VIEWS)
    print(f"surface of {options.size}^2 cells, {FEW} points per facet, three directions, one thread, medians of "
          f"{options.repeats}, processor seconds:")
    for who in runs:
        print(f"  {who}: {rate[who] / 1e6:.2f} Mray/s")
    print(f"  ratio {rate['own'] / rate['povray']:.2f} (goal {GOAL}); one point per facet from one direction: {one:.3f} s "
          f"(goal: below {VIEW:g} s)")
    return 0 if rate["own"] >= GOAL * rate["povray"] and one < VIEW else 1


if __name__ == "__main__":
    sys.exit(main())
