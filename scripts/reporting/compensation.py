# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Curves of compensated multiple scattering (tests/bench_albedo.c): furnace error by the error that its tables may have,
against the time to make a material, its bytes, and the time of one value."""

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
    """Worst and rms of each distribution, over its materials, by what was asked."""
    out = []
    for error in ("worst", "rms"):
        for (ndf,), of in by(rows, "ndf").items():
            points = [point(same, x, label(same), error) for same in by(of, "asked").values()]
            out.append({"name": f"{NAMES[ndf]}, {error}", "line": True, "points": points})
    return out


def curves(rows, command):
    singly, tabled = [r for r in rows if not r["asked"]], [r for r in rows if r["asked"]]
    common = {"command": command, "y": {"label": "error of the furnace (1 is right)", "log": True}}
    without = "; ".join(f"{NAMES[ndf]} {max(r['worst'] for r in of):.2g}" for (ndf,), of in by(singly, "ndf").items())
    asked = lambda of: f"{of[0]['asked']:g} asked" if of[0]["asked"] else "without"  # noqa: E731
    yield "4-compensation-compile", dict(
        common, title="Compensated multiple scattering: error against what a material costs to make", series=series(tabled, "compile_us", asked),
        text=f"A white furnace with F = 1, 24 views to 89.5°, by the error that tables may have; {MATERIALS}: the worst of all, and the root mean "
             f"square. The default is 0.01. Without compensation the worst are: {without}. report.json holds every material in rows.",
        x={"label": "microseconds to make a material, mean", "log": True}, rows=rows)
    found = [{"name": f"{NAMES[ndf]}, α {alpha:g}", "line": True,
              "points": [point(same, "bytes", asked(same)) for same in by(of, "asked").values()]}
             for (ndf, alpha), of in by(tabled, "ndf", "alpha").items()]
    yield "5-compensation-bytes", dict(common, title="Compensated multiple scattering: error against the bytes of the tables", series=found,
                                       text="The worst over views and both maps, with all tables that the material holds in float.",
                                       x={"label": "bytes", "log": True})
    yield "6-compensation-time", dict(
        common, title="Compensated multiple scattering: error against the time of one value",
        series=[{"name": NAMES[ndf] + ending, "line": ending == "", "points": [point(same, "ns", asked(same)) for same in by(of, "asked").values()]}
                for group, ending in ((tabled, ""), (singly, ", without")) for (ndf,), of in by(group, "ndf").items()],
        text="One eval with its pdfs, in float, with the tables and without.",
        x={"label": "nanoseconds of processor time", "log": False})
