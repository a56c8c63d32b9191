# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A material file, as scene files of musurf have them, as values by parameter name:

    {"material": "musurf.microfacet", "ndf": "gtr", "transform": [[5, 0], [0, 1]], "fresnel": {"conductor": "Au"}}

gives ("musurf.microfacet", {"ndf": "gtr", "transform": [5, 0, 0, 1], "fresnel": "conductor", "fresnel.conductor": "Au"}). The
rules are those of core/render/material_settings.c, and know no material, only its table. What a parameter may be is for the
plugin to judge."""
import json

from . import abi


class FileError(Exception):
    """In one line: file, JSON path, what is wrong."""


def unique(pairs):
    found = dict(pairs)
    if len(found) < len(pairs):
        raise ValueError("a key stands twice")
    return found


def read(path):
    """The JSON object in the file."""
    try:
        with open(path, encoding="utf-8-sig") as file:
            found = json.load(file, object_pairs_hook=unique, parse_int=float)  # what is too large for a number is not finite then
    except OSError as why:
        raise FileError(f"{path}: cannot be opened: {why.strerror}") from None
    except (ValueError, RecursionError) as why:
        raise FileError(f"{path}: is no JSON: {why}") from None
    if not isinstance(found, dict) or not isinstance(found.get("material"), str):
        raise FileError(f"{path}: $: is no material: {{\"material\": \"musurf.microfacet\", ...}} is needed")
    return found


def is_number(x):
    return isinstance(x, (int, float)) and not isinstance(x, bool)


def flat(value):
    """The numbers of nested lists, row by row; None if anything else is in them."""
    if is_number(value):
        return [float(value)]
    if not isinstance(value, list):
        return None
    parts = [flat(part) for part in value]
    return None if None in parts else [x for part in parts for x in part]


def grid(value, where):
    """Columns, rows, bounds and cells of {"bounds": ..., "weights": ...}."""
    if not isinstance(value, dict) or "weights" not in value or "bounds" not in value:
        raise FileError(f"{where}: this host reads grids with their weights in the file, {{\"bounds\": [x_min, x_max, y_min, y_max], "
                        "\"weights\": [[...], ...]}, not from images or heightfields")
    rows, bounds = value["weights"], flat(value["bounds"])
    good = isinstance(rows, list) and rows and all(isinstance(row, list) and len(row) == len(rows[0]) for row in rows)
    cells = flat(rows) if good else None
    if cells is None or bounds is None or len(bounds) != 4:
        raise FileError(f"{where}: weights are rows of numbers, all of one length, and bounds four numbers")
    return [len(rows[0]), len(rows), *bounds, *cells]


def plain(p, value, where):
    if p.kind == abi.GRID:
        return grid(value, where)
    if isinstance(value, dict) and p.may_vary:
        keys = ", ".join(f"\"{key}\"" for key in p.keys()) or f"\"{p.key}\""
        raise FileError(f"{where}: pictures and formulas in a file are for musurf's own renderer; this host takes its own textures, as {keys} beside "
                        "\"file\"")
    if p.kind == abi.CHOICE:
        if not isinstance(value, str):
            raise FileError(f"{where}: takes a word: {', '.join(p.choices)}")
        return value
    if p.kind == abi.FLAG:
        if not isinstance(value, bool):
            raise FileError(f"{where}: is true or false")
        return [float(value)]
    if p.kind not in abi.NUMBERS:
        raise FileError(f"{where}: this host is older than the plugin and cannot set a parameter of kind {p.kind}")
    numbers = flat(value)
    if numbers is not None and p.kind == abi.COLOR and is_number(value):
        numbers *= 3
    if numbers is None or len(numbers) != p.count:
        raise FileError(f"{where}: takes {p.count} number{'s' if p.count > 1 else ''}")
    return numbers


class Reader:
    def __init__(self, table, path):
        self.table, self.path, self.values = table, path, {}

    def where(self, name):
        return f"{self.path}: $.{name}"

    def has_below(self, name):
        return any(other.startswith(name + ".") for other in self.table.by_name)

    def member(self, name, value):
        p = self.table.by_name.get(name)
        if isinstance(value, dict) and self.has_below(name):
            if p and p.kind == abi.CHOICE:
                self.choose(p, value)
            for key, inner in value.items():
                if not (p and key in p.choices and f"{name}.{key}" not in self.table.by_name and not self.has_below(f"{name}.{key}")):
                    self.member(f"{name}.{key}", inner)
        elif p:
            self.values[name] = plain(p, value, self.where(name))
        else:
            try:
                self.table.find(name.replace(".", "_"))
            except KeyError as why:
                raise FileError(f"{self.where(name)}: {why.args[0]}") from None
            raise FileError(f"{self.where(name)}: {self.table.type_id} has no parameter \"{name}\"")

    def choose(self, p, value):
        """{"conductor": ...} under a choice: the key is the choice."""
        chosen = [key for key in value if key in p.choices]
        if len(chosen) > 1:
            raise FileError(f"{self.where(p.name)}: only one can be chosen, not {' and '.join(chosen)}")
        if chosen:
            self.values[p.name] = chosen[0]


def values_of(table, document, path):
    """The values of the file's object by parameter name."""
    if "jacobian" in document:
        raise FileError(f"{path}: $.jacobian: is for musurf's own renderer; this host takes textures for the numbers of \"transform\"")
    if "normal_map" in document:
        raise FileError(f"{path}: $.normal_map: is for musurf's own renderer; this host has normal maps of its own")
    reader = Reader(table, path)
    for name, value in document.items():
        if name not in ("material", "$schema", "description"):
            reader.member(name, value)
    return reader.values
