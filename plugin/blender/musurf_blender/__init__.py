# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""musurf in Blender: a render engine with materials whose microsurface is linearly transformed, and stretches with the mesh."""
bl_info = {
    "name": "musurf",
    "description": "Renders materials whose microsurface is linearly transformed; stretched as the mesh is",
    "author": "The musurf authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Render engine",
    "category": "Render",
}


def parts():
    try:
        from . import engine, panels, settings
    except ModuleNotFoundError as why:
        raise RuntimeError(f"musurf: Blender's Python lacks {why.name}") from None
    return settings, engine, panels


def register():
    import bpy
    settings, engine, panels = parts()
    settings.register()
    bpy.utils.register_class(engine.MusurfRender)
    panels.register()


def unregister():
    import bpy
    settings, engine, panels = parts()
    panels.unregister()
    bpy.utils.unregister_class(engine.MusurfRender)
    settings.unregister()
