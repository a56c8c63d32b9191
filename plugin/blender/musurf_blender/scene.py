# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""An evaluated depsgraph as a scene file of musurf: its text, and in a folder the meshes and packed pictures that it names.

What cannot be fed is said by name, once, and left out."""
import json
import os

import bpy
import numpy as np

from . import material, mesh, rest, surroundings

NOT_KNOWN = {"VOLUME", "HAIR", "CURVES", "POINTCLOUD", "GPENCIL", "GREASEPENCIL"}


def absolute(path, owner):
    """The path in full; "//" begins one from the .blend file that the owner is linked from, or the open one."""
    return os.path.abspath(bpy.path.abspath(path, library=getattr(owner, "library", None)))


class Export:
    def __init__(self, depsgraph, folder, say):
        self.depsgraph, self.folder, self.said, self.tell = depsgraph, folder, set(), say
        self.materials, self.meshes, self.objects, self.lights, self.shapes = {}, {}, [], [], {}
        self.names = set()

    def say(self, text):
        if text not in self.said:
            self.said.add(text)
            self.tell(text)

    # ------------------------------------------------------------------------------------------------ pictures

    def path_of(self, image):
        """The file of an image; of one that is packed, what is packed, written out. None: it has none."""
        if image.is_dirty:
            self.say(f"the image \"{image.name}\" has been painted on since it was saved: what was saved is rendered")
        if image.packed_file:
            name = os.path.basename(image.filepath) or image.name.replace(os.sep, "-")
            path = os.path.join(self.folder, f"{len(os.listdir(self.folder))}-{name}")
            with open(path, "wb") as file:
                file.write(image.packed_file.data)
            return path
        if image.source != "FILE" or not image.filepath:
            return None
        return absolute(image.filepath, image)

    # ----------------------------------------------------------------------------------------------- materials

    def define(self, one):
        """What a material of Blender is here."""
        settings = one.musurf if one else None
        if settings and settings.enabled and settings.file:
            return {"file": absolute(settings.file, one)}
        if settings and settings.enabled:
            group = settings.group()
            if group is not None:
                return material.write(group, self.path_of, lambda text: self.say(f"material \"{one.name}\": {text}"))
            self.say(f"material \"{one.name}\": {settings.kind or 'its type'} is not known to the plugins there are")
        color = list(one.diffuse_color)[:3] if one else [0.8] * 3
        self.say(f"material \"{one.name}\" is none of musurf's: it is matt, of its viewport color" if one
                 else "what has no material is matt and grey")
        return {"material": "template.lambert", "reflectance": [min(max(c, 0), 1) for c in color]}

    def material(self, one):
        name = "m " + one.name_full if one else "none"
        if name not in self.materials:
            self.materials[name] = self.define(one)
        return name

    # ------------------------------------------------------------------------------------------------- objects

    def shape(self, instance):
        """(Shape, its rest positions or None, a name) of what is instanced, once for all its instances. An object may be several meshes: its own, and what
        its geometry nodes instance, under its name."""
        evaluated = instance.object
        key = (evaluated.name_full, evaluated.data.as_pointer())
        if key not in self.shapes:
            name = key[0]
            while name in self.names:
                name += "'"
            self.names.add(name)
            self.shapes[key] = (*self.evaluate(instance), name)
        return self.shapes[key]

    def evaluate(self, instance):
        """(Shape, its rest positions or None); (None, None) if there is nothing to be seen."""
        evaluated, original = instance.object, instance.object.original
        # to_mesh() is for objects; what only stands for one has its mesh already, and ends the process over to_mesh()
        own = not instance.is_instance
        data = evaluated.to_mesh(preserve_all_data_layers=True, depsgraph=self.depsgraph) if own else evaluated.data
        try:
            shape = mesh.Shape(data) if data and len(data.polygons) else None
        finally:
            if own:
                evaluated.to_mesh_clear()
        if not shape or not self.has_extent(evaluated.name_full, shape):
            return None, None
        return shape, self.at_rest(original, shape) if original.musurf.tension else None

    def has_extent(self, name, shape):
        """Whether there is anything to be seen; the renderer refuses scenes over what is flattened to nothing or nowhere."""
        why = ("has vertices that are not finite, or too far away" if not np.abs(shape.positions).max() <= surroundings.LARGEST else
               "has no face with an area" if not shape.solid.any() else None)
        if why:
            self.say(f"\"{name}\" {why}; it is left out")
        return not why

    def at_rest(self, original, shape):
        positions, why = rest.positions(original, shape)
        if positions is not None and shape.uvs is None:
            positions, why = None, "stretching needs texture coordinates, which the mesh has not: unwrap it"
        if positions is None:
            self.say(f"\"{original.name}\": {why}; its material is not stretched")
        return positions

    def file(self, instance, slot):
        """The name of the mesh in the scene file and the file at rest or None; None: no faces."""
        shape, resting, name = self.shape(instance)
        if not (shape.solid & (shape.slot == slot)).any():
            return None
        name = f"{name} {slot}"
        if name not in self.meshes:
            path = os.path.join(self.folder, f"mesh-{len(self.meshes)}.obj")
            mesh.write(path, shape, slot)
            if resting is not None:
                mesh.write(path[:-4] + "-rest.obj", shape, slot, resting)
            self.meshes[name] = {"file": path}
        return name, self.meshes[name]["file"][:-4] + "-rest.obj" if resting is not None else None

    def add(self, instance):
        evaluated, matrix = instance.object, instance.matrix_world
        if not surroundings.is_invertible(matrix):
            return self.say(f"\"{evaluated.name_full}\" is scaled to nothing along an axis; it is left out")
        shape = self.shape(instance)[0]
        for slot in sorted(set(shape.slot.tolist())) if shape else ():
            found = self.file(instance, slot)
            if not found:
                continue
            slots = evaluated.material_slots
            one = slots[min(slot, len(slots) - 1)].material if len(slots) else None
            name = self.material(one.original if one else None)
            made = {"mesh": found[0], "material": name, "transform": surroundings.rows(matrix)}
            if found[1]:
                made["tension"] = {"rest": found[1]}
            if not self.materials[name].get("transmission") and not (one and one.use_backface_culling):
                made["two_sided"] = True
            self.objects.append(made)

    # --------------------------------------------------------------------------------------------------- whole

    def gather(self):
        for instance in self.depsgraph.object_instances:
            thing = instance.object
            if not instance.show_self:
                continue
            if isinstance(thing.data, bpy.types.Mesh):  # curves, text and metaballs come as meshes, too, beside themselves
                self.add(instance)
            elif thing.type == "LIGHT":
                made = surroundings.light(thing.data, instance.matrix_world.copy(), thing.name, self.say)
                if made:
                    self.lights.append(made)
            elif thing.type in NOT_KNOWN:
                self.say(f"\"{thing.name}\": objects of type {thing.type.lower()} are not known here; it is left out")

    def all(self, width, height):
        scene = self.depsgraph.scene
        settings = scene.musurf
        if not scene.camera:
            raise ValueError("the scene has no camera")
        self.gather()
        if not self.objects:
            raise ValueError("nothing in the scene has faces to be seen")
        around = surroundings.world(scene.world, self.path_of, self.say)
        for wanted, what in ((scene.render.use_motion_blur, "motion blur is"), (scene.render.film_transparent, "a transparent film is")):
            if wanted:
                self.say(f"{what} not known here; it is left out")
        return {"musurf": 1, "camera": surroundings.camera(scene.camera.evaluated_get(self.depsgraph), self.depsgraph, width, height, self.say),
                "film": {"width": width, "height": height, "filter": settings.filter.lower(), "pixels": "float"},
                "integrator": {"samples": settings.samples, "depth": settings.depth, "roulette": settings.roulette, "seed": settings.seed},
                "materials": self.materials, "meshes": self.meshes, "objects": self.objects,
                "lights": self.lights + ([around] if around else [])}


def write(depsgraph, folder, width, height, say):
    """The scene file's text, and its name in `folder`, where it is written too."""
    text = json.dumps(Export(depsgraph, folder, say).all(width, height), indent=1)
    name = os.path.join(folder, "scene.json")
    with open(name, "w", encoding="utf-8") as file:
        file.write(text)
    return text, name
