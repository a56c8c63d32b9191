# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A plugin's parameter table, and the names that a host gives its parameters: a host that has no dots in names writes
"fresnel_conductor" for "fresnel.conductor", and "transform_0" to "transform_3" for the numbers of one that has several."""
import ctypes
import difflib
from dataclasses import dataclass

from . import abi
from .plugins import PluginError, covers


@dataclass(frozen=True)
class Parameter:
    id: int
    name: str     # the plugin's
    key: str      # the host's
    doc: str
    kind: int
    flags: int
    initial: tuple
    choices: tuple

    @property
    def count(self):
        """How many numbers it has; 0 if that is not for the kind to say."""
        return abi.NUMBERS.get(self.kind, 0)

    @property
    def may_vary(self):
        return bool(self.flags & abi.MAY_VARY)

    @property
    def has_default(self):
        return not self.flags & abi.NO_DEFAULT and self.kind in abi.NUMBERS and self.count <= 4

    def keys(self):
        """Of its numbers, one by one: a host's texture gives one number, or a color."""
        return [f"{self.key}_{i}" for i in range(self.count)] if self.count > 1 and self.kind != abi.COLOR else []


def read_one(p, type_id):
    if not covers(p, "choices"):
        raise PluginError(f"a parameter of {type_id} is {p.size} bytes long; at least {ctypes.sizeof(abi.Param)} are needed: the "
                          "plugin is older than version 1.0 of the interface")
    if not p.name or p.id == 0:
        raise PluginError(f"parameter {p.id} of {type_id} lacks its name or id")
    choices = []
    if p.kind == abi.CHOICE:
        if not p.choices:
            raise PluginError(f"parameter \"{p.name.decode()}\" of {type_id} lacks its choices")
        while p.choices[len(choices)]:
            choices.append(p.choices[len(choices)].decode())
    return Parameter(p.id, p.name.decode(), p.name.decode().replace(".", "_"), (p.doc or b"").decode(), p.kind, p.flags,
                     tuple(p.initial), tuple(choices))


class Table:
    """The parameters of a material type, by the plugin's names and by the host's."""

    def __init__(self, material_type):
        t = material_type.contents
        self.type_id = t.id.decode()
        stride = ctypes.cast(t.params, ctypes.POINTER(abi.Param)).contents.size if t.param_count else 0
        self.parameters = [read_one(abi.Param.from_address(t.params + i * stride), self.type_id) for i in range(t.param_count)]
        self.by_name = {p.name: p for p in self.parameters}
        self.by_id = {p.id: p for p in self.parameters}
        self.by_key = {}  # key: parameter, and which of its numbers, or None for all
        for p in self.parameters:
            for key, which in [(p.key, None)] + [(key, i) for i, key in enumerate(p.keys())]:
                if key in self.by_key:
                    raise PluginError(f"\"{key}\" would name both {self.by_key[key][0].name} and {p.name} of {self.type_id}")
                self.by_key[key] = (p, which)

    def find(self, key):
        """(parameter, number or None) of a host's name. KeyError with a hint if there is none: renamed, or misspelt."""
        if key in self.by_key:
            return self.by_key[key]
        near = difflib.get_close_matches(key, self.by_key, n=1)
        hint = f"; did you mean \"{near[0]}\"?" if near else f"; it has {', '.join(p.key for p in self.parameters)}"
        raise KeyError(f"{self.type_id} has no parameter \"{key}\"{hint}")
