# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The user interface: render settings, the object's check mark, and the material's parameters as the plugin lists them."""
import bpy

from . import cycles, rest, settings, table

ENGINE = "MUSURF"


class Panel:
    bl_space_type, bl_region_type = "PROPERTIES", "WINDOW"
    COMPAT_ENGINES = {ENGINE}

    @classmethod
    def poll(cls, context):
        return context.engine == ENGINE


class MUSURF_PT_render(Panel, bpy.types.Panel):
    bl_label, bl_context = "musurf", "render"

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        for name in ("samples", "noise", "depth", "roulette", "seed", "filter", "keep"):
            layout.prop(context.scene.musurf, name)
        for text in settings.missing.values():
            layout.label(text=text, icon="ERROR")


class MUSURF_OT_bind(bpy.types.Operator):
    bl_idname, bl_label, bl_options = "musurf.bind", "Update", {"UNDO"}
    bl_description = "Take the shape at rest of the mesh as it is now"

    def execute(self, context):
        rest.bind(context.object)
        return {"FINISHED"}


class MUSURF_PT_object(Panel, bpy.types.Panel):
    bl_label, bl_context = "musurf", "object"

    @classmethod
    def poll(cls, context):
        return context.engine == ENGINE and context.object and context.object.type == "MESH"

    def draw(self, context):
        row = self.layout.row()
        row.prop(context.object.musurf, "tension")
        if context.object.musurf.tension:
            row.operator("musurf.bind")


class MUSURF_OT_cycles(bpy.types.Operator):
    bl_idname, bl_label, bl_options = "musurf.cycles", "Write nodes for Cycles", {"UNDO"}
    bl_description = "The same material as nodes of Cycles: GGX under one transform"

    def execute(self, context):
        try:
            cycles.write(context.material)
        except cycles.NotThere as why:
            self.report({"ERROR"}, "musurf: " + str(why))
            return {"CANCELLED"}
        return {"FINISHED"}


class MUSURF_PT_material(Panel, bpy.types.Panel):
    bl_label, bl_context = "musurf", "material"

    @classmethod
    def poll(cls, context):
        return context.engine == ENGINE and context.material

    def draw_header(self, context):
        self.layout.prop(context.material.musurf, "enabled", text="")

    def draw(self, context):
        layout, own = self.layout, context.material.musurf
        layout.active = own.enabled
        layout.prop(own, "file")
        row = layout.row(align=True)
        row.prop(own, "kind")
        group = own.group()
        if group is None:
            layout.label(text=settings.missing.get(own.kind, f"{own.kind}: known are {', '.join(settings.groups)}"), icon="ERROR")
            return
        column = layout.column()
        column.active = not own.file
        for parameter in group.table["parameters"]:
            draw(column, group, parameter)
        layout.operator("musurf.cycles")


def is_shown(group, name):
    """What belongs to a choice only while that is chosen."""
    parent, _, last = name.rpartition(".")
    if not parent:
        return True
    owner = next((p for p in group.table["parameters"] if p["name"] == parent and p["kind"] == "choice"), None)
    if not owner:
        return True
    word = getattr(group, table.key(parent))
    return is_shown(group, parent) and (last == word if last in owner["choices"] else word == "custom")


def draw(layout, group, parameter):
    name = table.key(parameter["name"])
    if not table.is_known(parameter) or not is_shown(group, parameter["name"]):
        return
    row = layout.row(align=True)
    if parameter["kind"] in table.NUMBERS:
        row.prop(group, "use_" + name, text="")
        part = row.row(align=True)
        part.active = getattr(group, "use_" + name)
        part.prop(group, name)
    else:
        row.prop(group, name)
    if table.has_image(parameter):
        row.template_ID(group, "image_" + name, open="image.open")


def shared():
    """Blender's own panels that serve any engine."""
    return [one for one in bpy.types.Panel.__subclasses__() if "BLENDER_RENDER" in getattr(one, "COMPAT_ENGINES", ())]


CLASSES = (MUSURF_PT_render, MUSURF_OT_bind, MUSURF_PT_object, MUSURF_OT_cycles, MUSURF_PT_material)


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    for one in shared():
        one.COMPAT_ENGINES.add(ENGINE)


def unregister():
    for one in shared():
        one.COMPAT_ENGINES.discard(ENGINE)
    for one in CLASSES:
        bpy.utils.unregister_class(one)
