# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Blender properties made of a plugin's parameter table: a property group per material type.

A parameter "fresnel.schlick" becomes the property fresnel_schlick. Numbers have a check mark beside them, use_NAME: without it the material
keeps the plugin's default. What may vary has an image beside it, image_NAME. Choices are stored by a hash of their word, not by
their place in the list, which another version of the plugin may have moved."""
import zlib

import bpy

NUMBERS = {"number": 1, "color": 3, "matrix": 4, "vector": 2, "matrix3": 9}
LEFT_TO_THE_RENDERER = {"footprint"}  # set at each hit
BY_FILE = {"grid"}                    # histograms: by a material file


def key(name):
    return name.replace(".", "_")


def flat(value):
    return [number for part in value for number in flat(part)] if isinstance(value, list) else [0.0 if value is None else float(value)]


def is_known(parameter):
    return parameter["kind"] in NUMBERS or parameter["kind"] in ("choice", "flag")


def has_image(parameter):
    return parameter["may_vary"] and parameter["kind"] in NUMBERS


def initial(parameter):
    count, found = NUMBERS[parameter["kind"]], parameter["default"]
    if found is not None:
        return flat(found)
    return [0.3] if count == 1 else [float(i % 4 == 0) for i in range(9)] if count == 9 else [0.0] * count


def of_numbers(parameter):
    limits = {name: parameter[name] for name in ("min", "max", "soft_min", "soft_max") if parameter.get(name) is not None}
    count, values = NUMBERS[parameter["kind"]], initial(parameter)
    common = {"name": parameter["label"], "description": parameter["doc"], "precision": 4, **limits}
    if count == 1:
        if parameter["unit"] == "radians":
            common["subtype"] = "ANGLE"
        return bpy.props.FloatProperty(default=values[0], **common)
    if parameter["kind"] == "color":
        common["subtype"] = "COLOR"
    return bpy.props.FloatVectorProperty(size=count, default=values, **common)


def properties(parameter):
    """(name, property) for each that a parameter needs."""
    name, label, doc = key(parameter["name"]), parameter["label"], parameter["doc"]
    if parameter["kind"] == "choice":
        items = [(word, word, "", zlib.crc32(word.encode()) & 0x7fffffff) for word in parameter["choices"]]
        yield name, bpy.props.EnumProperty(name=label, description=doc, items=items, default=parameter["default"])
    elif parameter["kind"] == "flag":
        yield name, bpy.props.BoolProperty(name=label, description=doc, default=bool(parameter["default"]))
    elif parameter["kind"] in NUMBERS:
        yield name, of_numbers(parameter)
        yield "use_" + name, bpy.props.BoolProperty(name=label, description="Set it; else it keeps the default of the plugin", default=False)
    if has_image(parameter):
        yield "image_" + name, bpy.props.PointerProperty(type=bpy.types.Image, name=label + " (image)",
                                                         description="Values over the texture square instead of one")


def group(table):
    """The property group class of a parameter table; its `table` is that."""
    made = {name: one for parameter in table["parameters"] for name, one in properties(parameter)}
    return type("MUSURF_PG_" + key(table["id"]), (bpy.types.PropertyGroup,), {"__annotations__": made, "table": table})
