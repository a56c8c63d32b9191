# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Run inside Blender by test_blender_export.py: scenes of objects that are several meshes, none, or not meshes at all; each is rendered, between lines
"TEST case NAME" and "TEST alive NAME", and its scene file kept, where the log says."""
import math
import os

import blender_scene
import bpy
import numpy as np


def begin():
    """A floor of one face, light and camera."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    blender_scene.enable()
    scene = bpy.context.scene
    scene.render.engine, scene.render.filepath = "MUSURF", "/nowhere"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 8, 6, 100
    scene.musurf.samples, scene.musurf.depth, scene.musurf.keep = 1, 1, True
    blender_scene.plate("floor", 4, 3, ((0, 0, 0), (0, 0, 0)), blender_scene.material("floor", "ggx"))
    blender_scene.lights(scene, ("area", "world"), "")
    blender_scene.camera(scene)
    return scene


def ball(name="ball"):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=8, ring_count=4, radius=0.5, location=(0, 0, 0.6))
    thing = bpy.context.object
    thing.name = name
    thing.data.materials.append(blender_scene.material(name, "ggx"))
    return thing


def no_meshes(scene):
    """What is no mesh comes as one; a line without a face not at all."""
    for name, make in (("ring", bpy.ops.curve.primitive_bezier_circle_add), ("text", bpy.ops.object.text_add),
                       ("surface", bpy.ops.surface.primitive_nurbs_surface_sphere_add), ("drop", bpy.ops.object.metaball_add),
                       ("line", bpy.ops.curve.primitive_bezier_circle_add)):
        make()
        bpy.context.object.name = name
    bpy.data.objects["ring"].data.bevel_depth = 0.1


def nodes(scene):
    """Geometry nodes: the plate itself, and on each of its corners a cube."""
    thing = blender_scene.plate("grown", 2, 2, ((0, 0, 1), (0, 0, 0)), blender_scene.material("grown", "ggx"))
    tree = bpy.data.node_groups.new("grow", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        if hasattr(tree, "interface"):  # from Blender 4 on
            tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
        else:
            (tree.inputs if way == "INPUT" else tree.outputs).new("NodeSocketGeometry", "Geometry")
    start, end, cube, instance, join = (tree.nodes.new(kind) for kind in (
        "NodeGroupInput", "NodeGroupOutput", "GeometryNodeMeshCube", "GeometryNodeInstanceOnPoints", "GeometryNodeJoinGeometry"))
    cube.inputs[0].default_value = (0.3, 0.3, 0.3)
    for one, other in ((start.outputs[0], instance.inputs["Points"]), (cube.outputs[0], instance.inputs["Instance"]),
                       (instance.outputs[0], join.inputs[0]), (start.outputs[0], join.inputs[0]), (join.outputs[0], end.inputs[0])):
        tree.links.new(one, other)
    thing.modifiers.new("grow", "NODES").node_group = tree


def instances(scene):
    """A collection, and twice more; its object has a modifier."""
    thing = ball()
    thing.modifiers.new("more", "SUBSURF").render_levels = 1
    group = bpy.data.collections.new("group")
    scene.collection.children.link(group)
    group.objects.link(thing)
    scene.collection.objects.unlink(thing)
    for x in (-1, 1):
        empty = bpy.data.objects.new("empty", None)
        empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", group, (x, 0, 0)
        scene.collection.objects.link(empty)


def scaled_to_nothing(scene):
    ball().scale = (1, 0, 1)


def without_area(scene):
    flat = bpy.data.meshes.new("flat")
    flat.from_pydata([(0, 0, 1), (1, 0, 1), (2, 0, 1), (3, 0, 1)], [], [(0, 1, 2), (0, 1, 2, 3)])
    scene.collection.objects.link(bpy.data.objects.new("flat", flat))


def slivers(scene):
    """Thin, but not flat: the renderer takes these."""
    thin = bpy.data.meshes.new("thin")
    thin.from_pydata([(0, 0, 1), (1, 0, 1), (0.5, 1e-5, 1), (1, 1e-5, 1), (0, 1e-5, 1)], [], [(0, 1, 2), (0, 1, 3, 4)])
    scene.collection.objects.link(bpy.data.objects.new("thin", thin))


def not_finite(scene):
    ball().data.vertices[0].co.x = math.nan


def bright(scene):
    """Light that the renderer has not."""
    for light in bpy.data.lights:
        light.energy = -5
    scene.world.node_tree.nodes["Background"].inputs["Strength"].default_value = 1e30


def image(name, scene):
    made = bpy.data.images.new(name, 4, 4)
    made.pixels.foreach_set(np.full(64, 0.5, dtype=np.float32))
    group = next(thing for thing in scene.objects if thing.name == "floor").data.materials[0].musurf.group()
    group.image_alpha = made
    return made


def packed(scene):
    image("a/b", scene).pack()


def painted_on(scene):
    made = image("painted", scene)
    made.filepath_raw, made.file_format = os.path.join(os.getcwd(), "painted.png"), "PNG"
    made.save()
    made.source = "FILE"
    made.pixels.foreach_set(np.full(64, 0.2, dtype=np.float32))
    made.update()


def cases(job):
    for name in ("no_meshes", "nodes", "instances", "scaled_to_nothing", "without_area", "slivers", "not_finite", "bright", "packed", "painted_on"):
        scene = begin()
        blender_scene.log("case " + name)
        try:
            globals()[name](scene)
            bpy.ops.render.render()
        except RuntimeError as why:
            print("raised:", why)
        blender_scene.log("alive " + name)
