#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`make install PREFIX=` serves both kinds of users: a C program through pkg-config, and the command, which must find its
plugin in ../lib/musurf with nothing set in the environment. `make uninstall` leaves no file behind."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = os.environ.get("BUILD", "build")
SANITIZE = os.environ.get("SANITIZE", "").split()  # make hands it on when the suite runs under a sanitizer
LINE = '{"material": {"material": "musurf.microfacet", "ndf": "ggx", "alpha": 0.25}, "wo": [0, 0, 1], "wm": [0, 0, 1]}'
PROGRAM = r"""
#include <math.h>
#include <musurf/musurf.h>
#include <musurf/musurf_plugin.h>
#include <musurf/musurf_probe.h>
#include <stdio.h>
#include <stdlib.h>
int main(void) {
    mu_definition d = mu_definition_default();
    d.alpha = 0.25;
    mu_complaint why;
    if (!mu_definition_check(&d, &why)) return 1;
    mu_surface_d *s = mu_surface_make_d(&d, malloc(mu_surface_bytes_d(&d)));
    const double up[3] = {0, 0, 1};
    mu_closure_d c;
    if (!mu_bind_d(s, up, NULL, &c)) return 2;
    printf("%.15g\n", mu_normal_d(&c, up).D);
    return 0;
}
"""


def run(*command, **more):
    done = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True, **more)
    if done.returncode:
        raise AssertionError(f"{command}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class Install(unittest.TestCase):
    def test_library_program_and_plugin(self):
        with tempfile.TemporaryDirectory() as folder:
            prefix = pathlib.Path(folder) / "usr"
            run("make", "install", f"BUILD={BUILD}", f"PREFIX={prefix}")
            env = dict(os.environ, PKG_CONFIG_PATH=str(prefix / "lib/pkgconfig"), LD_LIBRARY_PATH=str(prefix / "lib"))
            env.pop("MUSURF_PLUGIN_PATH", None)

            source = pathlib.Path(folder) / "program.c"
            source.write_text(PROGRAM)
            flags = run("pkg-config", "--cflags", "--libs", "musurf", env=env).split()
            run("cc", "-std=c17", "-Wall", "-Werror", *SANITIZE, source, "-o", source.with_suffix(""), *flags, "-lm")
            peak = float(run(source.with_suffix(""), env=env))
            # GGX at its peak: D(n) = 1 / (pi alpha^2)
            self.assertAlmostEqual(peak * 3.141592653589793 * 0.25**2, 1, delta=1e-14)

            answer = json.loads(run(prefix / "bin/musurf", "eval", input=LINE, env=env))
            self.assertAlmostEqual(answer["D"], peak, delta=1e-14 * peak)

            run("make", "uninstall", f"BUILD={BUILD}", f"PREFIX={prefix}")
            self.assertEqual([path for path in prefix.rglob("*") if path.is_file()], [])


    def test_a_distribution_from_outside(self):
        """tests/outside: a distribution of fewer than 120 lines that the library does not have, and a program around it,
        built against the installed tree alone."""
        outside = ROOT / "tests/outside"
        self.assertLess(len((outside / "exponential.c").read_text().splitlines()), 120)
        with tempfile.TemporaryDirectory() as folder:
            prefix = pathlib.Path(folder) / "usr"
            run("make", "install", f"BUILD={BUILD}", f"PREFIX={prefix}")
            env = dict(os.environ, PKG_CONFIG_PATH=str(prefix / "lib/pkgconfig"), LD_LIBRARY_PATH=str(prefix / "lib"))
            flags = run("pkg-config", "--cflags", "--libs", "musurf", env=env).split()
            kit = run("pkg-config", "--variable=distributiondir", "musurf", env=env).strip()
            objects = []
            for bits in (24, 53):
                objects.append(pathlib.Path(folder) / f"exponential{bits}.o")
                run("cc", "-std=c17", "-O2", "-Wall", "-Wextra", "-Werror", "-fno-math-errno", *SANITIZE, f"-I{kit}",
                    f"-DMU_REAL_BITS={bits}", "-c", outside / "exponential.c", "-o", objects[-1])
            program = pathlib.Path(folder) / "program"
            run("cc", "-std=c17", "-O2", "-Wall", "-Werror", *SANITIZE, outside / "program.c", *objects, "-o", program, *flags, "-lm")
            out = run(program, env=env)
            self.assertEqual(out.count("should be"), 5, out)
            self.assertNotIn("BROKEN", out)


if __name__ == "__main__":
    sys.exit(unittest.main())
