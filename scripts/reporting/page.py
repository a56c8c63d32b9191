# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Puts the sections together into one page that works offline: style and pictures inside, nothing fetched."""
import argparse
import datetime
import html
import json
import math
import os
import pathlib
import sys

from . import curves, exr_header, mutants, plates, stability, versions


def page(sections, subtitle):
    style = (pathlib.Path(__file__).parent / "style.css").read_text()
    return (f'<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<meta name="viewport" content="width=device-width">\n'
            f"<title>musurf report</title>\n<style>\n{style}</style>\n<h1>musurf report</h1>\n"
            f'<p class="faint">{html.escape(subtitle)}</p>\n' + "\n".join(sections) + "\n</html>\n")


def write(path, text):
    """Beside, then renamed: an older report stays whole until the new one is."""
    path.parent.mkdir(parents=True, exist_ok=True)
    fresh = path.with_name(path.name + ".new")
    fresh.write_text(text, encoding="utf-8")
    fresh.replace(path)


def strict(value):
    """Numbers that JSON does not have become null."""
    if isinstance(value, dict):
        return {key: strict(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [strict(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def make(options, build):
    """(the page, the same as data)"""
    sections, links, validation, data = [], [], {}, {}
    if options.plates:
        loaded = plates.load(pathlib.Path(options.plates))
        data["plates"] = [{key: value for key, value in plate.items() if key != "data"} for plate in loaded]
        sections.append(plates.section(loaded))
        links.append('<a href="#plates">Plates</a>')
    if options.validate:
        folder = pathlib.Path(options.validate)
        validation = json.loads((folder / "validate.json").read_text())
        sections.append(f'<section id="validate">{(folder / "fragment.html").read_text()}</section>')
        links.append('<a href="#validate">Cross-check</a>')
        data["validate"] = validation
    if options.curves:
        data["curves"] = curves.load(pathlib.Path(options.curves))
        sections.append(curves.section(data["curves"]))
        links.append('<a href="#curves">Error against run time</a>')
    if options.efficiency:
        folder = pathlib.Path(options.efficiency)
        data["efficiency"] = json.loads((folder / "efficiency.json").read_text())
        sections.append(f'<section id="efficiency">{(folder / "fragment.html").read_text()}</section>')
        links.append('<a href="#efficiency">Masking and sampling</a>')
    if options.geometry:
        folder = pathlib.Path(options.geometry)
        data["geometry"] = json.loads((folder / "geometry.json").read_text())
        sections.append(f'<section id="geometry">{(folder / "fragment.html").read_text()}</section>')
        links.append('<a href="#geometry">Explicit geometry</a>')
    if options.mutants:
        path = pathlib.Path(options.mutants)
        data["mutants"] = mutants.load(path) if path.exists() else None
        sections.append(mutants.section(data["mutants"]))
        links.append('<a href="#mutants">Mutants</a>')
    if options.stability:
        folder = pathlib.Path(options.stability)
        data["stability"], pictures = stability.load(folder) if (folder / "stability.json").exists() else (None, [])
        sections.append(stability.section(data["stability"], pictures))
        links.append('<a href="#stability">Stability</a>')
    data["versions"] = dict(versions.gather(build, validation))
    sections.append(versions.section(data["versions"].items()))
    links.append('<a href="#versions">Versions</a>')
    verdict = f" Cross-check: {validation['verdict']}." if validation else ""
    subtitle = f"Made {datetime.datetime.now().astimezone():%Y-%m-%d %H:%M %Z}.{verdict}"
    return page([f"<nav>{''.join(links)}</nav>", *sections], subtitle), data


def main(arguments, build):
    parser = argparse.ArgumentParser("scripts/report", description="Writes one self-contained HTML page and prints its path. "
                                     "Exit 0; 1 if an input is missing or broken; 2 on wrong usage.")
    parser.add_argument("--plates", metavar="DIR", help="rendered plates: PNG files, beside them EXR files and plates.json")
    parser.add_argument("--validate", metavar="DIR", help="output folder of scripts/validate")
    parser.add_argument("--curves", metavar="DIR", help="output folder of scripts/curves")
    parser.add_argument("--efficiency", metavar="DIR", help="output folder of scripts/efficiency")
    parser.add_argument("--geometry", metavar="DIR", help="output folder of scripts/geometry-pair")
    parser.add_argument("--mutants", metavar="FILE", help="mutants.json of tests/test_mutants.py; if it is not there, how to make it")
    parser.add_argument("--stability", metavar="DIR", help="output folder of scripts/stability; likewise")
    parser.add_argument("--json", metavar="FILE", help="the same as data")
    parser.add_argument("-o", metavar="FILE", dest="output", default=os.path.join(str(build), "report", "index.html"))
    options = parser.parse_args(arguments)
    try:
        text, data = make(options, build)
        write(pathlib.Path(options.output), text)
        if options.json:
            write(pathlib.Path(options.json), json.dumps(strict(data), indent=1, ensure_ascii=False, allow_nan=False))
    except OSError as error:
        print(f"report: {error.filename}: {error.strerror}", file=sys.stderr)
        return 1
    except (ValueError, KeyError, TypeError, exr_header.HeaderError) as error:
        print(f"report: {error if isinstance(error, exr_header.HeaderError) else f'an input is not what it should be: {error!r}'}",
              file=sys.stderr)
        return 1
    print(options.output)
    return 0
