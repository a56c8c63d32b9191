# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""musurf_plugin.h and wavefront.h as ctypes see them: the records, ids and flags that a host in Python needs, in the
headers' order. A test compares every offset with what a C compiler says. No host is known here, and no material."""
import ctypes as c

MAJOR, MINOR, ENTRY = 1, 0, "musurf_plugin_v1"
OK, INVALID, NO_MEMORY, UNSUPPORTED = range(4)
INFO, WARNING, ERROR = range(3)
NUMBER, COLOR, MATRIX, CHOICE, FLAG, VECTOR, MATRIX3, GRID, FOOTPRINT = range(1, 10)
MAY_VARY, MIN_EXCLUDED, MAX_EXCLUDED, NO_DEFAULT = 1, 2, 4, 8
CONSTANT, SLOT = range(2)
GLOSSY_REFLECTION, DELTA_REFLECTION, GLOSSY_TRANSMISSION, DELTA_TRANSMISSION, DIFFUSE_REFLECTION, DIFFUSE_TRANSMISSION = (
    1 << bit for bit in range(6))
ALL_LOBES, IMPORTANCE = 0xffffffff, 1
NEEDS_TANGENT, NEEDS_SLOTS, NEEDS_FOOTPRINT = 1, 2, 4

# How many numbers a kind has; of a grid its setting tells.
NUMBERS = {NUMBER: 1, COLOR: 3, MATRIX: 4, FLAG: 1, VECTOR: 2, MATRIX3: 9, FOOTPRINT: 6}

u32, size, address, text = c.c_uint32, c.c_size_t, c.c_void_p, c.c_char_p
MESSAGE = c.CFUNCTYPE(None, address, c.c_int32, u32, text)


class Host(c.Structure):
    _fields_ = [("size", u32), ("abi_minor", u32), ("context", address), ("message", MESSAGE), ("allocate", address),
                ("release", address)]


class Param(c.Structure):
    _fields_ = [("size", u32), ("id", u32), ("name", text), ("label", text), ("doc", text), ("unit", text), ("kind", u32),
                ("flags", u32), ("min", c.c_double), ("max", c.c_double), ("soft_min", c.c_double),
                ("soft_max", c.c_double), ("initial", c.c_double * 4), ("initial_choice", text), ("choices", c.POINTER(text))]


class Setting(c.Structure):
    _fields_ = [("size", u32), ("param", u32), ("source", u32), ("slot", u32), ("values", c.POINTER(c.c_double)),
                ("text", text), ("count", size)]


class Plan(c.Structure):
    _fields_ = [("size", u32), ("closure_bytes", u32), ("closure_alignment", u32), ("lobes", u32), ("needs", u32),
                ("slot_floats", u32), ("table_bytes", u32), ("material_bytes", u32), ("name", text), ("left_out", text),
                ("sampler", text)]


COMPILE = c.CFUNCTYPE(c.c_int32, c.POINTER(Host), c.POINTER(Setting), size, c.POINTER(address))
RELEASE = c.CFUNCTYPE(None, address)
DESCRIBE = c.CFUNCTYPE(None, address, c.POINTER(Plan))


class MaterialType(c.Structure):
    """What shades stands here as addresses: wavefront.c calls it, Python never does."""
    _fields_ = [("size", u32), ("param_count", u32), ("id", text), ("label", text), ("doc", text), ("params", address),
                ("compile", COMPILE), ("release", RELEASE), ("describe", DESCRIBE)] + [
                    (name, address) for name in ("setup", "eval", "sample", "pdf", "albedo", "blur", "eval_batch",
                                                 "sample_batch", "extension")]


class Plugin(c.Structure):
    _fields_ = [("size", u32), ("abi_minor", u32), ("name", text), ("version", text), ("license", text),
                ("type_count", size), ("types", c.POINTER(c.POINTER(MaterialType)))]


class Column(c.Structure):
    _fields_ = [("data", address), ("step", size)]


class Wavefront(c.Structure):
    _fields_ = [("type", c.POINTER(MaterialType)), ("material", address), ("count", size), ("wo", Column * 3),
                ("active", address), ("active_step", size), ("slots", c.POINTER(Column)), ("slot_floats", u32),
                ("closure_bytes", u32), ("closure_alignment", u32), ("mode", u32), ("lobes", u32), ("threads", u32)]


class Values(c.Structure):
    _fields_ = [("f", address * 3), ("pdf", address)]


class Samples(c.Structure):
    _fields_ = [("wi", address * 3), ("weight", address * 3), ("pdf", address), ("eta", address), ("lobe", address)]
