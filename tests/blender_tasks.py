# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Run inside Blender by test_blender_messages.py: what goes wrong, one after the other in one session, each between lines "TEST case NAME"."""
import pathlib

import addon_utils
import blender_scene
import bpy


def attempt(name, change=lambda scene, floor, sign: None, **job):
    """Builds the scene, spoils it, renders; whatever Blender makes of it is in the log."""
    blender_scene.log("case " + name)
    scene, floor, sign = blender_scene.build({"size": (8, 6), "samples": 1, **job})
    scene.render.engine = "MUSURF"
    scene.render.filepath = "/nowhere"
    try:
        change(scene, floor, sign)
        bpy.ops.render.render()
    except RuntimeError as why:
        print("raised:", why)
    blender_scene.log("alive " + name)


def group_of(thing):
    return thing.data.materials[0].musurf.group()


def no_texture_coordinates(scene, floor, sign):
    sign.data.uv_layers.remove(sign.data.uv_layers[0])


def changed_faces(scene, floor, sign):
    sign.modifiers.new("more", "SUBSURF").render_levels = 1  # after the check mark was set


def of_its_own_faces(scene, floor, sign):
    changed_faces(scene, floor, sign)
    sign.musurf.tension = True  # takes the shape at rest anew


def missing_file(scene, floor, sign):
    floor.data.materials[0].musurf.file = "/there/is/none.json"


def missing_image(scene, floor, sign):
    image = bpy.data.images.new("lost", 4, 4)
    image.source, image.filepath = "FILE", "/there/is/none.png"
    group_of(floor).image_alpha = image


def painted_image(scene, floor, sign):
    group_of(floor).image_alpha = bpy.data.images.new("painted", 4, 4)


def refused(scene, floor, sign):
    group_of(floor).alpha = 3  # GTR ends at 1


def strange_lights(scene, floor, sign):
    for name, kind in (("point", "POINT"), ("spot", "SPOT"), ("disk", "AREA")):
        thing = bpy.data.objects.new(name, bpy.data.lights.new(name, kind))
        scene.collection.objects.link(thing)
    thing.data.shape = "DISK"
    scene.camera.data.dof.use_dof, scene.camera.data.shift_x = True, 0.2


def foreign_material(scene, floor, sign):
    floor.data.materials[0].musurf.enabled = False


def unknown_type(scene, floor, sign):
    floor.data.materials[0].musurf.kind = "acme.velvet"


def no_camera(scene, floor, sign):
    scene.camera = None


def nothing(scene, floor, sign):
    for thing in (floor, sign):
        bpy.data.objects.remove(thing)


def cases(job):
    for name in ("no_texture_coordinates", "changed_faces", "of_its_own_faces", "missing_file", "missing_image", "painted_image", "refused",
                 "strange_lights", "foreign_material", "unknown_type", "no_camera", "nothing"):
        attempt(name, globals()[name])
    stopped()
    raising()


def stopped():
    """Cancel: asked after the first report, a render that would take an hour ends, and what is there is kept."""
    from musurf_blender import engine
    told, before = [], engine.Watch.stop
    engine.Watch.stop = lambda watch: bool(told) or told.append(1)
    try:
        attempt("stopped", samples=1 << 22, size=(64, 48))
    finally:
        engine.Watch.stop = before


def raising():
    """What a callback raises does not cross C."""
    from musurf_blender import engine
    before = engine.Watch.progress

    def progress(*arguments):
        raise ValueError("from within a callback")

    engine.Watch.progress = progress
    try:
        attempt("raising", samples=1 << 22, size=(64, 48))
    finally:
        engine.Watch.progress = before


def libraries(job):
    """The shared objects gone, broken, and of another version; the add-on stays, and works again with them."""
    from musurf_blender import library
    lib = pathlib.Path(library.__file__).parent / "lib"
    aside = lib.parent / "aside"
    aside.mkdir(exist_ok=True)

    def enable_again():
        addon_utils.disable("musurf_blender")
        blender_scene.enable()

    def without(name, file, instead=None):
        blender_scene.log("case " + name)
        (lib / file).rename(aside / file)
        if instead is not None:
            (lib / file).write_bytes(instead)
        enable_again()
        scene = bpy.context.scene
        scene.render.engine, scene.render.resolution_percentage, scene.musurf.samples = "MUSURF", 1, 1
        try:
            bpy.ops.render.render()
        except RuntimeError as why:
            print("raised:", why)
        (lib / file).unlink(missing_ok=True)
        (aside / file).rename(lib / file)
        blender_scene.log("alive " + name)

    if "newer" in job:  # in a session of its own: what has been loaded stays so
        return without("another_version", library.NAME, pathlib.Path(job["newer"]).read_bytes())
    without("no_library", library.NAME)
    without("no_object_file", library.NAME, b"no shared object")
    without("no_plugin", "musurf_material.so")
    enable_again()
    attempt("again")


def save(job):
    """A file with a material of the template plugin."""
    scene, floor, sign = blender_scene.build({"size": (8, 6)})
    own = floor.data.materials[0].musurf
    own.kind = "template.lambert"
    group = own.group()
    group.use_reflectance, group.reflectance = True, (0.1, 0.2, 0.3)
    scene.render.engine = "MUSURF"
    bpy.ops.wm.save_as_mainfile(filepath=job["file"])


def load(job):
    """That file, with whatever plugin there is now."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    blender_scene.enable()
    bpy.ops.wm.open_mainfile(filepath=job["file"])
    bpy.ops.render.render()


def install(job):
    """The zip by Blender's own operator."""
    bpy.ops.preferences.addon_install(filepath=job["zip"], overwrite=True)
    bpy.ops.preferences.addon_enable(module="musurf_blender")
    bpy.context.scene.render.engine = "MUSURF"
    blender_scene.log("engine " + bpy.context.scene.render.engine)
