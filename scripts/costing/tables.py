# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The studies as text and as a section of the report."""
import html

from reporting import curves as drawing

UNIT = {"seconds": "wall s", "cpu_seconds": "processor s"}


def power(law):
    return f"{law['slope']:+.2f}" + (f" ± {law['error']:.2f}" if law["error"] is not None else "")


def percent(value):
    return "–" if value is None else f"{value:.2%}" if value >= 0.001 else f"{value:.3%}"


def choice(row, clock):
    """Cells: tracer, wanted, N, K, R, predicted error, time, memory, tried error, tried time."""
    if row["size"] is None:
        return [row["tracer"], percent(row["wanted"]), *["–"] * 8]
    tried = (f"{percent(row['measured'])}" + (f" ± {percent(row['measured_error'])}" if row["measured_error"] is not None else "")) if "measured" in row else "–"
    return [row["tracer"], percent(row["wanted"]), row["size"], row["points"], row["realisations"], percent(row["predicted"]), f"{row[clock]:.3g}", f"{row['megabytes']:.0f}",
            tried, f"{row[f'measured_{clock}']:.3g}" if "measured" in row else "–"]


def heads(clock):
    return ["tracer", "wanted", "N", "K", "R", "error", UNIT[clock], "MB", "tried: error", f"tried: {UNIT[clock]}"]


def bits(rows):
    """{(tracer, map): (different, of, sizes)}"""
    found = {}
    for row in (row for row in rows if row["tracer"] != "own"):
        different, of, sizes = found.get((row["tracer"], row["map"]), (0, 0, []))
        found[row["tracer"], row["map"]] = different + row["different"], of + row["bits"], [*sizes, row["size"]]
    return found


def summary(result):
    clock = result["clock"]
    yield "for an error of G1 per slope bin of:"
    for cells in [heads(clock), *(choice(row, clock) for row in result["choices"]["rows"])]:
        yield "  " + " ".join(f"{str(cell):>{width}}" for cell, width in zip(cells, (8, 7, 5, 4, 7, 7, 12, 6, 18, 18)))
    for name, chosen in result["images"].items():
        if chosen:
            yield f"  images, {name}: " + ", ".join(f"{percent(c['wanted'])} {c['pixels']}{'' if c['measured'] else '*'}" for c in chosen)
    for title, found in result["slopes"].items():
        for name, law in found.items():
            yield f"  {title}, {name}: slope {power(law)}"
    for (tracer, name), (different, of, _) in bits(result["scales"]).items():
        yield f"  {tracer}, {name}: {different} of {of} bits are not the exact tracer's"
    yield f"  {result['seconds']:.0f} s; wall over processor time {result['busy']:.2f}"


def table(head, rows):
    body = "".join("<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{''.join(f'<th>{html.escape(h)}</th>' for h in head)}</tr></thead><tbody>{body}</tbody></table>"


def fragment(result, curves):
    clock = result["clock"]
    differing = [[tracer, name, ", ".join(map(str, sizes)), different, of] for (tracer, name), (different, of, sizes) in bits(result["scales"]).items()]
    slopes = [[title.partition(": ")[2], name, power(law), law["points"]] for title, found in result["slopes"].items() for name, law in found.items()]
    images = [[name, *(f"{c['pixels']}{'' if c['measured'] else '*'}, {c[clock]:.3g} s" for c in chosen)] for name, chosen in result["images"].items() if chosen]
    busy = ("" if result["busy"] < 1.2 else f"<p class=faint>The machine was busy: wall time was {result['busy']:.1f} times processor time. Times by the wall clock, and "
            "slopes in them, are too large and uneven; measure again on an idle machine, or with <code>--clock cpu</code>.</p>")
    return (
        "<h2>What accuracy costs</h2>\n<p>Explicit surfaces, measured by <code>musurf surface make</code> and <code>measure</code>. Time and memory are those of the "
        f"very processes, on one thread. {html.escape(', '.join(f'{k}: {v}' for k, v in result['tracers'].items()))}.</p>\n{busy}"
        "<h3>What to choose for a wanted error</h3>\n<p>The quickest grid (N² cells), points per facet (K) and realisations (R) for a relative error of G1, root of the mean "
        "square over slope bins and three views, against the mean over all surfaces of this kind (Beckmann, α = 0.5). Predicted from the laws below: scatter of surfaces "
        "over N and R, the points’ scatter, and what all surfaces of a grid or all points share, which no averaging removes; a grid is offered only where that is known well enough. “Tried” is the same run anew four times with fresh seeds, where it takes little time and "
        f"the reference ({percent(result['reference_error'])}) knows better.</p>\n"
        + table(heads(clock), [choice(row, clock) for row in result["choices"]["rows"]])
        + (f"<p>Pixels a side of POV-Ray’s images, and {UNIT[clock]} for three of them, that add no more than this error on a surface of {result['image_size']}² cells, by "
           "the laws below (*: beyond the largest that was measured):</p>\n" + table(["image", *(percent(c["wanted"]) for c in next(filter(None, result["images"].values())))], images)
           if images else "")
        + "<h3>Slopes</h3>\n<p>Exponents p of y = a x<sup>p</sup>, by least squares of the logarithms, with the standard error that the scatter about the line gives.</p>\n"
        + table(["study", "series", "slope", "points"], slopes)
        + "<h3>Bits</h3>\n<p>One bit tells whether a view sees a facet. M is baked into the vertices. How many are not those of the exact tracer, in double precision, "
        "over three views and all sizes:</p>\n" + table(["tracer", "M", "N", "differ", "of"], differing)
        + drawing.figures(curves) + f"<p class=faint>{result['seconds']:.0f} s. <code>{html.escape(result['command'])}</code></p>\n")
