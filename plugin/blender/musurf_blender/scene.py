# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""An evaluated depsgraph as a scene file of musurf: its text, and in a folder the meshes and packed pictures that it names.

What cannot be fed is said by name, once, and left out."""
import json
import os

import bpy

from . import material, mesh, rest, surroundings

SHAPED = {"MESH", "CURVE", "SURFACE", "FONT", "META"}


def absolute(path, owner):
    """The path in full; "//" begins one from the .blend file that the owner is linked from, or the open one."""
    return os.path.abspath(bpy.path.abspath(path, library=getattr(owner, "library", None)))


class Export:
    def __init__(self, depsgraph, folder, say):
        self.depsgraph, self.folder, self.said, self.tell = depsgraph, folder, set(), say
        self.materials, self.meshes, self.objects, self.lights, self.shapes = {}, {}, [], [], {}

    def say(self, text):
        if text not in self.said:
            self.said.add(text)
            self.tell(text)

    # ------------------------------------------------------------------------------------------------ pictures

    def path_of(self, image):
        """The file of an image; of one that is packed, what is packed, written out. None: it has none."""
        if image.packed_file:
            path = os.path.join(self.folder, f"{len(os.listdir(self.folder))}-{os.path.basename(image.filepath) or image.name}")
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

    def shape(self, evaluated):
        """(Shape, its rest positions or None) of an evaluated object, once for all its instances."""
        found = self.shapes.get(evaluated.name_full)
        if found is None:
            data = evaluated.to_mesh(preserve_all_data_layers=True, depsgraph=self.depsgraph)
            try:
                found = (mesh.Shape(data), None) if data and len(data.polygons) else (None, None)
            finally:
                evaluated.to_mesh_clear()
            original = evaluated.original
            if found[0] and original.musurf.tension:
                found = (found[0], self.at_rest(original, found[0]))
            self.shapes[evaluated.name_full] = found
        return found

    def at_rest(self, original, shape):
        positions, why = rest.positions(original, shape)
        if positions is not None and shape.uvs is None:
            positions, why = None, "stretching needs texture coordinates, which the mesh has not: unwrap it"
        if positions is None:
            self.say(f"\"{original.name}\": {why}; its material is not stretched")
        return positions

    def file(self, evaluated, slot):
        """The name of the mesh in the scene file and the file at rest or None; None: no faces."""
        shape, resting = self.shape(evaluated)
        if not shape or not (shape.slot == slot).any():
            return None
        name = f"{evaluated.name_full} {slot}"
        if name not in self.meshes:
            path = os.path.join(self.folder, f"mesh-{len(self.meshes)}.obj")
            mesh.write(path, shape, slot)
            if resting is not None:
                mesh.write(path[:-4] + "-rest.obj", shape, slot, resting)
            self.meshes[name] = {"file": path}
        return name, self.meshes[name]["file"][:-4] + "-rest.obj" if resting is not None else None

    def add(self, evaluated, matrix):
        shape, _ = self.shape(evaluated)
        for slot in sorted(set(shape.slot.tolist())) if shape else ():
            found = self.file(evaluated, slot)
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
            if thing.type in SHAPED:
                self.add(thing, instance.matrix_world)
            elif thing.type == "LIGHT":
                made = surroundings.light(thing.data, instance.matrix_world.copy(), thing.name, self.say)
                if made:
                    self.lights.append(made)
            elif thing.type in ("VOLUME", "HAIR", "CURVES", "POINTCLOUD", "GPENCIL", "GREASEPENCIL"):
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
