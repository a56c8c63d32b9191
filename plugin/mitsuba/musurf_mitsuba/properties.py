# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Mitsuba's properties (XML or dict) to values by parameter name, and textures to slots.

Numbers come as Mitsuba has them: floats, integers, booleans, colors, vectors, tensors; several also as text, "5 0 0 1", and the
linear map as a transform, of which the tangent plane's part counts. A texture gives the number, or the color, of a parameter that may vary; of one
that has several numbers, each may be given by itself ("transform_0"), as a number or as a texture."""
import difflib
import re

import drjit as dr
import numpy as np

from . import abi, material_file
from .table import Table

OWN = ("material", "file", "plugin")
UNIFORM = ("UniformSpectrum", "SRGBReflectanceSpectrum")  # is_spatially_varying() says the same of mesh attributes, which do vary


class PropertyError(Exception):
    """In one line, which property is wrong and how."""


def linear_part(matrix, p):
    """The 2x2 or 3x3 part that is the parameter; the rest must be that of an identity."""
    size = {abi.MATRIX: 2, abi.MATRIX3: 3}.get(p.kind)
    matrix = np.array(matrix, dtype=float)
    if size is None:
        raise PropertyError(f"{p.key}: takes no transform")
    rest = matrix - np.eye(len(matrix))
    rest[:size, :size] = 0
    if np.any(rest != 0):
        raise PropertyError(f"{p.key}: of this transform only the upper {size} x {size} numbers can be used, and others are set: it "
                            "maps positions of the tangent plane, and neither moves nor lifts them")
    return matrix[:size, :size].ravel().tolist()


def numbers_of(p, value):
    """What Mitsuba holds under a name, as numbers; None if it is something else."""
    if isinstance(value, (bool, int, float)):
        return [float(value)]
    if isinstance(value, str):
        words = [word for word in re.split(r"[\s,]+", value) if word]
        try:
            return [float(word) for word in words]
        except ValueError:
            return None
    if isinstance(value, dr.ArrayBase):  # colors and vectors; every array of Dr.Jit has a "matrix" to offer, as transforms have
        return np.array(value, dtype=float).ravel().tolist()
    if hasattr(value, "matrix"):
        return linear_part(value.matrix, p)
    if hasattr(value, "wavelengths"):
        if not value.is_uniform():
            raise PropertyError(f"{p.key}: takes red, green and blue, not a spectrum over wavelengths")
        return [float(value.values[0])]
    try:
        return np.array(value, dtype=float).ravel().tolist()
    except (TypeError, ValueError):
        return None


def value_of(p, value, count):
    """`count` numbers, or the word of a choice."""
    if p.kind == abi.CHOICE:
        if not isinstance(value, str):
            raise PropertyError(f"{p.key}: takes a word: {', '.join(p.choices)}")
        return value
    if p.kind == abi.GRID:
        raise PropertyError(f"{p.key}: is a grid of numbers, which a material file can give (\"file\")")
    if p.kind not in abi.NUMBERS:
        raise PropertyError(f"{p.key}: this host is older than the plugin and cannot set a parameter of kind {p.kind}")
    numbers = numbers_of(p, value)
    if numbers is not None and p.kind == abi.COLOR and len(numbers) == 1:
        numbers *= 3
    if numbers is None or len(numbers) != count:
        raise PropertyError(f"{p.key}: takes {count} number{'s' if count > 1 else ''}, not {str(value)[:60]!r}")
    return numbers


class Properties:
    """values: numbers or a word by parameter name. parts: by parameter name, what stands for each of its numbers: a number or a
    texture; of a color one texture for all three."""

    def __init__(self, mi, props, table, document, path):
        self.mi, self.table = mi, table
        self.values = material_file.values_of(table, document, path) if document else {}
        self.parts = {}
        given = {key.replace(".", "_"): props[key] for key in props.keys() if key not in OWN}
        for key in sorted(given, key=lambda key: self.find(key)[1] is not None):  # whole parameters before their numbers
            p, which = self.find(key)
            self.take(p, which, given[key])
        for name, parts in list(self.parts.items()):
            if not any(self.is_texture(part) for part in parts):
                self.values[name] = parts
                del self.parts[name]

    def find(self, key):
        try:
            return self.table.find(key)
        except KeyError as why:
            raise PropertyError(why.args[0]) from None

    def is_texture(self, value):
        return isinstance(value, self.mi.Texture)

    def take(self, p, which, value):
        textured = self.is_texture(value)
        if isinstance(value, self.mi.Object) and not textured:
            raise PropertyError(f"{p.key}: takes numbers, a word or a texture, not a {type(value).__name__}")
        if textured and value.class_name() in UNIFORM:
            value, textured = self.constant(p, value), False
        if textured and not p.may_vary:
            able = ", ".join(q.key for q in self.table.parameters if q.may_vary)
            raise PropertyError(f"{p.key}: cannot be textured: {self.table.type_id} takes it once for the whole surface; what may vary: {able}")
        if textured and which is None and p.kind not in (abi.NUMBER, abi.FLAG, abi.COLOR):
            raise PropertyError(f"{p.key}: has {p.count} numbers, and a texture gives one: texture {', '.join(p.keys())}")
        if which is not None:
            start = self.values.get(p.name, list(p.initial[:p.count]) + [0.0] * (p.count - 4))
            parts = self.parts.setdefault(p.name, list(start))
            parts[which] = value if textured else value_of(p, value, 1)[0]
        elif textured:
            self.parts[p.name] = [value]
            self.values.pop(p.name, None)
        else:
            self.values[p.name] = value_of(p, value, p.count)

    def constant(self, p, texture):
        si = dr.zeros(self.mi.SurfaceInteraction3f, 1)
        found = texture.eval(si) if p.kind == abi.COLOR else texture.eval_1(si)
        return [float(np.ravel(np.array(x))[0]) for x in found] if p.kind == abi.COLOR else float(np.ravel(np.array(found))[0])

    def settings(self):
        """What to compile: what varies comes from slots, one after the other; and how many floats those are."""
        found, slot = {name: value for name, value in self.values.items() if name not in self.parts}, 0
        for name in self.parts:
            found[name] = ("slot", slot)
            slot += self.table.by_name[name].count
        return found

    def slots(self, si, active):
        """A column per slot, still recorded."""
        columns = []
        for name, parts in self.parts.items():
            color = self.table.by_name[name].kind == abi.COLOR
            for part in parts:
                if not self.is_texture(part):
                    columns.append(self.mi.Float(part))
                elif color:
                    columns += list(part.eval(si, active))
                else:
                    columns.append(part.eval_1(si, active))
        return columns


def read(mi, props, open_type):
    """(type pointer, Properties) of the properties of a BSDF; `open_type(name, path)` finds the plugin."""
    for key in OWN:
        if not isinstance(props.get(key, ""), str):
            raise PropertyError(f"{key}: takes text, not {str(props[key])[:60]!r}")
    path = props.get("file", None)
    document = material_file.read(resolve(mi, path)) if path is not None else None
    name = props.get("material", None)
    if document and name is not None and name != document["material"]:
        raise PropertyError(f"material: is \"{name}\", but the file {path} holds a {document['material']}")
    name = document["material"] if document else name or "musurf.microfacet"
    pointer = open_type(name, props.get("plugin", None))
    table = Table(pointer)
    clash = [key for key in OWN if key in table.by_key]
    if clash:
        raise PropertyError(f"{table.type_id}: its parameter \"{clash[0]}\" has a name that this host needs itself")
    return pointer, Properties(mi, props, table, document, path)


def resolve(mi, path):
    """A path as Mitsuba finds files: beside the scene, or where its resolver looks."""
    return str(mi.file_resolver().resolve(str(path)))
