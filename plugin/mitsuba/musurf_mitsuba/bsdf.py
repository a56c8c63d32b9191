# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The BSDF "musurf" of Mitsuba 3: a material of a musurf plugin. Mitsuba's local frame is the plugin's (z the shading normal, x the tangent);
its si.wi, toward the camera, is the plugin's wo, and its wo the plugin's wi; values include the foreshortening in both.

One class per variant, made when Mitsuba first asks for it, for its base belongs to the variant."""
import drjit as dr
import numpy as np

from . import abi, wavefront
from .material import Material, MaterialError
from .material_file import FileError
from .plugins import PluginError, material_type
from .properties import PropertyError, read

ERRORS = (MaterialError, FileError, PluginError, PropertyError)
SYMBOLIC = ("musurf: this loop or call is being recorded, and there are no values to shade yet: musurf shades evaluated wavefronts. Render "
            "inside `with musurf_mitsuba.evaluated():`, which turns dr.JitFlag.SymbolicLoops and SymbolicCalls off. (Recorded calls go through every "
            "BSDF that is alive: drop scenes with musurf before rendering others without evaluated().)")


def lobes_of(mi):
    """Each lobe of the plugin as Mitsuba's flags."""
    f = mi.BSDFFlags
    return {abi.GLOSSY_REFLECTION: f.GlossyReflection, abi.DELTA_REFLECTION: f.DeltaReflection,
            abi.GLOSSY_TRANSMISSION: f.GlossyTransmission, abi.DELTA_TRANSMISSION: f.DeltaTransmission,
            abi.DIFFUSE_REFLECTION: f.DiffuseReflection, abi.DIFFUSE_TRANSMISSION: f.DiffuseTransmission}


def refuse(mi, text):
    """Said in Mitsuba's own log first: who raises through a renderer is wrapped in other words on the way."""
    mi.Log(mi.LogLevel.Warn, text)
    raise RuntimeError(text)


