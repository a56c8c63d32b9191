#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The layout is the architecture: which room may see which, and the house rules of every source file.

core/bsdf includes nothing of any other room; core/surface and core/ibl see core/bsdf at most, core/tension its
singular values; core/render sees materials only through plugin/'s headers; plugin sees
core; scripts are not needed to build, and the page among them sees core/bsdf, core/ibl and the renderer's studio.
"""
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
FILES = [ROOT / name for name in subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True,
                                                text=True).stdout.split()]
CODE = [file for file in FILES if file.suffix in {".c", ".h", ".cpp"}]
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)

# room -> prefixes of what its files may include with quotation marks
ALLOWED = {
    "core/bsdf/": ("core/bsdf/",),
    "core/surface/": ("core/surface/", "core/bsdf/"),
    "core/tension/": ("core/tension/", "core/bsdf/singular.h"),
    "core/ibl/": ("core/ibl/", "core/bsdf/"),
    "core/render/": ("core/render/", "core/surface/", "core/tension/", "core/ibl/", "plugin/musurf_plugin.h", "plugin/musurf_probe.h",
                     "plugin/musurf_map.h", "plugin/musurf_slopes.h"),
    "plugin/": ("plugin/", "musurf_plugin.h", "musurf_probe.h", "core/bsdf/", "core/ibl/ibl.h"),
    "scripts/page/": ("scripts/page/", "core/bsdf/", "core/ibl/", "core/render/light_parts.h"),
    "tests/": ("core/", "plugin/", "tests/"),
}
TOP_LEVEL = {"plugin", "core", "scenes", "tests", "scripts", "Makefile", "README.md", "LICENSE", "CHANGELOG.md"}


class Layout(unittest.TestCase):
    def test_rooms_see_only_what_they_may(self):
        wrong = []
        for file in CODE:
            name = str(file.relative_to(ROOT))
            room = next(room for room in ALLOWED if name.startswith(room))
            for include in INCLUDE.findall(file.read_text()):
                local = (file.parent / include).exists() and "/" not in include
                if not local and not include.startswith(ALLOWED[room]):
                    wrong.append(f"{name} includes {include}")
        self.assertEqual(wrong, [])

    def test_bsdf_needs_libm_only(self):
        headers = {"math.h", "stdint.h", "stddef.h", "stdbool.h", "float.h", "string.h", "stdio.h", "limits.h", "tgmath.h"}
        wrong = []
        for file in CODE:
            if str(file.relative_to(ROOT)).startswith("core/bsdf/"):
                wrong += [f"{file.name} includes <{found}>" for found in
                          re.findall(r"^\s*#\s*include\s*<([^>]+)>", file.read_text(), re.M) if found not in headers]
                wrong += [f"{file.name} calls {word}" for word in ("malloc", "calloc", "fopen", "pthread_")
                          if re.search(rf"\b{word}", file.read_text())]
        self.assertEqual(wrong, [])

    def test_top_level(self):
        names = {file.relative_to(ROOT).parts[0] for file in FILES}
        self.assertEqual({name for name in names if not name.startswith(".")} - TOP_LEVEL, set())

    def test_files_are_short_and_have_a_charter(self):
        wrong = []
        lengths = []
        for file in CODE + [file for file in FILES if file.suffix in {".py", ".js"}]:
            text = file.read_text()
            lines = text.count("\n")
            lengths.append(lines)
            if lines > 400:
                wrong.append(f"{file.relative_to(ROOT)}: {lines} lines")
            if "SPDX-License-Identifier: MIT" not in text[:200]:
                wrong.append(f"{file.relative_to(ROOT)}: no SPDX head")
        self.assertEqual(wrong, [])
        self.assertLess(sorted(lengths)[len(lengths) // 2], 150)

    def test_no_fast_math_and_no_machine_paths(self):
        wrong = []
        for file in FILES:
            if file.suffix in {".png", ".exr", ".jpg"} or file == pathlib.Path(__file__).resolve():
                continue
            text = file.read_text(errors="replace")
            for pattern in (r"(?<!no )(?<!No )-ffast-math(?! is never)", r"/root/|/home/\w+/"):
                if re.search(pattern, text) and file.suffix != ".md":
                    wrong.append(f"{file.relative_to(ROOT)}: {pattern}")
        self.assertEqual(wrong, [])

    def test_pages_link_to_what_is_there(self):
        wrong = []
        for file in [file for file in FILES if file.suffix == ".md"]:
            for link in re.findall(r"\]\((?!https?:|#)([^)#]+)", file.read_text()):
                if not (file.parent / link).exists():
                    wrong.append(f"{file.relative_to(ROOT)}: {link}")
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    sys.exit(unittest.main())
