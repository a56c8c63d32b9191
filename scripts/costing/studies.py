# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The studies of grid, points per facet, realisations and tracer. Each varies one knob and returns points {"label", "y", "y_error",
"seconds", "cpu_seconds", "megabytes"}: y is an error, or None where the run is the reference itself."""
import numpy as np

from . import effort as efforts
from . import process
from .laboratory import VIEWS, root, squares


def point(label, error, cost, **more):
    return {"label": label, "y": error[0], "y_error": error[1], **cost, **more}


def sizes(lab, plan):
    """How far G1 of one surface of N x N cells lies from that of all such surfaces; a surface's cost is to make it and to measure it.

    The reference is the mean over the largest. Theirs is the sample's scatter (the sum of squares over R - 1); what the reference's own
    scatter (1/R of that) adds to the others is taken off.
    """
    found, costs, makes = {}, {}, {}
    for size, count in plan.sizes.items():
        runs = []
        for seed in range(efforts.SIZES, efforts.SIZES + count):
            file, made = lab.make(size, seed)
            g1, measured, _ = lab.measure(file)
            runs.append((g1, process.total([made, measured]), made))
            lab.forget(size, seed)
        found[size] = np.array([run[0] for run in runs])
        costs[size], makes[size] = (process.mean([run[k] for run in runs]) for k in (1, 2))
    largest = max(plan.sizes)
    reference, count = np.nanmean(found[largest], axis=0), plan.sizes[largest]
    scatter = squares(found[largest], reference) * count / (count - 1)
    excess, points = float(scatter.mean() / count), []
    for size in plan.sizes:
        error = root(scatter) if size == largest else root(squares(found[size], reference), excess)
        points.append(point(f"N {size}", error, costs[size], size=size, **common(found[size], reference, excess, size == largest)))
    return {"points": points, "reference": reference, "reference_error": float(np.sqrt(excess)), "makes": makes}


def common(values, reference, excess, is_reference):
    """What all surfaces of a size share against the reference ("bias"), and which would be found if they shared nothing ("unknown")."""
    if is_reference:
        return {"bias": 0.0, "unknown": 0.0}
    off = values / reference - 1
    noise = float(np.nanmean(np.nanvar(off, axis=0, ddof=1)) / len(off)) + excess
    return {"bias": float(np.sqrt(max(0.0, np.nanmean(np.nanmean(off, axis=0) ** 2) - noise))), "unknown": float(np.sqrt(noise))}


def subsamples(lab, plan, tracers):
    """How far G1 of one surface, by K points a facet, lies from that of 225 points by the exact tracer, on the same surface."""
    count, size = max(plan.points_of.values()), plan.points_size
    files = [lab.make(size, seed)[0] for seed in range(efforts.POINTS, efforts.POINTS + count)]
    exact = [lab.measure(file, "own", efforts.REFERENCE) for file in files]
    reference = np.array([e[0] for e in exact])
    series, laws = {}, {}
    for tracer in tracers:
        points = []
        for k in plan.points:
            if k > plan.most_points[tracer]:
                continue
            looked = [lab.measure(file, tracer, k) for file in files[:plan.points_of[tracer]]]
            off = np.array([g1 for g1, _, _ in looked]) / reference[:len(looked)] - 1
            points.append(point(f"K {k}", root(squares(off + 1, 1.0)), process.mean([c for _, c, _ in looked]), points=k))
            if tracer == "own":  # what all surfaces share stays when they are averaged, the rest does not
                share, scatter = np.nanmean(off, axis=0), np.nanvar(off, axis=0, ddof=1)
                bias = np.nanmean(share ** 2) - np.nanmean(scatter) / len(off)
                laws[k] = {"bias": float(np.sqrt(max(bias, 0.0))), "scatter": float(np.sqrt(np.nanmean(scatter))), "ratio": share}
        series[tracer] = points
    cost = process.mean([c for _, c, _ in exact])
    series["own"].append({"label": f"K {efforts.REFERENCE}", "y": None, "y_error": None, "points": efforts.REFERENCE, **cost})
    for seed in range(efforts.POINTS, efforts.POINTS + count):
        lab.forget(size, seed)
    return {"series": series, "laws": laws, "size": size}


def realisations(lab, plan):
    """How far the mean over R surfaces lies from that over the whole pool: of G1, and of the mirrors' albedo.

    The pool is dealt into P / R groups. A group's mean deviates from the pool's by (1 - R/P) of the variance that it has about
    the truth; that is made good.
    """
    masks, albedos, seeds = [], [], range(efforts.POOL, efforts.POOL + plan.pool)
    for seed in seeds:
        file, made = lab.make(plan.pool_size, seed)
        g1, measured, _ = lab.measure(file)
        albedo, counted = lab.albedo(file)
        lab.forget(plan.pool_size, seed)
        masks.append((g1, process.total([made, measured])))
        albedos.append((albedo, process.total([made, counted])))
    series = {}
    for name, runs in (("G1 per slope bin", masks), ("albedo of mirrors", albedos)):
        values, cost = np.array([run[0] for run in runs]), process.mean([run[1] for run in runs])
        points, r = [], 1
        while r <= plan.pool // 4:
            groups = values[:plan.pool // r * r].reshape(-1, r, *values.shape[1:]).mean(1)
            found = squares(groups, values.mean(0)) / (1 - r / plan.pool)
            points.append(point(f"R {r}", root(found), {**cost, "seconds": r * cost["seconds"], "cpu_seconds": r * cost["cpu_seconds"]}, realisations=r))
            r *= 2
        series[name] = points
    return {"series": series, "albedo": np.mean([a for a, _ in albedos], axis=0).tolist(), "size": plan.pool_size,
            "albedo_error": (np.std([a for a, _ in albedos], axis=0, ddof=1) / np.sqrt(plan.pool)).tolist()}


MAPS = {"identity": (1, 0, 0, 1), "stretch 5": (5, 0, 0, 1), "skew": (1, 2, 0, 1)}


def scales(lab, plan, tracers):
    """Time and memory of a tracer over the surface's size, and which of its bits (does this view see this facet?) are not the exact
    tracer's, with M baked into the vertices."""
    rows, versions, exact = [], {}, {}
    for tracer in tracers:
        for size in plan.scales[tracer]:
            file = lab.make(size, efforts.SCALES)[0]
            for name, m in MAPS.items() if size <= min(256, max(plan.scales[tracer])) else [("identity", MAPS["identity"])]:
                bits = lab.folder / "bits.npy"
                _, cost, versions[tracer] = lab.measure(file, tracer, transform=m, bits=bits)
                seen = np.load(bits)
                exact.setdefault((size, name), seen)
                rows.append({"tracer": tracer, "size": size, "facets": 2 * size * size, "map": name, "bits": seen.size,
                             "different": int((seen != exact[size, name]).sum()), "points": 9, **cost})
    return {"rows": rows, "versions": versions, "views": len(VIEWS)}
