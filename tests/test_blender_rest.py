#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The shape at rest that the add-on finds for a mesh that shape keys, an armature, cloth, or these behind modifiers that make vertices have deformed: that
which Blender itself evaluated before anything moved, to a rounding of positions of size 1, and the scene is left as it was."""
import sys
import tempfile
import unittest

import blender_host

HOSTS = blender_host.need()
NAMES = ("by_key", "by_armature", "by_cloth", "subdivided", "mirrored_and_bent")


class Rest(unittest.TestCase):
    def test_it_is_what_blender_had_before(self):
        for host in HOSTS:
            with tempfile.TemporaryDirectory() as folder:
                log = blender_host.do(host, blender_host.install(folder), {"do": "blender_rest.all"})
            found = {line.split()[2]: [float(x) for x in line.split()[3:]] for line in log.splitlines() if line.startswith("TEST rest")}
            self.assertEqual(tuple(found), NAMES, log)
            for name, (off, moved) in found.items():
                with self.subTest(name=name, host=host[0]):
                    self.assertLessEqual(off, 2.0 ** -22)  # floats around 1, each computed twice
                    self.assertGreater(moved, 0.1)


if __name__ == "__main__":
    sys.exit(unittest.main())