def make(mi):
    """The class for the current variant."""

    class Musurf(mi.BSDF):
        def __init__(self, props):
            mi.BSDF.__init__(self, props)
            self.warned = set()
            try:
                self.pointer, self.given = read(mi, props, material_type)
                self.compile()
            except ERRORS as why:
                refuse(mi, f"musurf: {why}")
            self.tangents_checked = False
            self.edits = {p.name: self.as_edit(p) for p in self.given.table.parameters
                          if p.name not in self.given.parts and (p.name in self.given.values or p.has_default)
                          and p.kind in abi.NUMBERS}

        # ------------------------------------------------------------------------------------------------ cold

        def say(self, severity, text):
            mi.Log(mi.LogLevel.Warn if severity == abi.WARNING else mi.LogLevel.Info, text)

        def warn_once(self, text):
            if text not in self.warned:
                self.warned.add(text)
                mi.Log(mi.LogLevel.Warn, text)

        def compile(self, values=None):
            """Makes the material; on failure the one before stays."""
            given = self.given
            settings = given.settings() if values is None else values
            sampler = given.table.by_name.get("sampler")
            if sampler and "auto" in sampler.choices:
                settings.setdefault("sampler", "auto")  # a host that renders leaves the choice to the plugin
            material = Material(self.pointer, given.table, settings, self.say)
            wavefront.check(material.plan, given.table.type_id)
            slots = sum(given.table.by_name[name].count for name in given.parts)
            if material.plan.slot_floats > slots:
                raise MaterialError(f"{given.table.type_id}: reads {material.plan.slot_floats} slots, and textures feed {slots}")
            if material.plan.needs & abi.NEEDS_FOOTPRINT:
                self.warn_once(f"{given.table.type_id}: tells details apart at the scale of a pixel, whose footprint Mitsuba's integrators do not "
                               "give: the surface looks as from afar. A constant \"footprint\" shows those of one place")
            self.material = material
            self.set_flags()

        def set_flags(self):
            plan, f = self.material.plan, mi.BSDFFlags
            through = plan.lobes & (abi.GLOSSY_TRANSMISSION | abi.DELTA_TRANSMISSION | abi.DIFFUSE_TRANSMISSION)
            always = f.FrontSide | (f.BackSide if through else 0)
            if plan.needs & abi.NEEDS_TANGENT:
                always |= f.Anisotropic
            if plan.needs & abi.NEEDS_SLOTS:
                always |= f.SpatiallyVarying
            known = lobes_of(mi)
            self.lobes = [(lobe, flag) for lobe, flag in known.items() if plan.lobes & lobe]
            transmits = abi.GLOSSY_TRANSMISSION | abi.DELTA_TRANSMISSION
            self.m_components = [int(flag | always | (f.NonSymmetric if lobe & transmits else 0)) for lobe, flag in self.lobes]
            self.m_flags = int(np.bitwise_or.reduce(self.m_components))

        def as_edit(self, p):
            value = self.given.values.get(p.name) or list(p.initial[:p.count])
            return mi.Color3f(*value) if p.kind == abi.COLOR else mi.Float(value)

        def numbers(self, name):
            return [float(x) for x in np.array(self.edits[name], dtype=float).ravel()]

        def traverse(self, callback):
            for name, value in self.edits.items():
                callback.put(self.given.table.by_name[name].key, value, mi.ParamFlags.NonDifferentiable)
            for name, parts in self.given.parts.items():
                keys = self.given.table.by_name[name].keys() or [self.given.table.by_name[name].key]
                for key, part in zip(keys, parts):
                    if isinstance(part, mi.Object):
                        callback.put(key, part, mi.ParamFlags.NonDifferentiable)

        def parameters_changed(self, keys=()):
            """What differs from what was compiled is set now. A refusal leaves the material as it was."""
            values = dict(self.given.values)
            try:
                for name in self.edits:
                    p, new = self.given.table.by_name[name], self.numbers(name)
                    if len(new) != p.count:
                        raise PropertyError(f"{p.key}: takes {p.count} number{'s' if p.count > 1 else ''}, not {len(new)}")
                    if new != [float(np.float32(x)) for x in self.given.values.get(name) or p.initial[:p.count]]:
                        values[name] = new
                if values == self.given.values:
                    return
                before, self.given.values = self.given.values, values
                try:
                    self.compile()
                except ERRORS:
                    self.given.values = before
                    raise
            except ERRORS as why:
                for name in self.edits:
                    mi.set_property(self.edits[name], self.as_edit(self.given.table.by_name[name]))
                refuse(mi, f"musurf: {why}; the material stays as it was")

        def to_string(self):
            plan = self.material.plan
            return f"musurf[{self.given.table.type_id}: {plan.name.decode()}; sampler {(plan.sampler or b'').decode()}]"

        # ------------------------------------------------------------------------------------------------- hot

        def check_tangents(self, si):
            """Once, with the first hits: a mesh without texture coordinates has tangents that nobody chose."""
            self.tangents_checked = True
            found = dr.reinterpret_array(mi.UInt32, si.shape).numpy()
            # si.shape[i] may come as a mere Shape, whose parameters tell what it is
            for index in np.unique(found, return_index=True)[1]:
                shape = si.shape[int(index)]
                of_shape = mi.traverse(shape) if shape is not None else {}
                if "faces" in of_shape and len(of_shape.get("vertex_texcoords", ())) == 0:
                    self.warn_once(f"{self.given.table.type_id}: shading depends on the tangent, and shape \"{shape.id()}\" has no texture "
                                   "coordinates to take it from: directions on it are arbitrary")

        def prepare(self, ctx, si, active):
            """(columns of wo, slots, mode, lobes), or a message."""
            if wavefront.is_symbolic():
                refuse(mi, SYMBOLIC)
            if dr.grad_enabled(si):
                self.warn_once("musurf: a plugin has no derivatives: gradients with respect to directions end here")
            if self.material.plan.needs & abi.NEEDS_TANGENT and not self.tangents_checked:
                self.check_tangents(si)
            lobes = 0
            for index, (lobe, flag) in enumerate(self.lobes):
                if ctx.is_enabled(flag, index):
                    lobes |= lobe
            mode = abi.IMPORTANCE if ctx.mode == mi.TransportMode.Importance else 0
            return list(si.wi), self.given.slots(si, active), mode, lobes

        def eval_pdf(self, ctx, si, wo, active=True):
            active = mi.Mask(active)
            view, slots, mode, lobes = self.prepare(ctx, si, active)
            r, g, b, pdf = wavefront.evaluate(mi.Float, self.material, view, list(wo), active, slots, mode, lobes)
            return mi.Color3f(r, g, b), pdf

        def eval(self, ctx, si, wo, active=True):
            return self.eval_pdf(ctx, si, wo, active)[0]

        def pdf(self, ctx, si, wo, active=True):
            return self.eval_pdf(ctx, si, wo, active)[1]

        def sample(self, ctx, si, sample1, sample2, active=True):
            active = mi.Mask(active)
            view, slots, mode, lobes = self.prepare(ctx, si, active)
            u = [sample2.x, sample2.y, sample1]
            found, lobe = wavefront.sample(mi.Float, mi.UInt32, self.material, view, u, active, slots, mode, lobes)
            if len(lobe) == 0:
                return dr.zeros(mi.BSDFSample3f, 0), dr.zeros(mi.Color3f, 0)
            bs = mi.BSDFSample3f(mi.Vector3f(*found[:3]))
            bs.pdf, bs.eta = found[6], found[7]
            bs.sampled_type, bs.sampled_component = mi.UInt32(0), mi.UInt32(0)
            for index, (bit, flag) in enumerate(self.lobes):
                bs.sampled_type[lobe == bit] = int(flag)
                bs.sampled_component[lobe == bit] = index
            return bs, mi.Color3f(*found[3:6])

    return Musurf

