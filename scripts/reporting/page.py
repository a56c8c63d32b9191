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

from . import claims, exr_header, parts, sections, versions

HELP = {"gallery": "output folder of scripts/gallery", "plates": "PNG files, beside them EXR files and plates.json", "validate": "output folder of scripts/validate",
        "curves": "output folder of scripts/curves", "costs": "output folder of scripts/costs", "efficiency": "output folder of scripts/efficiency",
        "ibl": "output folder of scripts/ibl", "geometry": "output folder of scripts/geometry-pair", "deformed": "output folder of scripts/geometry-tension", "figures": "output folder of scripts/figures",
        "mutants": "mutants.json of tests/test_mutants.py", "stability": "output folder of scripts/stability"}


def page(texts, subtitle):
    style = (pathlib.Path(__file__).parent / "style.css").read_text()
    return (f'<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<meta name="viewport" content="width=device-width">\n'
            f"<title>musurf report</title>\n<style>\n{style}</style>\n<h1>musurf report</h1>\n"
            f'<p class="faint">{html.escape(subtitle)}</p>\n' + "\n".join(texts) + "\n</html>\n")


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


def make(options, build, ran=None):
    """(the page, the same as data). ran: what parts.run() says; without it, a broken input is an error."""
    found, data, older = sections.collect(options, {part["name"]: part for part in ran} if ran is not None else None)
    validation = data.get("validate", {})
    data["versions"] = dict(versions.gather(build, validation))
    shown = [(name, title, text) for name, title, text in found] + [("versions", "Versions", versions.section(data["versions"].items()))]
    if ran is not None:
        data["parts"], data["claims"] = ran, claims.measured(data, older)
        shown = [("claims", "Claims", claims.section(data["claims"])), *shown, ("parts", "Command lines", parts.section(ran))]
    verdict = f" Cross-check: {validation['verdict']}." if validation else ""
    failed = [part["name"] for part in ran or [] if part["code"]]
    broken = f" Parts that failed: {', '.join(failed)}." if failed else ""
    subtitle = f"Made {datetime.datetime.now().astimezone():%Y-%m-%d %H:%M %Z}.{verdict}{broken}"
    links = "".join(f'<a href="#{name}">{title}</a>' for name, title, _ in shown)
    return page([f"<nav>{links}</nav>", *(text for _, _, text in shown)], subtitle), data


def main(arguments, build):
    parser = argparse.ArgumentParser("scripts/report", description="Writes one self-contained HTML page and prints its path. With --all, runs what it shows, and says "
                                     "in the page what failed. Exit 0; 1 if an input is missing or broken, or a part of --all failed; 2 on wrong usage.")
    parser.add_argument("--all", action="store_true", help="run every part into the build folder, show all that is there, and what is claimed on top")
    parser.add_argument("--quick", action="store_true", help="with --all: small")
    parser.add_argument("--part", action="append", choices=list(parts.PARTS), help="with --all: run this part alone, and show what is there of the others; may be repeated")
    for name, title, where, _ in sections.SECTIONS:
        optional = ": if it is not there, how to make it" if name in ("mutants", "stability") else ""
        parser.add_argument(f"--{name}", metavar="FILE" if where.endswith(".json") else "DIR", help=f"{title}: {HELP[name]}{optional}")
    parser.add_argument("--json", metavar="FILE", help="the same as data")
    parser.add_argument("-o", metavar="FILE", dest="output", default=os.path.join(str(build), "report", "index.html"))
    options = parser.parse_args(arguments)
    if not options.all and (options.quick or options.part):
        parser.error("--quick and --part go with --all")
    ran = None
    try:
        if options.all:
            ran = parts.run(build, options.quick, options.part or tuple(parts.PARTS))
            for name, _, where, _ in sections.SECTIONS:
                setattr(options, name, getattr(options, name) or str(build / where))
        text, data = make(options, build, ran)
        write(pathlib.Path(options.output), text)
        if options.json:
            write(pathlib.Path(options.json), json.dumps(strict(data), indent=1, ensure_ascii=False, allow_nan=False))
    except OSError as error:
        print(f"report: {error.filename}: {error.strerror}", file=sys.stderr)
        return 1
    except exr_header.HeaderError as error:
        print(f"report: {error}", file=sys.stderr)
        return 1
    except (ValueError, KeyError, TypeError) as error:
        print(f"report: an input is not what it should be: {error!r}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    print(options.output)
    return 1 if any(part["code"] for part in ran or []) else 0
