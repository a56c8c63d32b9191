#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What goes wrong inside Blender is said in its log, in a line that names it, and Blender lives on: shared objects that are gone, broken or of another
version, parameters renamed since a file was saved, values that the plugin refuses, files that are missing, lights and cameras that cannot be fed,
meshes whose shape at rest is not theirs any more, cancel, and exceptions in callbacks. And the zip installs as a user would."""
import pathlib
import re
import subprocess
import sys
import unittest

import blender_host

HOSTS = blender_host.need()

CASES = {
    "no_texture_coordinates": '"sign": stretching needs texture coordinates, which the mesh has not: unwrap it; its material is not stretched',
    "changed_faces": '"sign": modifiers have changed its faces: press Update beside "Stretch with the mesh"',
    "missing_file": "/there/is/none.json",
    "missing_image": "/there/is/none.png",
    "painted_image": 'material "floor": alpha: the image "painted" has no file: save it or pack it',
    "refused": "alpha",
    "strange_lights": 'the light "disk" is of type area, disk: only suns, points, spots, and square or rectangular areas are known here; it is left out',
    "foreign_material": 'material "floor" is none of musurf\'s: it is matt, of its viewport color',
    "unknown_type": 'material "floor": acme.velvet is not known to the plugins there are',
    "no_camera": "no camera",  # Blender itself says so
    "nothing": "nothing in the scene has faces to be seen",
    "raising": "from within a callback",
}
FATAL = {"missing_file", "missing_image", "refused", "no_camera", "nothing", "raising"}


def part(log, name):
    """The log of one case."""
    found = re.search(rf"TEST case {name}\n(.*?)TEST alive {name}\n", log, re.S)
    return found.group(1) if found else None


class Messages(blender_host.Installed):
    def test_cases(self):
        for host in HOSTS:
            log = blender_host.do(host, self.scripts, {"do": "blender_tasks.cases"}, codes=(0, 1))
            for name, wanted in CASES.items():
                with self.subTest(name=name, host=host[0]):
                    said = part(log, name)
                    self.assertIsNotNone(said, log)
                    self.assertIn(wanted, said)
                    self.assertEqual("raised:" in said, name in FATAL, said)
            for name in ("point", "spot"):
                self.assertRegex(part(log, "strange_lights"), rf'the light "{name}" is a ball of radius 0\.\d+; it is a point here, and its shadows are sharp')
            self.assertIn("depth of field", part(log, "strange_lights"))
            self.assertIn("is shifted", part(log, "strange_lights"))
            for name in ("of_its_own_faces", "stopped"):
                said = part(log, name)
                self.assertIsNotNone(said, log)
                self.assertNotIn("raised:", said)
                self.assertNotIn("Warning: musurf", said)

    def test_shared_objects(self):
        source, newer = (pathlib.Path(self.folder.name, name) for name in ("newer.c", "newer.so"))
        source.write_text("unsigned musurf_render_version(void) { return 2000; }\n")
        subprocess.run(["cc", "-shared", "-fPIC", source, "-o", newer], check=True)
        for host in HOSTS:
            log = "".join(blender_host.do(host, self.scripts, {"do": "blender_tasks.libraries", **more}, codes=(0, 1))
                          for more in ({}, {"newer": str(newer)}))
            for name, wanted in (("no_library", "there is no libmusurf_render.so in"), ("no_object_file", "libmusurf_render.so does not load"),
                                 ("another_version", "has version 2 of its interface, and this add-on knows 1"),
                                 ("no_plugin", "there is no plugin musurf_material.so")):
                with self.subTest(name=name, host=host[0]):
                    self.assertIsNotNone(part(log, name), log)
                    self.assertIn(wanted, part(log, name))
            self.assertNotIn("raised:", part(log, "again"))

    def test_a_parameter_is_renamed(self):
        """A file saved with one plugin, read with another, in which the parameter is called otherwise."""
        source = (blender_host.ROOT / "plugin/template.c").read_text()
        self.assertIn('"reflectance"', source)
        changed = pathlib.Path(self.folder.name, "changed.c")
        changed.write_text(source.replace('"reflectance"', '"paint"'))
        file = str(pathlib.Path(self.folder.name, "old.blend"))
        for host in HOSTS:
            scripts = blender_host.install(self.folder.name)
            blender_host.do(host, scripts, {"do": "blender_tasks.save", "file": file})
            subprocess.run(["cc", "-std=c17", "-shared", "-fPIC", "-w", f"-I{blender_host.ROOT}", "-I" + str(blender_host.ROOT / "plugin"), '-DMUSURF_VERSION="0"',
                            f"-Wl,--version-script={blender_host.ROOT / 'plugin/export.map'}", changed, "-lm", "-o",
                            scripts / "addons/musurf_blender/lib/template_material.so"], check=True)
            log = blender_host.do(host, scripts, {"do": "blender_tasks.load", "file": file})
            self.assertIn('material "floor": template.lambert has no parameter "reflectance" any more; it is left out', log)

    def test_the_zip_installs(self):
        """By Blender's own operator, as from its preferences."""
        made = blender_host.pack(self.folder.name)
        empty = pathlib.Path(self.folder.name, "user")
        (empty / "addons").mkdir(parents=True)
        log = blender_host.do(HOSTS[0], empty, {"do": "blender_tasks.install", "zip": str(made)})
        self.assertIn("TEST engine MUSURF", log)


if __name__ == "__main__":
    sys.exit(unittest.main())
