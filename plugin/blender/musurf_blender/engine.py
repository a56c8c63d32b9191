# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The render engine: a depsgraph is written as a scene (scene.py), and the renderer fills Blender's passes while it goes on."""
import os
import shutil
import tempfile

import bpy
import numpy as np

from . import library, scene

SEVERITY = {library.WARNING: "WARNING", library.ERROR: "ERROR"}


class Watch:
    """What the renderer tells, told to Blender."""

    def __init__(self, engine, result, buffers, region):
        self.engine, self.result, self.buffers, self.region = engine, result, buffers, region

    def stop(self):
        return self.engine.test_break()

    def progress(self, fraction, remaining, samples):
        self.engine.update_progress(fraction)
        self.engine.update_stats("", f"{samples} samples per pixel" + (f", {remaining:.0f} s left" if remaining >= 0 else ""))

    def picture(self):
        self.engine.show(self.result, self.buffers, self.region)
        self.engine.update_result(self.result)

    def message(self, severity, text):
        self.engine.report({SEVERITY.get(severity, "INFO")}, "musurf: " + text)


class Region:
    """What of a picture of width x height Blender takes: its render region, or all."""

    def __init__(self, render, width, height, result):
        self.width, self.height, self.taken = width, height, (result.resolution_x, result.resolution_y)
        at = (int(render.border_min_x * width), int(render.border_min_y * height)) if render.use_border else (0, 0)
        self.at = tuple(max(0, min(a, whole - part)) for a, whole, part in zip(at, (width, height), self.taken))

    def cut(self, flat):
        """Blender's rows go up."""
        (x, y), (width, height) = self.at, self.taken
        rows = flat.reshape(self.height, self.width, -1)[::-1]
        return np.ascontiguousarray(rows[y:y + height, x:x + width]).reshape(width * height, -1)


def put(target, rows):
    """Into a pass; before Blender 4 only the slow way does it."""
    try:
        target.rect.foreach_set(rows.ravel())
    except TypeError:
        target.rect = rows


class MusurfRender(bpy.types.RenderEngine):
    bl_idname = "MUSURF"
    bl_label = "musurf"
    bl_use_preview = False
    bl_use_shading_nodes_custom = False

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        self.register_pass(scene, renderlayer, "Albedo", 3, "RGB", "COLOR")
        self.register_pass(scene, renderlayer, "Shading Normal", 3, "XYZ", "VECTOR")

    def render(self, depsgraph):
        render = depsgraph.scene.render
        width = int(render.resolution_x * render.resolution_percentage / 100)
        height = int(render.resolution_y * render.resolution_percentage / 100)
        folder = tempfile.mkdtemp(prefix="musurf-")
        try:
            self.render_in(depsgraph, folder, max(width, 1), max(height, 1))
        except (library.LibraryError, ValueError, OSError, MemoryError) as why:
            self.refuse(str(why) or "not enough memory")
        finally:
            if depsgraph.scene.musurf.keep:
                self.report({"INFO"}, f"musurf: the scene is in {folder}")
            else:
                shutil.rmtree(folder, ignore_errors=True)

    def refuse(self, text):
        self.report({"ERROR"}, "musurf: " + text)
        self.error_set("musurf: " + text)

    def render_in(self, depsgraph, folder, width, height):
        self.update_stats("", "writing the scene")
        text, name = scene.write(depsgraph, folder, width, height, lambda line: self.report({"WARNING"}, "musurf: " + line))
        buffers = tuple(np.zeros((width * height, channels), dtype=np.float32) for channels in (4, 3, 3))
        result = self.begin_result(0, 0, width, height, layer=depsgraph.view_layer.name)
        end = library.FAILED
        try:
            render, settings = depsgraph.scene.render, depsgraph.scene.musurf
            region = Region(render, width, height, result)
            threads = render.threads if render.threads_mode == "FIXED" else 0
            end = library.render(text, name, buffers, Watch(self, result, buffers, region), threads=threads, noise=settings.noise)
            if end != library.FAILED:
                self.show(result, buffers, region)
        finally:
            self.end_result(result, cancel=end == library.FAILED)
        if end == library.FAILED:
            self.error_set("musurf: the scene was refused; the log says why")

    def show(self, result, buffers, region):
        passes = result.layers[0].passes
        pixels, albedo, normal = buffers
        combined = pixels.copy()
        combined[:, 3] = 1  # what surrounds the scene is in the picture
        for name, flat in (("Combined", combined), ("Albedo", albedo), ("Shading Normal", normal)):
            target = passes.get(name)
            if target:
                put(target, region.cut(flat))
