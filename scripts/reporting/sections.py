# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The sections of the page in their order, each from the folder or file that a part of the report leaves."""
import datetime
import html
import json
import pathlib

from . import curves, mutants, plates, stability

# what reading a broken or missing input raises; exr_header.HeaderError is a ValueError
ERRORS = (OSError, ValueError, KeyError, TypeError)


def study(name, file):
    """A folder with data and a fragment of HTML."""
    def load(path):
        folder = pathlib.Path(path)
        return json.loads((folder / file).read_text()), f'<section id="{name}">{(folder / "fragment.html").read_text()}</section>'
    return load


def of_plates(path):
    loaded = plates.load(pathlib.Path(path))
    return [{key: value for key, value in plate.items() if key != "data"} for plate in loaded], plates.section(loaded)


def of_curves(path):
    loaded = curves.load(pathlib.Path(path))
    return loaded, curves.section(loaded)


def of_mutants(path):
    found = mutants.load(pathlib.Path(path)) if pathlib.Path(path).exists() else None
    return found, mutants.section(found)


def of_stability(path):
    folder = pathlib.Path(path)
    found, pictures = stability.load(folder) if (folder / "stability.json").exists() else (None, [])
    return found, stability.section(found, pictures)


# (name, also the option's and the link's; title; where it is below the build folder; (data, HTML) from a path)
SECTIONS = [("gallery", "Surfaces and lobes", "gallery", study("gallery", "gallery.json")), ("plates", "Plates", "plates", of_plates),
            ("validate", "Cross-check", "validate", study("validate", "validate.json")), ("curves", "Error against run time", "curves", of_curves),
            ("costs", "What accuracy costs", "costs", study("costs", "costs.json")), ("efficiency", "Masking and sampling", "efficiency", study("efficiency", "efficiency.json")),
            ("ibl", "Image-based lighting", "ibl", study("ibl", "ibl.json")), ("geometry", "Explicit geometry", "geometry", study("geometry", "geometry.json")),
            ("deformed", "Deformed plates", "geometry-tension", study("deformed", "deformed.json")), ("figures", "Figures 6 to 8", "figures", study("figures", "figures.json")),
            ("mutants", "Mutants", "mutants.json", of_mutants),
            ("stability", "Stability", "stability", of_stability)]


def missing(name, title, why):
    return f'<h2 id="{name}">{html.escape(title)}</h2>\n<p class="missing">This part is missing: {html.escape(why)}.</p>'


def written(path):
    """When the file, or the folder's latest file, was written; nothing if there is none."""
    path = pathlib.Path(path)
    times = [file.stat().st_mtime for file in (path.iterdir() if path.is_dir() else [path] if path.exists() else [])]
    return f"{datetime.datetime.fromtimestamp(max(times)).astimezone():%Y-%m-%d %H:%M}" if times else ""


def collect(options, parts):
    """([(name, title, HTML)], data, {name: when}). parts: how this run's parts ended, by name, or None: then a broken input is an error.

    The last are sections that an earlier run left, with the time of their files.
    """
    found, data, older = [], {}, {}
    for name, title, _, load in SECTIONS:
        path, part = getattr(options, name), (parts or {}).get(name)
        if not path:
            continue
        if part and not part["fresh"]:
            found.append((name, title, missing(name, title, f"{part['command']} ended with {part['code']} and left nothing; {part['said']}")))
            continue
        try:
            data[name], text = load(path)
            if parts is not None and not part and data[name] is not None:
                older[name] = written(path)
                text += f"\n<p class=faint>Left by an earlier run, {older[name]}.</p>"
            found.append((name, title, text))
        except ERRORS as error:
            if parts is None:
                raise
            data.pop(name, None)
            found.append((name, title, missing(name, title, f"{type(error).__name__}: {error}")))
    return found, data, older
