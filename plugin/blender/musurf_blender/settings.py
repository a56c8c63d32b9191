# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What the file keeps of musurf: of the scene, of objects, and of materials, whose parameters are the plugin's table (table.py)."""
import bpy

from . import library, rest, table

TYPES = ("musurf.microfacet", "template.lambert")
groups = {}   # property groups by material type: what is registered
missing = {}  # why a type is not there


def tension_changed(self, context):
    thing = self.id_data
    if self.tension:
        rest.bind(thing)


class MusurfObject(bpy.types.PropertyGroup):
    tension: bpy.props.BoolProperty(name="Stretch with the mesh", default=False, update=tension_changed,
                                    description="The microsurface is stretched as the mesh is, from its undeformed shape: shape keys, armature, cloth")
    rest: bpy.props.PointerProperty(type=bpy.types.Mesh, name="Shape at rest")


class MusurfScene(bpy.types.PropertyGroup):
    samples: bpy.props.IntProperty(name="Samples", default=64, min=1, soft_max=4096, max=1 << 24, description="Per pixel")
    depth: bpy.props.IntProperty(name="Depth", default=8, min=1, max=4096, description="Longest path, in events; 1: direct light")
    roulette: bpy.props.IntProperty(name="Roulette", default=4, min=1, max=4096, description="Russian roulette from so many events on")
    noise: bpy.props.FloatProperty(name="Noise", default=0, min=0, max=1, precision=4,
                                   description="Stop at this mean relative standard error; 0: at the samples")
    seed: bpy.props.IntProperty(name="Seed", default=0, min=0)
    filter: bpy.props.EnumProperty(name="Filter", default="GAUSSIAN", items=[("BOX", "Box", ""), ("GAUSSIAN", "Gaussian", "")])
    keep: bpy.props.BoolProperty(name="Keep the scene file", default=False, description="The log says where; for `musurf render`")



class MusurfMaterial(bpy.types.PropertyGroup):
    enabled: bpy.props.BoolProperty(name="musurf", default=False, description="A material of musurf; else a matt one of the viewport color")
    kind: bpy.props.StringProperty(name="Type", default=TYPES[0])
    file: bpy.props.StringProperty(name="File", subtype="FILE_PATH", description="A material file of musurf, instead of what is below")

    def group(self):
        return getattr(self, table.key(self.kind), None) if self.kind in groups else None


def material_class():
    for name in TYPES:
        try:
            groups[name] = table.group(library.parameters(name))
        except library.LibraryError as why:
            missing[name] = str(why)
            print(f"musurf: {why}")
    for name, made in groups.items():
        bpy.utils.register_class(made)
        MusurfMaterial.__annotations__[table.key(name)] = bpy.props.PointerProperty(type=made)
    return MusurfMaterial


def register():
    for one in (MusurfObject, MusurfScene, material_class()):
        bpy.utils.register_class(one)
    bpy.types.Object.musurf = bpy.props.PointerProperty(type=MusurfObject)
    bpy.types.Scene.musurf = bpy.props.PointerProperty(type=MusurfScene)
    bpy.types.Material.musurf = bpy.props.PointerProperty(type=MusurfMaterial)


def unregister():
    for owner in (bpy.types.Object, bpy.types.Scene, bpy.types.Material):
        del owner.musurf
    for one in (MusurfMaterial, MusurfScene, MusurfObject, *groups.values()):
        bpy.utils.unregister_class(one)
    for name in groups:
        del MusurfMaterial.__annotations__[table.key(name)]
    groups.clear()
    missing.clear()
