# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The README's picture of the add-on, by a user's own steps: three balloons with one shape key and one material; at rest, inflated, and inflated with
"Stretch with the mesh". The add-on is installed already.

    blender --background --python plugin/blender/balloon.py -- OUT.png"""
import math
import sys

import bpy


def balloon(x, one, inflated, tension):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, radius=0.42, location=(x, 0, 0.95))
    thing = bpy.context.object
    bpy.ops.object.shade_smooth()
    thing.data.materials.append(one)
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="inflated")
    for vertex, point in zip(thing.data.vertices, key.data):
        neck = max(0.0, -vertex.co.z / 0.42)  # which stays narrow
        wide = 2.0 - 1.0 * neck ** 3
        point.co = (vertex.co.x * wide, vertex.co.y * wide, vertex.co.z * 2.0)
    key.value = inflated
    thing.modifiers.new("smooth", "SUBSURF").render_levels = 1
    thing.musurf.tension = tension  # the check mark


def build():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="musurf_blender")
    scene = bpy.context.scene
    rubber = bpy.data.materials.new("rubber")
    rubber.musurf.enabled = True
    group = rubber.musurf.group()
    group.ndf, group.use_alpha, group.alpha, group.use_gamma, group.gamma, group.fresnel = "gtr", True, 0.35, True, 2.2, "conductor"
    group.fresnel_conductor = "Cu"
    for x, inflated, tension in ((-1.9, 0, False), (-0.35, 1, False), (1.5, 1, True)):
        balloon(x, rubber, inflated, tension)
    for place, turn in (((-3, -5, 5), (48, 0, -30)), ((4, -4, 4), (52, 0, 45))):
        lamp = bpy.data.lights.new("lamp", "AREA")
        lamp.shape, lamp.size, lamp.energy = "SQUARE", 0.9, 160
        thing = bpy.data.objects.new("lamp", lamp)
        thing.location, thing.rotation_euler = place, [math.radians(a) for a in turn]
        scene.collection.objects.link(thing)
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.03, 0.035, 0.04, 1)
    eye = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    eye.data.angle, eye.location, eye.rotation_euler = math.radians(24), (0, -12, 1.7), (math.radians(86.5), 0, 0)
    scene.collection.objects.link(eye)
    scene.camera = eye
    return scene


def main(out):
    scene = build()
    scene.render.engine = "MUSURF"
    scene.view_settings.view_transform = "Standard"
    scene.musurf.samples, scene.musurf.depth = 64, 3
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 600, 250, 100
    scene.render.filepath = out
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1])
