# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Dr.Jit's arrays to wavefront.c and back, without a copy: an evaluated array of the LLVM backend is plain memory, and what
the plugin answers is written into arrays that Dr.Jit made. No ray is touched by Python.

Arrays that are still recorded are evaluated here, all at once; inside a symbolic loop or call there are no values yet, and
nothing can be shaded: is_symbolic() tells."""
import ctypes

import drjit as dr

from . import abi
from .plugins import PluginError, find, open_library

THREADS = 0  # at most; 0: as many as Dr.Jit's own


def library():
    """wavefront.c as a shared object; the same each time."""
    if not hasattr(library, "found"):
        found = open_library(find("musurf_wavefront.so"))
        for name in ("musurf_wavefront_eval", "musurf_wavefront_sample"):
            getattr(found, name).argtypes = [ctypes.c_void_p] * 3
            getattr(found, name).restype = None
        library.found = found
    return library.found


def check(plan, name):
    """Whether there is room for what the plan of a material asks for."""
    closure, slots = library().musurf_wavefront_closure_limit(), library().musurf_wavefront_slot_limit()
    if plan.closure_bytes > closure or plan.slot_floats > slots:
        raise PluginError(f"{name}: asks for closures of {plan.closure_bytes} bytes and {plan.slot_floats} slots; at most {closure} and "
                          f"{slots} are possible")


def is_symbolic():
    return bool(dr.flag(dr.JitFlag.SymbolicScope))


class Arrays:
    """The evaluated arrays of one call; they live until it is over."""

    def __init__(self, *arrays):
        self.kept = [dr.detach(array) for array in arrays]
        dr.eval(self.kept)
        dr.sync_thread()

    def count(self):
        """How many hits there are: what has one element serves all."""
        lengths = {len(array) for array in self.kept}
        if len(lengths - {1}) > 1:
            raise RuntimeError(f"musurf: arrays of incompatible sizes: {', '.join(map(str, sorted(lengths)))}")
        return min(lengths) if 0 in lengths else max(lengths)

    def memory(self, array):
        """Address and step of an evaluated array; one element serves all."""
        view = array.numpy()
        self.kept.append(view)
        return view.ctypes.data, 0 if len(array) == 1 else 1

    def column(self, array):
        return abi.Column(*self.memory(array))

    def columns(self, arrays):
        return (abi.Column * len(arrays))(*[self.column(array) for array in arrays])


def outputs(Float, count, number):
    """`number` arrays to be written into, and their addresses."""
    arrays = [dr.empty(Float, count) for _ in range(number)]
    dr.eval(arrays)
    return arrays, [array.numpy().ctypes.data for array in arrays]


def describe(material, arrays, count, wo, active, slots, mode, lobes):
    w = abi.Wavefront(type=material.type, material=material.handle, count=count, wo=arrays.columns(wo), slots=None,
                      closure_bytes=material.plan.closure_bytes, closure_alignment=material.plan.closure_alignment, mode=mode,
                      lobes=lobes, threads=THREADS or max(1, dr.thread_count()))
    w.active, w.active_step = arrays.memory(active)
    if slots:
        columns = arrays.columns(slots)
        arrays.kept.append(columns)
        w.slots, w.slot_floats = ctypes.cast(columns, ctypes.POINTER(abi.Column)), len(slots)
    return w


def evaluate(Float, material, wo, wi, active, slots, mode, lobes):
    """[f_r, f_g, f_b, pdf] toward wi; wo, wi and slots are lists of arrays."""
    arrays = Arrays(*wo, *wi, *slots, active)
    n = len(wo)
    wo, wi, slots, active = arrays.kept[:n], arrays.kept[n:2 * n], arrays.kept[2 * n:-1], arrays.kept[-1]
    count = arrays.count()
    if count == 0:
        return [dr.zeros(Float, 0) for _ in range(4)]
    w = describe(material, arrays, count, wo, active, slots, mode, lobes)
    found, at = outputs(Float, count, 4)
    out = abi.Values((ctypes.c_void_p * 3)(*at[:3]), at[3])
    library().musurf_wavefront_eval(ctypes.byref(w), arrays.columns(wi), ctypes.byref(out))
    return found


def sample(Float, UInt32, material, wo, u, active, slots, mode, lobes):
    """[wi_x, wi_y, wi_z, weight_r, weight_g, weight_b, pdf, eta] and the lobe."""
    arrays = Arrays(*wo, *u, *slots, active)
    n = len(wo)
    wo, u, slots, active = arrays.kept[:n], arrays.kept[n:2 * n], arrays.kept[2 * n:-1], arrays.kept[-1]
    count = arrays.count()
    if count == 0:
        return [dr.zeros(Float, 0) for _ in range(8)], dr.zeros(UInt32, 0)
    w = describe(material, arrays, count, wo, active, slots, mode, lobes)
    found, at = outputs(Float, count, 8)
    (lobe,), (lobe_at,) = outputs(UInt32, count, 1)
    out = abi.Samples((ctypes.c_void_p * 3)(*at[:3]), (ctypes.c_void_p * 3)(*at[3:6]), at[6], at[7], lobe_at)
    library().musurf_wavefront_sample(ctypes.byref(w), arrays.columns(u), ctypes.byref(out))
    return found, lobe
