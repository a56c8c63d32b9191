# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The studies as curves (the form of scripts/reporting/measure.py), with power laws fitted to each series that has a knob alone."""
from . import laws

CLOCKS = {"seconds": "wall seconds, one thread", "cpu_seconds": "processor seconds"}
SURFACES = "Beckmann, α = 0.5, correlation length 8 cells; views 60°, 75° and 85°; relative error of G1, root of the mean square over views and slope bins"


def series(name, points, x, y="y"):
    """Points whose y is nothing or 0 are not drawn. A power law needs three of them; of memory, three that take half as much again as
    the smallest, for below that it is the program's own."""
    kept = [{"x": p[x], "y": p[y], "label": p["label"], "y_error": p.get("y_error") if y == "y" else None,
             **{key: p[key] for key in ("seconds", "cpu_seconds", "megabytes")}} for p in points if p[y]]
    least = min((p["megabytes"] for p in kept), default=0)
    telling = [p for p in kept if "megabytes" not in (x, y) or p["megabytes"] >= 1.5 * least]
    law = laws.power([p["x"] for p in telling], [p["y"] for p in telling]) if len(telling) > 2 else None
    return {"name": name, "line": False, "points": kept, **({"fit": law} if law else {"line": True})}


def curves(found, clock, command):
    time = {"label": CLOCKS[clock], "log": True}
    memory, error = {"label": "peak memory, MB", "log": True}, {"label": "relative error", "log": True}
    common = {"command": command, "x": time, "y": error}
    sizes, samples, pool, scales = found["sizes"], found["samples"], found["pool"], found["scales"]
    one = pool["series"]["G1 per slope bin"]
    yield "1-grid", dict(common, title="Explicit surfaces: grid size and realisations", series=[
        series("one surface of N² cells", sizes["points"], clock), series(f"mean of R surfaces of {pool['size']}² cells", one, clock),
        series(f"likewise, albedo of mirrors after one reflection ({pool['size']}²)", pool["series"]["albedo of mirrors"], clock)],
        text=f"{SURFACES}. To make the surface and to measure it (exact tracer, 9 points a facet). Error of one surface against the mean of the largest; of R "
             f"surfaces against the pool. As scatter falls with the root of the area and time grows with the area, a slope of −1/2 is what to expect of both, and "
             "whichever lies lower is the better way to spend time.")
    yield "2-grid-memory", dict(common, title="Explicit surfaces: grid size and memory", x=memory, text="The same grids against the peak memory of the larger "
                                "process. Realisations cost none; small grids no more than the program itself.", series=[series("one surface of N² cells", sizes["points"], "megabytes")])
    yield "3-points", dict(common, title="Explicit surfaces: points per facet and tracer", series=[
        series(tracer, points, clock) for tracer, points in samples["series"].items()],
        text=f"The same surfaces of {samples['size']}² cells looked at with K points a facet, against 225 points by the exact tracer. Bins of facets seen at grazing "
             "angles make most of the error.")
    if found["images"]:
        yield "4-images", dict(common, title="Explicit surfaces: image resolution", series=[
            series(name, points, clock) for name, points in found["images"]["series"].items()],
            text=f"POV-Ray’s image along the view, R² pixels, each telling the facet it sees; surfaces of {found['images']['size']}² cells, against 225 points a facet. "
                 "Time is that of mesh and three images. Pixels whose lattice is that of the cells meet the same places of every facet: their error "
                 "need not fall steadily.")
    for name, key, axis in (("5-time", clock, time), ("6-memory", "megabytes", memory)):
        drawn = [series(tracer, [dict(r, label=f"N {r['size']}") for r in scales["rows"] if r["tracer"] == tracer and r["map"] == "identity"], "facets", key)
                 for tracer in scales["versions"]]
        if name == "5-time":
            drawn.append(series("making the surface", [dict(c, label=f"N {n}", facets=2 * n * n) for n, c in sizes["makes"].items()], "facets", key))
        yield name, dict(command=command, title=f"Explicit surfaces: {'time' if key == clock else 'memory'} by size and tracer", series=drawn,
                         text="Three views, 9 points a facet, with the bits written. " + ("Slope 1 is linear in facets; below it, the start of the program shows."
                                                                                        if key == clock else "Of the larger process, where POV-Ray is another. Slopes leave out runs that take less than half as much again as the smallest."),
                         x={"label": "facets", "log": True}, y=axis)
