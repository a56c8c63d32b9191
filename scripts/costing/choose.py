# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What to choose for a wanted error of G1 per slope bin: the quickest grid N, points per facet K and realisations R of a tracer.

    error^2 = (s(N)^2 + (c(K) N0 / N)^2) / R + b(K)^2 + a(N)^2

s: scatter of surfaces, a power law through the study of grids; a is what surfaces of N x N cells share against the largest measured,
as small periods may. A grid is chosen only where a is known to be less than the wanted error. Of the study of points at N0: c is the part of their error that
differs from surface to surface and falls with more facets, b is what all surfaces share and nothing but more points removes; at the
reference's own K both are extrapolated by their power laws. Time is that of making and measuring R surfaces one after another, memory
that of the larger process; both are sums of terms 1, N^2 log N or 1, N^2, K N^2, fitted with positive coefficients.
"""
import math

import numpy as np

from . import effort as efforts
from . import laws

TARGETS = (0.01, 0.003, 0.001, 0.0003)
SIZES = tuple(64 * 2 ** k for k in range(6))
UNITS = ("seconds", "cpu_seconds", "megabytes")


def traced(size, points):
    return [1.0, size * size, size * size * points]


def made(size):
    return [1.0, size * size * math.log2(size)]


class Costs:
    """Predicts a tracer's seconds and megabytes for N and K from what was measured."""

    def __init__(self, makes, runs):
        """makes: {N: cost}; runs: [(N, K, cost)]"""
        self.make = {u: laws.sums([made(n) for n in makes], [c[u] for c in makes.values()]) for u in UNITS}
        self.run = {u: laws.sums([traced(n, k) for n, k, _ in runs], [c[u] for _, _, c in runs]) for u in UNITS}

    def predict(self, size, points, realisations):
        make, run = ({u: float(np.dot(c[u], terms)) for u in UNITS} for c, terms in ((self.make, made(size)), (self.run, traced(size, points))))
        return {**{u: realisations * (make[u] + run[u]) for u in UNITS[:2]}, "megabytes": max(make["megabytes"], run["megabytes"])}


class Errors:
    def __init__(self, sizes, samples):
        self.law = laws.power([p["size"] for p in sizes["points"]], [p["y"] for p in sizes["points"]])
        self.shared = {p["size"]: (p["bias"], p["unknown"]) for p in sizes["points"]}
        self.largest = max(self.shared)
        self.size, self.parts = samples["size"], {k: (v["bias"], v["scatter"]) for k, v in samples["laws"].items()}
        known = sorted(self.parts)
        for part in range(2):  # the reference's own
            usable = [(k, self.parts[k][part]) for k in known if self.parts[k][part] > 0]
            law = laws.power(*zip(*usable)) if len(usable) > 1 else None
            least = min((y for _, y in usable), default=0.0)
            value = min(laws.at(law, efforts.REFERENCE), least) if law else least
            self.parts[efforts.REFERENCE] = (*self.parts.get(efforts.REFERENCE, ())[:part], value)

    def of_one(self, size, points):
        """(what realisations average out, what they do not)"""
        bias, scatter = self.parts[points]
        return math.hypot(laws.at(self.law, size), scatter * self.size / size), math.hypot(bias, self.shared.get(size, (0.0, 0.0))[0])

    def knows(self, size, wanted):
        """Larger than the largest measured: as good as that."""
        return math.hypot(*self.shared[size]) < wanted if size in self.shared else size > self.largest

    def realisations(self, size, points, wanted):
        if not self.knows(size, wanted):
            return None
        varying, bias = self.of_one(size, points)
        return None if bias >= wanted else max(1, math.ceil(varying ** 2 / (wanted ** 2 - bias ** 2)))


def best(errors, costs, wanted, clock):
    """The quickest choice, or None if no K is exact enough."""
    found = []
    for size in SIZES:
        for points in errors.parts:
            count = errors.realisations(size, points, wanted)
            if count:
                varying, bias = errors.of_one(size, points)
                found.append({"wanted": wanted, "size": size, "points": points, "realisations": count, "predicted": math.hypot(varying / math.sqrt(count), bias),
                              **costs.predict(size, points, count)})
    return min(found, key=lambda choice: choice[clock], default=None)


def pixels(points, clock):
    """Which image resolution adds a wanted error, by the laws of error and time over pixels a side: [{"wanted", "pixels", clock, "measured"}];
    `measured` is False beyond the largest image measured. None where no law was found."""
    sides = [p["pixels"] for p in points]
    error, time = (laws.power(sides, [p[key] for p in points]) for key in ("y", clock))
    if len(points) < 3 or error["slope"] >= 0:
        return None
    found = [(wanted, math.ceil((wanted / error["factor"]) ** (1 / error["slope"]))) for wanted in TARGETS]
    return [{"wanted": wanted, "pixels": side, clock: laws.at(time, side), "measured": side <= max(sides)} for wanted, side in found]
