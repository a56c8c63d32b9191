# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""musurf's materials in Mitsuba 3.

    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")
    import musurf_mitsuba

    scene = mi.load_dict({..., "bsdf": {"type": "musurf", "ndf": "gtr", "alpha": 0.1, "gamma": 1.5, "transform": "5 0 0 1"}})
    with musurf_mitsuba.evaluated():
        image = mi.render(scene)

Importing it registers the BSDF "musurf" for the current variant and those set later."""
import contextlib

import drjit as dr
import mitsuba as mi

from . import bsdf

NEWEST_BAD_LLVM = 16  # has no code for Dr.Jit's minima and maxima on x86, and ends the process over them
registered = set()


@contextlib.contextmanager
def evaluated():
    """Loops, calls and conditionals run on values instead of being recorded: what musurf shades."""
    with contextlib.ExitStack() as stack:
        for name in ("SymbolicLoops", "SymbolicCalls", "SymbolicConditionals"):
            stack.enter_context(dr.scoped_set_flag(getattr(dr.JitFlag, name), False))
        yield


def obstacle(variant):
    """Why musurf cannot work in this variant; None if it can."""
    if not (variant.startswith("llvm_") and variant.endswith("_rgb")):
        return (f"musurf: works in Mitsuba's variant llvm_ad_rgb, not in {variant}: a plugin shades red, green and blue of whole "
                "wavefronts in the processor's memory")
    version = dr.detail.llvm_version()
    if version and version[0] <= NEWEST_BAD_LLVM:
        return (f"musurf: Dr.Jit uses LLVM {version[0]}, which cannot compile what this Mitsuba needs on x86: install LLVM 17 or later (Debian's "
                "libllvm19), or name one in DRJIT_LIBLLVM_PATH")
    return None


def register(_=None, variant=None):
    variant = variant or mi.variant()
    if not variant or variant in registered:
        return
    registered.add(variant)
    kept = {}

    def construct(props):
        why = obstacle(variant)
        if why:
            bsdf.refuse(mi, why)
        if "class" not in kept:
            kept["class"] = bsdf.make(mi)
        return kept["class"](props)

    mi.register_bsdf("musurf", construct)


mi.detail.add_variant_callback(register)
register()
