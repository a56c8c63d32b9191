#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The headers of the contract compile alone under every C and C++ a host may use; each shared object exports one symbol."""
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / os.environ.get("BUILD", "build")
HEADERS = ["plugin/musurf_plugin.h", "plugin/musurf_probe.h"]
STRICT = ["-pedantic", "-pedantic-errors", "-Wall", "-Wextra", "-Werror", "-fsyntax-only"]


class Header(unittest.TestCase):
    def compiles(self, compiler, standard, suffix, header):
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder, "host" + suffix)
            # the header first and alone, twice: it must bring what it needs and be guarded
            source.write_text(f'#include "{header}"\n#include "{header}"\n'
                              "musurf_sample take(const musurf_material_type *type, const void *closure);\n"
                              "musurf_sample take(const musurf_material_type *type, const void *closure)\n"
                              "{ const float u[3] = {0, 0, 0}; musurf_sample s;\n"
                              "  type->sample(closure, u, MUSURF_ALL_LOBES, &s); return s; }\n")
            done = subprocess.run([compiler, f"-std={standard}", *STRICT, f"-I{ROOT}", str(source)],
                                  capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, f"{compiler} {standard}: {done.stderr}")

    def test_every_standard(self):
        tried = 0
        for header in HEADERS:
            for compiler in ("gcc", "clang"):
                for standard in ("c99", "c11", "c17"):
                    if shutil.which(compiler):
                        self.compiles(compiler, standard, ".c", header)
                        tried += 1
            for compiler in ("g++", "clang++"):
                for standard in ("c++11", "c++14", "c++17", "c++20"):
                    if shutil.which(compiler):
                        self.compiles(compiler, standard, ".cpp", header)
                        tried += 1
        self.assertGreaterEqual(tried, 2 * 7, "neither gcc and g++ nor clang and clang++ found")

    def test_includes_only_stddef_and_stdint(self):
        text = (ROOT / HEADERS[0]).read_text()
        self.assertEqual(sorted(re.findall(r"#\s*include\s*(\S+)", text)), ["<stddef.h>", "<stdint.h>"])
        probe = (ROOT / HEADERS[1]).read_text()
        self.assertEqual(re.findall(r"#\s*include\s*(\S+)", probe), ['"musurf_plugin.h"'])

    def test_stays_readable(self):
        lines = (ROOT / HEADERS[0]).read_text().splitlines()
        self.assertLessEqual(len(lines), 400)


class SharedObjects(unittest.TestCase):
    def symbols(self, name, *flags):
        done = subprocess.run(["nm", "-D", *flags, str(BUILD / name)], check=True, capture_output=True, text=True)
        return [line.split() for line in done.stdout.splitlines()]

    def test_one_symbol_leaves(self):
        for name in ("musurf_material.so", "template_material.so"):
            defined = [row[-1] for row in self.symbols(name, "--defined-only")]
            # a sanitizer adds its own, all with its reserved prefix
            own = [symbol for symbol in defined if not symbol.startswith(("__asan_", "__ubsan_", "__tsan_", "__odr_asan"))]
            self.assertEqual(own, ["musurf_plugin_v1"], name)

    def test_needs_only_the_c_library(self):
        for name in ("musurf_material.so", "template_material.so"):
            done = subprocess.run(["objdump", "-p", str(BUILD / name)], check=True, capture_output=True, text=True)
            needed = set(re.findall(r"NEEDED\s+(\S+)", done.stdout))
            sanitizers = {library for library in needed if re.match(r"lib(asan|ubsan|tsan|gcc_s|stdc\+\+)", library)}
            # libmvec: the compiler's vectorised libm, a part of glibc
            self.assertLessEqual(needed - sanitizers, {"libc.so.6", "libm.so.6", "libmvec.so.1"}, name)

    def test_no_constructor_and_no_thread(self):
        for name in ("musurf_material.so", "template_material.so"):
            undefined = {row[-1].split("@")[0] for row in self.symbols(name, "--undefined-only")}
            calls = {"pthread_create", "pthread_mutex_lock", "fopen", "printf", "exit", "abort", "dlopen"}
            if not any(symbol.startswith(("__asan", "__ubsan", "__tsan")) for symbol in undefined):
                self.assertEqual(undefined & calls, set(), name)


if __name__ == "__main__":
    unittest.main()
