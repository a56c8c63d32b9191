# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""stability.md and stability.html: tables, what was asked and what it was held to, pictures."""
import base64
import html
import pathlib

from reporting import page

from . import tables

EXPLANATION = """\
Relative errors of `musurf eval` against values computed apart with 50-digit arithmetic, over {count} materials and directions:
all families, α from 0 to 1, γ to 10, M of condition up to 1e8 and scale 1e±12, mirrored or not, tilt to 60°, both sides of
dielectrics, views and half-vectors to 1e-9 from the horizon; every sampler, histograms, the spline of Appendix A; and of {drawn}
directions that `musurf sample` drew. Errors are over the values that their inputs determine in that format; *beyond inputs* is
what is left of the worst when the rounding of the inputs themselves is taken off.
"""
HELD = """\
Held to an independent value: D, Dv, G1, G2, Λ, σ, F, f and pdf of `eval`, and f, pdf and weight of `sample`, in single scattering by
every distribution and sampler (discrete ones without a footprint: their mean). The spline is held to Appendix A as printed; how far
it is from the masking that it approximates is told, not judged. Float Λ of a histogram is a table, held to its stated 3e-5 of σ.
Held to ranges alone (finite, not negative, G1 and G2 in [0, 1], weights below their bounds): compensated scattering, random walks,
flakes in a footprint; of flakes also the mean over 400 footprints. A mirror shows 0 in eval.
"""


def checks_table(checks):
    head = ["held to ranges and bounds", *tables.FORMATS, "failures"]
    names = list(dict.fromkeys(name for found in checks.values() for name in found["numbers"]))
    return head, [[name, *(str(checks[p]["numbers"].get(name, 0)) for p in tables.FORMATS),
                   str(sum(checks[p]["failures"].get(name, 0) for p in tables.FORMATS))] for name in names]


def coverage_table(rows):
    return ["axis", "value", "questions", "values judged"], [[axis, format(value, ".10g") if isinstance(value, float) else str(value),
                                                               str(asked), str(judged)] for axis, value, asked, judged in rows]


def spline_line(spline):
    return (f"The spline of Appendix A (approximate) against exact masking, G1 and G2 of {spline['values']} directions: absolute error "
            f"median {spline['median']:.2g}, 99th percentile {spline['p99']:.2g}, worst {spline['worst']:.2g}; relative, worst "
            f"{spline['relative']:.2g}.") if spline else ""


def write(found, intro, names, folder):
    verdict = f"{len(found['failures'])} failures" if found["failures"] else "no failures"
    parts = [tables.full(found["summary"]), checks_table(found["checks"]), coverage_table(found["coverage"])]
    spline = spline_line(found["spline"])
    listed = "".join(f"- {failure}\n" for failure in found["failures"])
    text = "\n".join(tables.markdown(*part) for part in parts)
    page.write(folder / "stability.md", f"# Numerical stability: {verdict}\n\n{intro}\n{HELD}\n{spline}\n\n{text}\n{listed}")
    style = (pathlib.Path(page.__file__).parent / "style.css").read_text()
    figures = "".join(f'<p><img alt="error against {name}" style="max-width:100%" src="data:image/png;base64,'
                      f'{base64.b64encode((folder / f"{name}.png").read_bytes()).decode()}"></p>\n' for name in names)
    items = "".join(f"<li>{html.escape(failure)}</li>\n" for failure in found["failures"])
    shown = "".join(f'<div style="overflow-x:auto">{tables.as_html(*part)}</div>\n' for part in parts)
    page.write(folder / "stability.html",
               f'<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<title>musurf: numerical stability</title>\n'
               f"<style>\n{style}</style>\n<h1>Numerical stability: {verdict}</h1>\n<p>{html.escape(intro)}</p>\n"
               f"<p>{html.escape(HELD)}</p>\n<p>{html.escape(spline)}</p>\n{shown}{figures}<ul>{items}</ul>\n</html>\n")
