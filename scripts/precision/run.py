# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Asks, judges, and writes build/stability/: stability.json, .md, .html and pictures; see scripts/stability."""
import argparse
import base64
import html
import json
import pathlib
import sys
import time

from reporting import page, readme

from . import exact, grid, measure, pictures, tables

EXPLANATION = """\
Relative errors of `musurf eval` against values computed apart with 50-digit arithmetic, over {count} materials and directions:
all families, α from 0 to 1, γ to 10, M of condition up to 1e8 and scale 1e±12, mirrored or not, tilt to 60°, both sides of
dielectrics, views and half-vectors to 1e-9 from the horizon. Errors are over the values that their inputs determine in that
format; *beyond inputs* is what is left of the worst when the rounding of the inputs themselves is taken off.
"""


def report(sums, failures, count, names, folder):
    head, rows = tables.full(sums)
    intro = EXPLANATION.format(count=count)
    verdict = f"{len(failures)} failures" if failures else "no failures"
    listed = "".join(f"- {failure}\n" for failure in failures)
    page.write(folder / "stability.md", f"# Numerical stability: {verdict}\n\n{intro}\n{tables.markdown(head, rows)}\n{listed}")
    style = (pathlib.Path(page.__file__).parent / "style.css").read_text()
    figures = "".join(f'<p><img alt="error against {name}" style="max-width:100%" src="data:image/png;base64,'
                      f'{base64.b64encode((folder / f"{name}.png").read_bytes()).decode()}"></p>\n' for name in names)
    items = "".join(f"<li>{html.escape(failure)}</li>\n" for failure in failures)
    page.write(folder / "stability.html",
               f'<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<title>musurf: numerical stability</title>\n'
               f"<style>\n{style}</style>\n<h1>Numerical stability: {verdict}</h1>\n<p>{html.escape(intro)}</p>\n"
               f'<div style="overflow-x:auto">{tables.as_html(head, rows)}</div>\n{figures}<ul>{items}</ul>\n</html>\n')


def main(arguments, build):
    parser = argparse.ArgumentParser("scripts/stability", description="Measures the numerical stability of `musurf eval`. Exit 0; "
                                     "1 if a value is not finite, of the wrong sign, out of range, or wrong beyond the bound.")
    parser.add_argument("--points", metavar="N", type=int, default=3000, help="how many (default 3000)")
    parser.add_argument("--readme", action="store_true", help="write the short table into README.md")
    parser.add_argument("-o", metavar="DIR", dest="output", default=str(build / "stability"))
    options = parser.parse_args(arguments)
    folder = pathlib.Path(options.output)

    def say(text):
        print(f"stability: {text}", file=sys.stderr, flush=True)

    start = time.monotonic()
    questions, axes = zip(*grid.points(options.points))
    answers = exact.answers(questions, folder, say)
    say(f"exact answers after {time.monotonic() - start:.0f} s")
    records, failures = [], []
    for precision in tables.FORMATS:
        found, wrong = measure.judge(answers, axes, measure.ask(build / "musurf", questions, precision), precision)
        records += found
        failures += [f"{precision}: {failure}" for failure in wrong]
    sums = tables.summary(records)
    for axis in pictures.AXES:
        pictures.draw(records, axis, folder / f"{axis}.png")
    numbered = [{**r, "id": int(r["id"].split(":")[0])} for r in records]
    page.write(folder / "stability.json", json.dumps({"points": len(questions), "summary": sums, "failures": failures,
                                                      "ids": [q["id"] for q in questions], "records": numbered}))
    report(sums, failures, len(questions), list(pictures.AXES), folder)
    short = tables.markdown(*tables.short(sums))
    print(short, end="")
    for failure in failures[:20]:
        print(f"FAILED {failure}")
    print(f"{len(records)} values, {len(failures)} failures; {folder / 'stability.html'}")
    if options.readme:
        readme.write("stability", EXPLANATION.format(count=len(questions)) + "\n" + short)
    return 1 if failures else 0
