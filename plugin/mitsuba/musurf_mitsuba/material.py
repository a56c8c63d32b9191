# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""A compiled material: settings go in by the plugin's table, its plan comes out, and its messages become words of the host's
log. Nothing of any host is known here: `say(severity, text)` is how it is spoken to."""
import ctypes

from . import abi

KNOWN_NEEDS = abi.NEEDS_TANGENT | abi.NEEDS_SLOTS | abi.NEEDS_FOOTPRINT


class MaterialError(Exception):
    """In one line, which parameter is wrong and how."""


def setting_of(p, value, keep):
    """`value`: numbers, a word, or the first slot as ("slot", index). What it points to is put into `keep`."""
    s = abi.Setting(size=ctypes.sizeof(abi.Setting), param=p.id, source=abi.CONSTANT)
    if isinstance(value, tuple):
        s.source, s.slot = abi.SLOT, value[1]
    elif isinstance(value, str):
        s.text = value.encode()
        keep.append(s.text)
    else:
        numbers = (ctypes.c_double * len(value))(*value)
        s.values, s.count = ctypes.cast(numbers, ctypes.POINTER(ctypes.c_double)), len(value)
        keep.append(numbers)
    return s


class Material:
    """Lives as long as somebody holds it; the plugin's memory goes with it."""

    def __init__(self, pointer, table, values, say):
        self.type, self.table, self.handle = pointer, table, ctypes.c_void_p()
        t, keep, refusals = pointer.contents, [], []

        def on_message(_, severity, param, line):
            p = table.by_id.get(param)
            words = f"{table.type_id}: {p.key + ': ' if p else ''}{(line or b'').decode(errors='replace')}"
            refusals.append(words) if severity == abi.ERROR else say(severity, words)

        host = abi.Host(size=ctypes.sizeof(abi.Host), abi_minor=abi.MINOR, message=abi.MESSAGE(on_message))
        settings = [setting_of(table.by_name[name], value, keep) for name, value in values.items()]
        array = (abi.Setting * max(1, len(settings)))(*settings)
        result = t.compile(ctypes.byref(host), array, len(settings), ctypes.byref(self.handle))
        if result != abi.OK or not self.handle:
            self.handle = ctypes.c_void_p()
            raise MaterialError("; ".join(refusals) or f"{table.type_id} refused this material (result {result}) without saying why")
        self.plan = abi.Plan(size=ctypes.sizeof(abi.Plan))
        t.describe(self.handle, ctypes.byref(self.plan))
        self.check_plan()

    def check_plan(self):
        plan, name = self.plan, self.table.type_id
        unknown = plan.needs & ~KNOWN_NEEDS
        if unknown:
            raise MaterialError(f"{name}: this material needs something of its host that this one does not know (bits 0x{unknown:x}): "
                                "the plugin is newer than the host")
        alignment = plan.closure_alignment
        if alignment > 64 or alignment & (alignment - 1):
            raise MaterialError(f"{name}: asks for closures aligned to {alignment} bytes; a power of two up to 64 is possible")

    def __del__(self):
        if getattr(self, "handle", None):
            self.type.contents.release(self.handle)
            self.handle = ctypes.c_void_p()
