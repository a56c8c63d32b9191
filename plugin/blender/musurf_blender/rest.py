# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The shape at rest of a mesh that deforms: as it is without shape keys, armature, cloth and whatever else moves vertices.

Where modifiers only move vertices it is the mesh itself, always up to date. Where some make new ones (subdivision, mirror) those are
evaluated over the undeformed mesh, on the main thread, when "Stretch with the mesh" is set, since a render may not change the scene, and kept as a
mesh of its own in the file; "Update" does it again."""
import bpy
import numpy as np

from . import mesh

MOVES = {"ARMATURE", "CAST", "CURVE", "DISPLACE", "HOOK", "LAPLACIANDEFORM", "LATTICE", "MESH_DEFORM", "SHRINKWRAP", "SIMPLE_DEFORM",
         "SMOOTH", "CORRECTIVE_SMOOTH", "LAPLACIANSMOOTH", "SURFACE_DEFORM", "WARP", "WAVE", "VOLUME_DISPLACE", "CLOTH", "SOFT_BODY",
         "COLLISION", "MESH_CACHE", "MESH_SEQUENCE_CACHE", "OCEAN", "PARTICLE_SYSTEM"}
# data only: normals, groups, texture coordinates
HARMLESS = {"NORMAL_EDIT", "WEIGHTED_NORMAL", "UV_PROJECT", "UV_WARP", "VERTEX_WEIGHT_EDIT", "VERTEX_WEIGHT_MIX", "VERTEX_WEIGHT_PROXIMITY",
            "DATA_TRANSFER"}


def makes_vertices(thing):
    return any(m.show_render and m.type not in MOVES | HARMLESS for m in thing.modifiers)


def undeformed(data):
    """Positions of the mesh without its shape keys."""
    keys = data.shape_keys
    return mesh.floats(keys.reference_key.data if keys else data.vertices, "co", 3)


def prepare(copy):
    """Leaves the modifiers that make vertices, as they render."""
    copy.animation_data_clear()
    copy.constraints.clear()
    copy.parent = None
    for modifier in list(copy.modifiers):
        if modifier.type in MOVES:
            copy.modifiers.remove(modifier)
            continue
        modifier.show_viewport = modifier.show_render
        if hasattr(modifier, "render_levels"):
            modifier.levels = modifier.render_levels


def bind(thing):
    """[main thread] Evaluates and keeps the shape at rest of an object that needs that; forgets it elsewhere."""
    old, thing.musurf.rest = thing.musurf.rest, None
    if old and old.users == 0:
        bpy.data.meshes.remove(old)
    if thing.type != "MESH" or not makes_vertices(thing):
        return
    copy = thing.copy()
    copy.data = thing.data.copy()
    scene = bpy.data.scenes.new(".musurf rest")
    try:
        positions = undeformed(thing.data)
        copy.shape_key_clear()
        copy.data.vertices.foreach_set("co", np.ascontiguousarray(positions).ravel())
        prepare(copy)
        scene.collection.objects.link(copy)
        scene.view_layers[0].update()
        depsgraph = scene.view_layers[0].depsgraph
        made = bpy.data.meshes.new_from_object(copy.evaluated_get(depsgraph), preserve_all_data_layers=True, depsgraph=depsgraph)
        made.name = ".musurf rest " + thing.name
        thing.musurf.rest = made
    finally:
        data = copy.data
        bpy.data.scenes.remove(scene)
        bpy.data.objects.remove(copy)
        bpy.data.meshes.remove(data)


def positions(thing, shape):
    """Of the original object: its vertices at rest, in the order of its evaluated shape; or why there are none."""
    bound = thing.musurf.rest
    if bound:
        found = mesh.Shape(bound)
        if found.same_faces(shape):
            return found.positions, None
        return None, "its faces are not those at rest any more: press Update beside \"Stretch with the mesh\""
    if thing.type != "MESH" or len(thing.data.vertices) != len(shape.positions) or len(thing.data.polygons) != len(shape.first):
        return None, "modifiers have changed its faces: press Update beside \"Stretch with the mesh\""
    return undeformed(thing.data), None
