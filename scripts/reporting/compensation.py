# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Curves of compensated multiple scattering (tests/bench_albedo.c): furnace error by the cells of its tables and the panels of
the quadrature that fills them, against the time to make a material, its bytes, and the time of one value."""

NAMES = {"ggx": "GGX", "beckmann": "Beckmann", "gtr": "GTR 1.5", "sheen": "sheen"}
MATERIALS = "α 0.1, 0.5, 1, M = 1 and [[1, 2], [0, 1]]"


def by(rows, *keys):
    """{values of the keys: rows}, in their order."""
    groups = {}
    for row in rows:
        groups.setdefault(tuple(row[key] for key in keys), []).append(row)
    return groups


def point(rows, x, label, error="worst"):
    """Over materials: the worst, or the root of the mean square; x is a mean."""
    y = max(r["worst"] for r in rows) if error == "worst" else (sum(r["rms"] ** 2 for r in rows) / len(rows)) ** 0.5
    return {"x": sum(r[x] for r in rows) / len(rows), "y": y, "label": label}


def series(rows, x, label):
    """Worst and rms of each distribution, over its materials, along cells."""
    out = []
    for error in ("worst", "rms"):
        for (ndf,), of in by(rows, "ndf").items():
            points = [point(same, x, label(same), error) for same in by(of, "cells", "panels").values()]
            out.append({"name": f"{NAMES[ndf]}, {error}", "line": True, "points": points})
    return out


def curves(rows, command):
    usual = next(r["panels"] for r in rows if r["cells"] == 4)
    singly, tabled = [r for r in rows if not r["cells"]], [r for r in rows if r["cells"] and r["panels"] == usual]
    fixed = next(r["cells"] for r in rows if r["cells"] and r["panels"] != usual)
    panels = sorted((r for r in rows if r["cells"] == fixed), key=lambda r: r["panels"])
    common = {"command": command, "y": {"label": "error of the furnace (1 is right)", "log": True}}
    without = "; ".join(f"{NAMES[ndf]} {max(r['worst'] for r in of):.2g}" for (ndf,), of in by(singly, "ndf").items())
    cells = lambda of: f"{of[0]['cells']}² cells" if of[0]["cells"] else "without"  # noqa: E731
    yield "4-compensation-compile", dict(
        common, title="Compensated multiple scattering: error against what a material costs to make", series=series(tabled, "compile_us", cells),
        text=f"A white furnace with F = 1, 24 views to 89.5°, by the cells of the tables; {MATERIALS}: the worst of all, and the root mean "
             f"square. The default is {fixed}² cells, {usual} panels. Without compensation the worst are: {without}. report.json holds every material in rows.",
        x={"label": "microseconds to make a material, mean", "log": True}, rows=rows)
    yield "5-compensation-panels", dict(
        common, title="Compensated multiple scattering: quadrature nodes against what a material costs to make",
        series=series(panels, "compile_us", lambda of: f"{of[0]['panels']} × 8 nodes"),
        text=f"The same by the panels of azimuth by which each value of the table is integrated (twice as many where M is far from a similarity), "
             f"at {fixed}² cells. Where more panels gain nothing, the cells decide.", x={"label": "microseconds to make a material, mean", "log": True})
    found = [{"name": f"{NAMES[ndf]}, α {alpha:g}", "line": True,
              "points": [point(same, "bytes", cells(same)) for same in by(of, "cells").values()]}
             for (ndf, alpha), of in by(tabled, "ndf", "alpha").items()]
    yield "6-compensation-bytes", dict(common, title="Compensated multiple scattering: error against the bytes of the tables", series=found,
                                       text="The worst over views and both maps, with all tables that the material holds in float.",
                                       x={"label": "bytes", "log": True})
    yield "7-compensation-time", dict(
        common, title="Compensated multiple scattering: error against the time of one value",
        series=[{"name": NAMES[ndf] + ending, "line": ending == "", "points": [point(same, "ns", cells(same)) for same in by(of, "cells").values()]}
                for group, ending in ((tabled, ""), (singly, ", without")) for (ndf,), of in by(group, "ndf").items()],
        text="One eval with its pdfs, in float, with the tables and without.",
        x={"label": "nanoseconds of processor time", "log": False})
