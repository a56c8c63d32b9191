# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The measured quantity: G1 of a Beckmann surface by slope along the view, three views, as `musurf surface measure` counts it.

Every program runs on one thread, so that times of programs that share work differently compare. G1 is an array [view, bin]; bins
that no facet of a surface lies in are NaN. Its error is the root of the mean square of (G1 / reference - 1) over views and bins.
"""
import json
import re

import numpy as np

from . import process

ALPHA = 0.5
ANGLES = [(60, 20), (75, 140), (85, 260)]  # theta and azimuth of the views, degrees
EDGES = [-1.0, -0.5, -0.25, 0.0, 0.25]  # of the bins; slopes of the surface towards the view
TRACERS = ("own", "embree", "povray")


def view(theta, phi):
    t, p = np.radians(theta), np.radians(phi)
    return np.array([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)])


VIEWS = [view(*angles) for angles in ANGLES]


def listed(values):
    return ",".join(repr(float(x)) for x in values)


class Laboratory:
    """Makes surfaces and measures them; every call also tells what it took."""

    def __init__(self, musurf, folder):
        self.musurf, self.folder, self.made = musurf, folder, {}

    def tracers(self):
        """Those that this build offers and this machine can run."""
        offered = re.search(r"--tracer (\S+)", process.call(self.musurf, "surface", "measure", "--help")[0])[1].split("|")
        found = []
        file = self.make(64, 0)[0]
        for tracer in TRACERS:
            if tracer in offered:
                try:
                    self.measure(file, tracer)
                    found.append(tracer)
                except process.ProgramError:
                    if tracer == "own":
                        raise
        return found

    def make(self, size, seed):
        """(file, cost); the same surface is made once."""
        if (size, seed) not in self.made:
            file = self.folder / f"{size}-{seed}.exr"
            cost = process.call(self.musurf, "surface", "make", "--ndf", "beckmann", "--alpha", ALPHA, "--size", size, "--seed", seed, "-o", file)[1]
            self.made[size, seed] = file, cost
        return self.made[size, seed]

    def forget(self, size, seed):
        self.made.pop((size, seed))[0].unlink()

    def measure(self, file, tracer="own", points=9, transform=(1, 0, 0, 1), bits=None):
        """(G1 [view, bin], cost, version of the tracer)"""
        m = np.reshape(transform, (2, 2))
        views = [part for v in VIEWS for part in ("--view", listed([*(m @ v[:2]), v[2]]))]
        found, cost = process.call(self.musurf, "surface", "measure", file, *views, "--bins=" + listed(EDGES), "--tracer", tracer, "--subsamples", points,
                                   "--transform", listed(m.ravel()), "--threads", 1, *(["--bits", bits] if bits else []))
        found = json.loads(found)
        g1 = [[np.nan if b["G1"] is None else b["G1"] for b in v["bins"]] for v in found["views"]]
        return np.array(g1, float), cost, found.get("tracer", "exact, double precision")

    def albedo(self, file):
        """(share of light that mirrors let out after one reflection [view], cost)"""
        views = [part for v in VIEWS for part in ("--view", listed(v))]
        found, cost = process.call(self.musurf, "surface", "statistics", file, *views, "--bounces", 1, "--rings", 1, "--sectors", 1, "--slopes", 1, "--threads", 1)
        return np.array([v["reflection"][0]["orders"][0]["albedo"] for v in json.loads(found)["views"]]), cost


def squares(values, reference):
    """Mean squares of relative deviations of several runs [run, view, ...], one a run."""
    off = np.asarray(values) / reference - 1
    return np.nanmean(off.reshape(len(off), -1) ** 2, axis=1)


def root(found, excess=0.0):
    """(root of the mean of squares less what is known not to be theirs, its standard error from the runs' scatter or None)"""
    value = float(np.sqrt(max(found.mean() - excess, 0.0)))
    error = float(found.std(ddof=1) / np.sqrt(len(found)) / (2 * value)) if len(found) > 1 and value > 0 else None
    return value, error
