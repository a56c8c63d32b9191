# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What the tests of the host Blender share: where it is, or that it is not; the add-on as its zip has it; and running a task inside.

Two hosts: Debian's Blender, and the module bpy of PyPI in a Python of its own (build/bpy). Each test runs in all that are there; in the fast
form (without FULL=1) in the first."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(os.environ.get("BUILD", ROOT / "build")).resolve()
FULL = bool(os.environ.get("FULL"))
LEFT_OUT = 77
OBJECTS = [BUILD / name for name in ("libmusurf_render.so", "musurf_material.so", "template_material.so", "musurf_oiio.so")]


def hosts():
    """Command lines that run a script."""
    blender = os.environ.get("BLENDER") or shutil.which("blender")
    python = BUILD / "bpy/bin/python"
    found = [[blender, "--background", "--factory-startup", "--python-exit-code", "3", "--python"]] if blender else []
    found += [[str(python)]] if python.exists() else []
    return found if FULL else found[:1]


def need():
    """The hosts; without any it says so, and leaves the test out. Under a sanitizer, too: its runtime would have to be loaded first."""
    if os.environ.get("SANITIZE") or BUILD.name in ("asan", "ubsan", "tsan"):
        print("a sanitized shared object cannot be loaded into Blender")
        sys.exit(LEFT_OUT)
    found = hosts()
    if not found:
        print("Blender is not installed: `make blender` does that")
        sys.exit(LEFT_OUT)
    return found


def pack(folder):
    """The zip, made now."""
    made = pathlib.Path(folder, "musurf_blender.zip")
    modules = sorted((ROOT / "plugin/blender/musurf_blender").glob("*.py"))
    subprocess.run([sys.executable, ROOT / "plugin/blender/pack", made, *modules, "--", *OBJECTS], check=True)
    return made


def install(folder):
    """The add-on into a folder of scripts, as the zip has it."""
    addons = pathlib.Path(folder, "scripts/addons")
    addons.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(pack(folder)) as file:
        file.extractall(addons)
    return addons.parent


def run(host, scripts, task, **environment):
    """(exit code, log) of a task inside the host."""
    env = {name: value for name, value in os.environ.items() if name not in ("PYTHONPATH", "MUSURF_PLUGIN_PATH", "PYTHONHOME")}
    env |= {"BLENDER_JOB": json.dumps(task), "BLENDER_USER_SCRIPTS": str(scripts), "BLENDER_USER_CONFIG": str(scripts), **environment}
    done = subprocess.run([*host, str(ROOT / "tests/blender_scene.py")], env=env, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=300, cwd=scripts)
    return done.returncode, done.stdout.decode(errors="replace")


def do(host, scripts, task, codes=(0,), **environment):
    """The log of a task that must end well. Blender itself ends with 1 where its last render was refused."""
    code, log = run(host, scripts, task, **environment)
    if code not in codes or "TEST end" not in log:
        raise AssertionError(f"exit code {code}\n{log}")
    return log


class Installed(unittest.TestCase):
    """With a folder of its own, and in it the add-on's `scripts`."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.scripts = install(self.folder.name)
