#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Puts the page into one file that needs no other: style, scripts, those of the workers, the core in base64.

    bundle.py FOLDER MODULE.wasm -o PAGE.html

Scripts are modules; what one imports is put before it, and `import` and `export` are taken away. Names of the top level must differ."""
import argparse
import base64
import pathlib
import re

IMPORT = re.compile(r'^import \{([^}]*)\} from "\./([\w.]+)";\n', re.M)
TOP = re.compile(r"^(?:async )?(?:const|let|class|function) (.*)", re.M)
DECLARED = re.compile(r"(?:^|, )(\w+)(?=$| =|;|\(| \{| extends)")


def ordered(folder, entry, before=()):
    """The files that `entry` needs and itself, each after those that it needs."""
    if entry in before:
        raise SystemExit(f"{entry} imports itself by way of {', '.join(before)}")
    files = []
    for _, needed in IMPORT.findall((folder / entry).read_text()):
        files += [file for file in ordered(folder, needed, (*before, entry)) if file not in files]
    return [*files, entry]


def script(folder, entry):
    """One script in strict mode."""
    names, text = {}, ""
    for file in ordered(folder, entry):
        own = (folder / file).read_text()
        for imported, source in IMPORT.findall(own):
            for name in imported.split(","):
                if not re.search(rf"^export (?:async )?\w+ {name.strip()}\b", (folder / source).read_text(), re.M):
                    raise SystemExit(f"{file} imports {name.strip()}, which {source} does not export")
        own = re.sub(r"^export ", "", IMPORT.sub("", own), flags=re.M)
        for name in (name for line in TOP.findall(own) for name in DECLARED.findall(line)):
            if names.setdefault(name, file) != file:
                raise SystemExit(f"{name} is in {names[name]} and in {file}")
        text += own
    if "</script" in text:
        raise SystemExit("a script holds </script")
    return '(() => {\n"use strict";\n' + text + "})();\n"


def page(folder, module):
    parts = {
        "style": (folder / "style.css").read_text(),
        "main": script(folder, "main.js"),
        "worker": script(folder, "worker.js"),
        "wasm": base64.b64encode(module).decode(),
    }
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found[1]], (folder / "page.html").read_text())


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description="Puts the page into one file.")
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("module", type=pathlib.Path)
    parser.add_argument("-o", dest="output", type=pathlib.Path, required=True)
    given = parser.parse_args()
    given.output.write_text(page(given.folder, given.module.read_bytes()))
