# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A property group made of a parameter table (table.py) as the material of a scene file, which nests what has dots.

What belongs to a choice ("fresnel.schlick") counts while that is chosen, and then always; other numbers while their check mark is
set. What the file has and the plugin has not is said by name, and left out."""
from . import table


def chosen(group, parameter, say):
    found = getattr(group, table.key(parameter["name"]))
    if not found:
        say(f"{parameter['name']}: what was chosen is not known to this plugin; it is {parameter['default']} now")
        return parameter["default"]
    return found


def stored(group):
    """Names of what the file has of the group."""
    own = group.bl_system_properties_get() if hasattr(group, "bl_system_properties_get") else group  # apart from Blender 5 on
    return list(own.keys()) if own else []


def nested(values, kind):
    if kind == "number":
        return values[0]
    rows = {"matrix": 2, "matrix3": 3}.get(kind)
    return [values[i:i + rows] for i in range(0, len(values), rows)] if rows else values


class Writer:
    def __init__(self, group, path_of, say):
        self.group, self.path_of, self.say = group, path_of, say
        self.by_name = {p["name"]: p for p in group.table["parameters"]}

    def below(self, name):
        start = name + "."
        return sorted({other[len(start):].split(".")[0] for other in self.by_name if other.startswith(start)})

    def leaf(self, parameter):
        name, kind = table.key(parameter["name"]), parameter["kind"]
        if kind == "choice":
            return chosen(self.group, parameter, self.say)
        found = getattr(self.group, name)
        if kind == "flag":
            return bool(found)
        image = getattr(self.group, "image_" + name, None)
        if image:
            path = self.path_of(image)
            if path:
                return {"texture": path, "colour_space": "srgb" if image.colorspace_settings.name == "sRGB" else "raw"}
            self.say(f"{parameter['name']}: the image \"{image.name}\" has no file: save it or pack it; the number stands for it")
        return nested([float(x) for x in found] if table.NUMBERS[kind] > 1 else [float(found)], kind)

    def is_set(self, parameter):
        if not table.is_known(parameter):
            return False
        if parameter["kind"] in ("choice", "flag"):
            return self.leaf(parameter) != parameter["default"]
        name = table.key(parameter["name"])
        return getattr(self.group, "use_" + name) or getattr(self.group, "image_" + name, None) is not None

    def node(self, name, asked=False):
        """What stands for `name`, or None; asked: a choice has named it."""
        parameter = self.by_name.get(name)
        choices = parameter["choices"] if parameter and parameter["kind"] == "choice" else []
        word = self.leaf(parameter) if choices else None
        inner = {}
        for last in self.below(name):
            if last in choices and last != word:
                continue
            found = self.node(f"{name}.{last}", asked=last == word)
            if found is not None:
                inner[last] = found
        if inner:
            return inner
        if parameter and table.is_known(parameter) and (asked or self.is_set(parameter)):
            return self.leaf(parameter)
        return None

    def all(self):
        known = {name for p in self.group.table["parameters"] for name, _ in table.properties(p)}
        for name in stored(self.group):
            if name not in known:
                self.say(f"{self.group.table['id']} has no parameter \"{name}\" any more; it is left out")
        for parameter in self.group.table["parameters"]:
            if not table.is_known(parameter) and parameter["kind"] not in table.LEFT_TO_THE_RENDERER | table.BY_FILE:
                self.say(f"{parameter['name']}: is of a kind, {parameter['kind']}, that this add-on is too old for; it keeps its default")
        tops = dict.fromkeys(name.split(".")[0] for name in self.by_name)
        return {"material": self.group.table["id"],
                **{name: found for name, found in ((name, self.node(name)) for name in tops) if found is not None}}


def write(group, path_of, say):
    """The scene file's object. path_of(image): its file or None; say(text): a line for the log."""
    return Writer(group, path_of, say).all()
