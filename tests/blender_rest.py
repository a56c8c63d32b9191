# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Runs inside Blender for test_blender_rest.py: a mesh is evaluated as Blender has it before it deforms and after, and the add-on is asked, after, what
it was before. "TEST rest NAME" with the largest distance between the two, and how far the deformation went."""
import blender_scene
import bpy
import numpy as np
from mathutils import Matrix


def evaluated(thing):
    from musurf_blender import mesh
    depsgraph = bpy.context.evaluated_depsgraph_get()
    made = thing.evaluated_get(depsgraph)
    shape = mesh.Shape(made.to_mesh(preserve_all_data_layers=True, depsgraph=depsgraph))
    made.to_mesh_clear()
    return shape


def by_key(thing):
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="long")
    for vertex, point in zip(thing.data.vertices, key.data):
        point.co = (vertex.co.x, vertex.co.y, 2 * vertex.co.z)
    key.value = 0
    return lambda: setattr(key, "value", 1)


def by_armature(thing):
    data = bpy.data.armatures.new("bones")
    bones = bpy.data.objects.new("bones", data)
    bpy.context.scene.collection.objects.link(bones)
    bpy.context.view_layer.objects.active = bones
    bpy.ops.object.mode_set(mode="EDIT")
    bone = data.edit_bones.new("bone")
    bone.head, bone.tail = (0, 0, 0), (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    group = thing.vertex_groups.new(name="bone")
    group.add([v.index for v in thing.data.vertices if v.co.z > 0], 1.0, "REPLACE")
    modifier = thing.modifiers.new("bones", "ARMATURE")
    modifier.object = bones
    return lambda: setattr(bones.pose.bones["bone"], "matrix_basis", Matrix.Scale(1.5, 4))


def by_cloth(thing):
    thing.modifiers.new("cloth", "CLOTH")

    def fall():
        for frame in range(1, 13):
            bpy.context.scene.frame_set(frame)

    return fall


def subdivided(thing):
    modifier = thing.modifiers.new("smooth", "SUBSURF")
    modifier.levels = modifier.render_levels = 1
    return by_key(thing)


def mirrored_and_bent(thing):
    thing.modifiers.new("mirror", "MIRROR").use_axis = (False, False, True)
    bend = thing.modifiers.new("bend", "SIMPLE_DEFORM")
    bend.deform_method, bend.angle, bend.show_viewport, bend.show_render = "TWIST", 1.0, False, True

    def show():
        bend.show_viewport = True

    return show


def all(job):
    for make in (by_key, by_armature, by_cloth, subdivided, mirrored_and_bent):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        blender_scene.enable()
        from musurf_blender import rest
        bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=8)
        thing = bpy.context.object
        deform = make(thing)
        bpy.context.view_layer.update()
        before = evaluated(thing)
        scenes, objects = len(bpy.data.scenes), len(bpy.data.objects)
        deform()
        bpy.context.view_layer.update()
        after = evaluated(thing)
        thing.musurf.tension = True
        found, why = rest.positions(thing, after)
        if why or not before.same_faces(after):
            raise SystemExit(f"{make.__name__}: {why}")
        if (scenes, objects) != (len(bpy.data.scenes), len(bpy.data.objects)):
            raise SystemExit(f"{make.__name__}: the scene is not as it was")
        blender_scene.log(f"rest {make.__name__} {np.abs(found - before.positions).max():.9f} {np.abs(after.positions - before.positions).max():.9f}")
