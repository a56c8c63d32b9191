# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""One scene for three hosts: a floor, a leaning plate and a closed box with the material files of scenes/materials, a lamp and light from everywhere. All is
flat and has texture coordinates of its own, so that geometry, normals and tangents are the same in each. `job` names the folder of material
files, which every host reads by itself, size, samples, seeds, and where the pictures go.

    scene_file(job)     as a scene file of musurf, meshes beside it
    three_hosts.py JOB  renders it in Mitsuba (run in its Python)
    blender(job)        renders it in Blender (run inside, by blender_scene.py)
"""
import json
import math
import pathlib
import sys

import numpy as np

EYE, TARGET, FOV, DEPTH = (0.4, -4.2, 2.2), (0, 0.1, 0.5), 36, 6
RADIANCE, AROUND = (2.4, 2.2, 2), (0.3, 0.4, 0.5)
LAMP = {"size": 2, "at": (0, 0.5, 3)}  # a square that shines down


def turned(points, x, z):
    """By degrees about x, then about z."""
    a, b = math.radians(x), math.radians(z)
    about_x = [[1, 0, 0], [0, math.cos(a), -math.sin(a)], [0, math.sin(a), math.cos(a)]]
    about_z = [[math.cos(b), -math.sin(b), 0], [math.sin(b), math.cos(b), 0], [0, 0, 1]]
    return points @ np.array(about_x).T @ np.array(about_z).T


def plate(width, height):
    return np.array([[(x * width / 2, y * height / 2, 0) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]], dtype=float)


def box(size):
    """Six faces that look outward."""
    half, top = size / 2, plate(size, size)[0] + (0, 0, size / 2)
    sides = [turned(top, 90, 90 * k) for k in range(4)]
    faces = np.array([top, turned(top, 180, 0), *sides])
    assert np.allclose(np.abs(faces).max(axis=(1, 2)), half)
    return faces


def shapes():
    """Name, material file, and faces of four corners each (n x 4 x 3), whose texture coordinates are those of a square."""
    return [("floor", "brushed.json", plate(4, 3)),
            ("sign", "gold.json", turned(plate(1.4, 1.6), 55, 20) + (-0.9, 0.5, 0.75)),
            ("block", "frosted.json", turned(box(0.9), 0, 25) + (0.7, -0.2, 0.55))]


def write_obj(path, faces):
    normals = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    lines = ["v %.9g %.9g %.9g" % tuple(p) for p in faces.reshape(-1, 3)] + ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
    lines += ["vn %.9g %.9g %.9g" % tuple(n) for n in normals]
    for i in range(len(faces)):
        corner = [f"{4 * i + k + 1}/{k + 1}/{i + 1}" for k in range(4)]
        lines += ["f " + " ".join(corner[k] for k in three) for three in ((0, 1, 2), (0, 2, 3))]
    path.write_text("\n".join(lines) + "\n")


def write_meshes(job):
    folder = pathlib.Path(job["folder"])
    for name, _, faces in shapes():
        write_obj(folder / f"{name}.obj", faces)
    return {name: str(folder / f"{name}.obj") for name, _, _ in shapes()}


def file_of(job, material):
    return str(pathlib.Path(job["materials"], material))


def scene_file(job):
    """Its path."""
    width, height = job["size"]
    scene = {"musurf": 1, "camera": {"type": "perspective", "position": EYE, "target": TARGET, "fov": FOV},
             "film": {"width": width, "height": height, "filter": "box", "pixels": "float"},
             "integrator": {"samples": job["samples"], "depth": DEPTH, "roulette": 100},
             "materials": {name: {"file": file_of(job, material)} for name, material, _ in shapes()},
             "meshes": {name: {"file": file} for name, file in write_meshes(job).items()},
             "objects": [{"mesh": name, "material": name, **({} if name == "block" else {"two_sided": True})} for name, _, _ in shapes()],
             "lights": [{"type": "rectangle", "size": [LAMP["size"]] * 2, "radiance": RADIANCE,
                         "transform": [{"rotate": [1, 0, 0, 180]}, {"translate": LAMP["at"]}]},
                        {"type": "constant", "radiance": AROUND}]}
    path = pathlib.Path(job["folder"], "scene.json")
    path.write_text(json.dumps(scene))
    return path


def mitsuba(job):
    import mitsuba_host
    mi, musurf_mitsuba = mitsuba_host.enter()
    heard, meshes, (width, height), T = mitsuba_host.listen(mi), write_meshes(job), job["size"], mi.ScalarTransform4f
    found = {"type": "scene", "integrator": {"type": "path", "max_depth": DEPTH + 1, "rr_depth": 100},
             "sensor": {"type": "perspective", "fov": FOV, "fov_axis": "y", "to_world": T().look_at(EYE, TARGET, [0, 0, 1]),
                        "film": {"type": "hdrfilm", "width": width, "height": height, "rfilter": {"type": "box"}}},
             "around": {"type": "constant", "radiance": {"type": "rgb", "value": list(AROUND)}},
             "lamp": {"type": "rectangle", "to_world": T().translate(LAMP["at"]) @ T().rotate([1, 0, 0], 180) @ T().scale(LAMP["size"] / 2),
                      "emitter": {"type": "area", "radiance": {"type": "rgb", "value": list(RADIANCE)}}}}
    for name, material, _ in shapes():
        bsdf = {"type": "musurf", "file": file_of(job, material)}
        found[name] = {"type": "obj", "filename": meshes[name], "bsdf": bsdf if name == "block" else {"type": "twosided", "inner": bsdf}}
    scene = mi.load_dict(found)
    with musurf_mitsuba.evaluated():
        pictures = [np.array(mi.render(scene, spp=job["samples"], seed=seed)) for seed in job["seeds"]]
    np.save(job["out"], np.stack(pictures))
    sys.exit("\n".join(heard) or 0)  # there is nothing to warn of


def blender(job):
    import blender_scene
    import bpy
    from mathutils import Vector
    bpy.ops.wm.read_factory_settings(use_empty=True)
    blender_scene.enable()
    from musurf_blender import surroundings
    scene = bpy.context.scene
    for name, material, faces in shapes():
        data = bpy.data.meshes.new(name)
        data.from_pydata(faces.reshape(-1, 3).tolist(), [], np.arange(4 * len(faces)).reshape(-1, 4).tolist())
        data.uv_layers.new().data.foreach_set("uv", [0, 0, 1, 0, 1, 1, 0, 1] * len(faces))
        one = bpy.data.materials.new(name)
        one.musurf.enabled, one.musurf.file = True, file_of(job, material)
        data.materials.append(one)
        scene.collection.objects.link(bpy.data.objects.new(name, data))
    lamp, most = bpy.data.lights.new("lamp", "AREA"), max(RADIANCE)
    lamp.shape, lamp.size, lamp.energy = "SQUARE", LAMP["size"], most * surroundings.AREA * LAMP["size"] ** 2
    lamp.color = [c / most for c in RADIANCE]
    thing = bpy.data.objects.new("lamp", lamp)
    thing.location = LAMP["at"]
    scene.collection.objects.link(thing)
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*AROUND, 1)
    eye = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    eye.data.sensor_fit, eye.location = "VERTICAL", EYE
    eye.data.angle_y = math.radians(FOV)
    eye.rotation_euler = (Vector(TARGET) - Vector(EYE)).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(eye)
    scene.camera = eye
    render, own = scene.render, scene.musurf
    render.engine, render.resolution_percentage = "MUSURF", 100
    render.resolution_x, render.resolution_y = job["size"]
    own.samples, own.depth, own.roulette, own.filter = job["samples"], DEPTH, 100, "BOX"
    pictures = []
    for seed in job["seeds"]:
        own.seed = seed
        pictures.append(blender_scene.picture(scene, job["out"] + ".exr"))
    np.save(job["out"], np.stack(pictures))


if __name__ == "__main__":
    mitsuba(json.loads(sys.argv[1]))
