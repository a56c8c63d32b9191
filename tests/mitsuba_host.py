# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What the tests of the host Mitsuba share: its own Python, into which a test program is started again, or left out where there
is none; and its log."""
import os
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = (ROOT / os.environ.get("BUILD", "build")).resolve()
PYTHON = pathlib.Path(os.environ.get("MITSUBA_PYTHON", BUILD / "mitsuba/bin/python"))
LEFT_OUT = 77


def need():
    """Goes on if Mitsuba is there; otherwise says so, and leaves the test out. Under a sanitizer, too: its runtime would have to be
    loaded before Python."""
    if os.environ.get("SANITIZE"):
        print("a sanitized shared object cannot be loaded into Mitsuba's Python")
        sys.exit(LEFT_OUT)
    if not PYTHON.exists():
        print("Mitsuba is not installed: `make mitsuba` does that")
        sys.exit(LEFT_OUT)


def environment():
    return dict(os.environ, MUSURF_PLUGIN_PATH=str(BUILD), PYTHONPATH=f"{ROOT / 'plugin/mitsuba'}:{ROOT / 'tests'}", BUILD=str(BUILD),
                MUSURF_IN_MITSUBA="1")


def enter():
    """From the first line of a test program: the rest of it runs in Mitsuba's Python, in the variant that musurf works in."""
    if not os.environ.get("MUSURF_IN_MITSUBA"):
        need()
        sys.stdout.flush()
        os.execve(PYTHON, [str(PYTHON), *sys.argv], environment())
    import mitsuba as mi
    mi.set_variant("llvm_ad_rgb")
    import musurf_mitsuba
    return mi, musurf_mitsuba


def listen(mi):
    """A list that Mitsuba's log goes to from now on, instead of the terminal."""
    heard = []

    class Ear(mi.Appender):
        def append(self, level, text):
            heard.append(text)

        def log_progress(self, progress, name, formatted, eta, ptr=None):
            pass

    logger = mi.logger()
    logger.clear_appenders()
    logger.add_appender(Ear())
    return heard
