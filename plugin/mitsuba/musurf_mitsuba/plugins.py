# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Finds and opens shared objects of materials. "vendor.name" is looked for in vendor_material.so: in the directories of
$MUSURF_PLUGIN_PATH, then beside this package as installed, then in the build folder of the source tree. The first file of that
name is taken; one that cannot be used is an error, not a reason to look further. A plugin is somebody else's program: before
anything of it is used, its tables are looked through as the renderer of musurf does (core/render/plugin_check.c)."""
import ctypes
import os
import pathlib
import re

from . import abi

HERE = pathlib.Path(__file__).resolve().parent
opened = {}  # by path: what dlopen gave stays as long as the process


class PluginError(Exception):
    """In one line, what is wrong with which file."""


def directories():
    named = [pathlib.Path(part) for part in os.environ.get("MUSURF_PLUGIN_PATH", "").split(":") if part]
    return named + [HERE.parent.parent, HERE.parent.parent.parent / "build"]


def find(file):
    """The first path of that name."""
    for directory in directories():
        if (directory / file).exists():
            return directory / file
    raise PluginError(f"there is no {file} in {', '.join(map(str, directories()))}; MUSURF_PLUGIN_PATH can name other directories")


def open_library(path):
    try:
        return ctypes.CDLL(str(path), mode=os.RTLD_NOW | os.RTLD_LOCAL)
    except OSError as why:
        reason = str(why)
        raise PluginError(f"{path}: cannot be opened: {reason.removeprefix(f'{path}:').strip()}") from None


def covers(record, last):
    """Whether a plugin's record, by its own size, reaches to the end of the field `last`."""
    field = getattr(type(record), last)
    return record.size >= field.offset + field.size


def entry_of(path):
    library = open_library(path)
    try:
        entry = getattr(library, abi.ENTRY)
    except AttributeError:
        raise PluginError(f"{path}: exports no {abi.ENTRY}: no musurf plugin, or one for another major version than "
                          f"{abi.MAJOR}") from None
    entry.restype = ctypes.POINTER(abi.Plugin)
    found = entry()
    if not found:
        raise PluginError(f"{path}: {abi.ENTRY} returned NULL")
    return found.contents


def check_type(t, vendor, path):
    if not covers(t, "extension"):
        raise PluginError(f"{path}: a material type is {t.size} bytes long; at least {abi.MaterialType.extension.offset + 8} "
                          "are needed: the plugin is older than version 1.0 of the interface")
    if not (t.id or b"").startswith(vendor.encode() + b"."):
        raise PluginError(f"{path}: material type \"{(t.id or b'').decode(errors='replace')}\" is not of the vendor \"{vendor}\"")
    if not all((t.compile, t.release, t.describe, t.setup, t.eval_batch, t.sample_batch)):
        raise PluginError(f"{path}: {t.id.decode()} lacks one of its functions")


def plugin_of(path, vendor):
    if path not in opened:
        plugin = entry_of(path)
        if not covers(plugin, "types") or not plugin.types or plugin.type_count == 0:
            raise PluginError(f"{path}: its plugin table is {plugin.size} bytes long and has {plugin.type_count} material types; "
                              "the plugin is older than version 1.0 of the interface, or broken")
        for i in range(plugin.type_count):
            if not plugin.types[i]:
                raise PluginError(f"{path}: one of its material types is NULL")
            check_type(plugin.types[i].contents, vendor, path)
        opened[path] = plugin
    return opened[path]


def material_type(name, path=None):
    """The pointer to the material type "vendor.name", of the plugin at `path` or the first that is found."""
    match = re.fullmatch(r"([A-Za-z0-9_-]{1,64})\.(.+)", name)
    if not match:
        raise PluginError(f"\"{name}\" does not name a material; \"vendor.name\" is needed, e.g. \"musurf.microfacet\"")
    vendor = match[1]
    path = pathlib.Path(path) if path else find(f"{vendor}_material.so")
    plugin = plugin_of(path.resolve(), vendor)
    for i in range(plugin.type_count):
        if plugin.types[i].contents.id.decode() == name:
            return plugin.types[i]
    offered = ", ".join(plugin.types[i].contents.id.decode() for i in range(plugin.type_count))
    raise PluginError(f"\"{name}\" is not in {path}; it offers {offered}")
