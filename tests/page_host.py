# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What the tests of the page share: that it is made, or that it cannot be; materials; and working its controls in headless Chromium."""
import fcntl
import math
import pathlib
import shutil
import subprocess
import sys
import unittest

import chromium
from command import BUILD, ROOT, microfacet

LEFT_OUT = 77
PAGE = BUILD / "musurf.html"
READY = "document.documentElement.dataset.ready && Number(document.getElementById('status').dataset.frames) > 0"

# Keys of the page's controls and what the command is told; each differs from the page as it opens.
CASES = [
    {"ndf": "gtr", "roughness": 0.5, "gamma": 1.7, "M": [1, 2, 0, 1], "view": [60, 40], "light": [50, -110], "metal": "Ag"},
    {"ndf": "gtr", "roughness": 0.11, "gamma": 1.7, "M": [5, 0, 0.25, 1], "view": [30, 10], "light": [31, -171], "metal": "none"},
    {"ndf": "ggx", "roughness": 0.7, "M": [-0.8, 1.4, 0.5, 0.6], "view": [80, -130], "light": [70, 65], "metal": "Au"},
    {"ndf": "beckmann", "roughness": 0.6, "M": [2.5, -1, 0.5, 0.75], "view": [20, 140], "light": [35, 0], "metal": "none", "masking": "separable"},
    {"ndf": "std", "roughness": 0.55, "gamma": 2.5, "M": [0.5, 0.25, -0.75, 1.5], "view": [75, 5], "light": [65, 170], "metal": "Cu",
     "masking": "direction_correlated"},
    {"ndf": "sheen", "roughness": 0.8, "M": [1.5, 0.5, 0, 1], "view": [45, 100], "light": [55, -20], "metal": "none"},
    {"ndf": "phong", "exponent": 40, "M": [1.25, 0.5, 0.25, 0.75], "view": [55, -60], "light": [40, 100], "metal": "none"},
]
for CASE in CASES:
    CASE.setdefault("masking", "height_correlated")


def need():
    """Without a browser, or a compiler to WebAssembly, the test is left out."""
    lacking = [name for name, there in (("chromium", chromium.program()), ("clang", shutil.which("clang")), ("wasm-ld", shutil.which("wasm-ld")),
                                        ("wasi-libc", pathlib.Path("/usr/lib/wasm32-wasi/libc.a").exists())) if not there]
    if lacking:
        print(f"{', '.join(lacking)} not installed: HOSTS=page scripts/install does that")
        sys.exit(LEFT_OUT)


def made():
    """Makes the page, one test at a time."""
    need()
    with open(BUILD / ".page.lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        subprocess.run(["make", "run-page", f"BUILD={BUILD}"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)


def direction(angles):
    theta, phi = map(math.radians, angles)
    return [math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta)]


def material_of(case):
    given = {key: case[key] for key in ("ndf", "roughness", "gamma", "exponent", "masking") if key in case}
    if case["metal"] != "none":
        given["fresnel"] = {"conductor": case["metal"]}
    return microfacet(**given, transform=[case["M"][:2], case["M"][2:]])


class Worked(unittest.TestCase):
    """The page opened from the disk, worked as a person does."""

    @classmethod
    def setUpClass(cls):
        cls.page = chromium.Page(PAGE.as_uri()).__enter__()
        cls.addClassCleanup(cls.page.__exit__)
        cls.page.until(READY)

    def put(self, key, value):
        """As a person does: a value into the last control of that key, and the event that a browser sends."""
        self.page.run(f"""(() => {{
            const input = [...document.querySelectorAll('[data-key="{key}"]')].at(-1);
            input.value = {str(value)!r};
            input.dispatchEvent(new Event("input", {{ bubbles: true }}));
        }})()""")

    def put_all(self, case):
        before = self.page.run("Number(document.documentElement.dataset.shown)")
        for key, value in case.items():
            if isinstance(value, list):
                for index, each in enumerate(value):
                    self.put(f"{key}.{index}", each)
            else:
                self.put(key, value)
        self.page.until(f"Number(document.documentElement.dataset.shown) > {before} && !musurf.asked")

    def tearDown(self):
        """Nothing was asked of a network, and nothing complained of."""
        self.page.run("0")
        self.assertEqual(self.page.complaints, [])
        self.assertEqual([each for each in self.page.requests if not each.startswith(("file:", "blob:"))], [])
