# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Runs inside Blender (BLENDER_JOB is its task, as JSON): enables the add-on, builds a scene, renders it in one of the engines, and leaves the
pictures as a numpy array. The scene is of plates, which both renderers have exactly: a floor under a skew, and a plate of 1 x 2 that a shape
key stretches to 2 x 2, whose microsurface stretches with it."""
import json
import math
import os
import sys


import bpy  # before addon_utils: as a module it says where that is
import addon_utils
import numpy as np

SKEW = (1.0, 0.6, -0.3, 1.4)
ALPHA, GAMMA = 0.3, 1.5


def log(text):
    print("TEST " + text, flush=True)


def enable():
    if not addon_utils.enable("musurf_blender", default_set=True):
        raise SystemExit("the add-on could not be enabled")


def material(name, ndf, transform=None):
    made = bpy.data.materials.new(name)
    made.musurf.enabled = True
    group = made.musurf.group()
    group.ndf, group.use_alpha, group.alpha = ndf, True, ALPHA
    if ndf == "gtr":
        group.use_gamma, group.gamma = True, GAMMA
    if transform:
        group.use_transform, group.transform = True, transform
    return made


def plate(name, width, height, place, one):
    bpy.ops.mesh.primitive_plane_add(size=1)
    thing = bpy.context.object
    thing.name = name
    for vertex in thing.data.vertices:
        vertex.co.x *= width
        vertex.co.y *= height
    thing.location, thing.rotation_euler = place
    thing.data.materials.append(one)
    return thing


def stretched(thing):
    """A shape key that makes the plate twice as wide."""
    thing.shape_key_add(name="Basis")
    key = thing.shape_key_add(name="wide")
    for vertex, point in zip(thing.data.vertices, key.data):
        point.co = (2 * vertex.co.x, vertex.co.y, vertex.co.z)
    key.value = 1


def surround(scene, folder):
    """A picture of soft colors, each direction its own, turned about z and twice as bright."""
    width, height = 256, 128
    u, v = np.meshgrid((np.arange(width) + 0.5) / width * 2 * np.pi, (np.arange(height) + 0.5) / height * np.pi)
    colors = [1.1 + np.sin(u) * np.sin(v), 1.1 + np.cos(u) * np.sin(v), 1.1 + np.cos(v), np.ones_like(u)]
    image = bpy.data.images.new("sky", width, height, float_buffer=True)
    image.pixels.foreach_set(np.stack(colors, axis=-1).astype(np.float32).ravel())
    image.filepath_raw, image.file_format = os.path.join(folder, "sky.exr"), "OPEN_EXR"
    image.save()
    image.source = "FILE"
    image.colorspace_settings.name = "Linear" if bpy.app.version < (4, 0, 0) else "Linear Rec.709"
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    tree = scene.world.node_tree
    picture, mapping, place = (tree.nodes.new(kind) for kind in ("ShaderNodeTexEnvironment", "ShaderNodeMapping", "ShaderNodeTexCoord"))
    picture.image = image
    mapping.inputs["Rotation"].default_value[2] = 0.7
    tree.nodes["Background"].inputs["Strength"].default_value = 2
    tree.links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], picture.inputs["Vector"])
    tree.links.new(picture.outputs["Color"], tree.nodes["Background"].inputs["Color"])


def lights(scene, wanted, folder):
    """Of area, sun, point, spot and world. In Cycles lamps block no light, and what is behind them shines through: ours are solid."""
    area = bpy.data.lights.new("lamp", "AREA")
    area.shape, area.size, area.size_y, area.energy, area.color = "RECTANGLE", 1.5, 1.0, 90, (1, 0.9, 0.8)
    lamp = bpy.data.objects.new("lamp", area)
    lamp.location, lamp.rotation_euler = (0.3, 1.2, 2.5), (math.radians(-25), 0, 0)
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle = 0.4, 0
    far = bpy.data.objects.new("sun", sun)
    far.rotation_euler = (math.radians(40), math.radians(15), 0)  # not in the shadow of the lamp, which in Cycles casts none
    for kind, thing in (("area", lamp), ("sun", far)):
        if kind in wanted:
            scene.collection.objects.link(thing)
    for kind in {"point", "spot"} & set(wanted):
        data = bpy.data.lights.new(kind, kind.upper())
        data.energy, data.color, data.shadow_soft_size = 150, (0.8, 1, 0.9), 0
        if kind == "spot":
            data.spot_size, data.spot_blend = math.radians(50), 0.6
        thing = bpy.data.objects.new(kind, data)
        thing.location, thing.rotation_euler = (-0.8, -0.4, 2.2), (math.radians(10), math.radians(-15), 0)
        scene.collection.objects.link(thing)
    if "picture" in wanted:
        return surround(scene, folder)
    if "world" not in wanted:
        return
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    background = scene.world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (0.3, 0.4, 0.5, 1), 0.5


def camera(scene):
    data = bpy.data.cameras.new("camera")
    data.angle = math.radians(40)
    thing = bpy.data.objects.new("camera", data)
    thing.location, thing.rotation_euler = (0, -4.2, 2.2), (math.radians(65), 0, 0)
    scene.collection.objects.link(thing)
    scene.camera = thing


def build(job):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    enable()
    scene = bpy.context.scene
    ndf = job.get("ndf", "gtr")
    floor = plate("floor", 4, 3, ((0, 0, 0), (0, 0, 0)), material("floor", ndf, SKEW))
    sign = plate("sign", 1, 2, ((0.2, 1.0, 1.0), (math.radians(50), 0, 0)), material("sign", ndf))
    stretched(sign)
    sign.musurf.tension = job.get("tension", True)
    lights(scene, job.get("lights", ("area", "sun", "world")), os.path.dirname(job.get("out", "")))
    camera(scene)
    width, height = job.get("size", (32, 24))
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.musurf.filter, scene.musurf.depth, scene.musurf.roulette = "BOX", job.get("depth", 4), 100
    scene.musurf.samples = job.get("samples", 64)
    return scene, floor, sign


def picture(scene, path):
    """The render as rows from the top, linear RGB."""
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, scene.render.filepath = "OPEN_EXR", "32", path
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(path)
    flat = np.empty(len(image.pixels), dtype=np.float32)
    image.pixels.foreach_get(flat)
    found = flat.reshape(image.size[1], image.size[0], -1)[::-1, :, :3].copy()
    bpy.data.images.remove(image)
    return found


def as_cycles(scene, job):
    from musurf_blender import cycles
    if "cycles" not in (m.__name__ for m in addon_utils.modules() if addon_utils.check(m.__name__)[1]):
        addon_utils.enable("cycles", default_set=True)
    for one in bpy.data.materials:
        cycles.write(one)
    scene.render.engine = "CYCLES"
    own = scene.cycles
    own.device, own.samples, own.use_adaptive_sampling, own.use_denoising = "CPU", job["samples"], False, False
    own.pixel_filter_type, own.max_bounces, own.blur_glossy, own.sample_clamp_indirect = "BOX", job["depth"] - 1, 0, 0
    own.light_sampling_threshold, own.glossy_bounces = 0, job["depth"]


def render(job):
    scene, floor, sign = build(job)
    scene.render.engine = "MUSURF"
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    scene.musurf.keep = bool(job.get("keep"))
    if job.get("region"):
        scene.render.use_border, scene.render.use_crop_to_border = True, job["crop"]
        scene.render.border_min_x, scene.render.border_max_x, scene.render.border_min_y, scene.render.border_max_y = job["region"]
    if job.get("masking"):
        for one in bpy.data.materials:
            one.musurf.group().masking = job["masking"]
    if job.get("map"):  # of the plate as one material's transform, for who knows no tension
        group = sign.data.materials[0].musurf.group()
        group.use_transform, group.transform = True, job["map"]
    if job.get("engine") == "CYCLES":
        as_cycles(scene, job)
    found = []
    for seed in job["seeds"]:
        scene.musurf.seed = seed
        if job.get("engine") == "CYCLES":
            scene.cycles.seed = seed
        found.append(picture(scene, job["out"] + ".exr"))
    np.save(job["out"], np.stack(found))


if __name__ == "__main__":
    task = json.loads(os.environ["BLENDER_JOB"])
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    log("Blender " + ".".join(map(str, bpy.app.version)))
    if task["do"] == "render":
        render(task)
    else:
        import importlib
        module, function = task["do"].rsplit(".", 1)
        getattr(importlib.import_module(module), function)(task)
    log("end")
