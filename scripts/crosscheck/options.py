# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The command line of scripts/validate."""
import argparse
import math
import os

import numpy as np

DESCRIPTION = """Cross-checks musurf with POV-Ray on explicit microsurfaces: is masking invariant under linear maps; do D, sigma, G1,
visible normals, G2 and the light reflected once and often agree with the core under M? Makes heightfields, bakes M into
their vertices, has POV-Ray look at them, and says of every number: agrees, differs as Smith is known to, or FAILS.
Finished measurements are kept in DIR/store: started again, it goes on where it was, with the same result to the bit.
A surface of yours that does not repeat needs --border mirror (each of its facets in four mirror images: no mean slope, no
skew, and errors from a quarter of the blocks) or blend.
Verdicts on stdout; validate.json, fragment.html and pictures in DIR. Exit 0: none fails; 1: some do, or a part is
missing; 2: usage; 130: interrupted."""


READING = {"channel": "NAME", "cell": "C", "height-scale": "S", "border": "periodic|mirror|blend", "level": "none|mean|plane", "fill": None}


def numbers(count):
    def parse(text):
        try:
            values = [float(x) for x in text.split(",")]
        except ValueError:
            values = []
        if len(values) != count or not all(map(math.isfinite, values)):
            raise argparse.ArgumentTypeError(f"'{text}' is not {count} numbers with commas between them")
        return np.array(values)
    return parse


def transform(text):
    m = numbers(4)(text).reshape(2, 2)
    stretches = np.linalg.svd(m, compute_uv=False)
    if stretches[1] < 0.01 or stretches[0] > 100:
        raise argparse.ArgumentTypeError(f"'{text}' stretches by {stretches[1]:.3g} to {stretches[0]:.3g}; "
                                         "explicit surfaces bear .01 to 100")
    return m


def view(text):
    v = numbers(3)(text)
    if not v[2] > 0 or v[2] < np.linalg.norm(v) * np.cos(np.radians(88)):
        raise argparse.ArgumentTypeError(f"'{text}' is not a direction above the surface, at most 88 degrees from +z")
    return v / np.linalg.norm(v)


def bounded(kind, low, high):
    def parse(text):
        try:
            value = kind(text)
        except ValueError:
            value = None
        if value is None or not low <= value <= high:
            raise argparse.ArgumentTypeError(f"'{text}' is not a number from {low} to {high}")
        return value
    return parse


def parse(arguments, build):
    p = argparse.ArgumentParser("scripts/validate", description=DESCRIPTION,
                                formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument("scene", nargs="?", metavar="SCENE", help="check the materials of this scene file (.json) instead")
    how = p.add_mutually_exclusive_group()
    how.add_argument("--quick", action="store_true", help="two distributions, four maps (default)")
    how.add_argument("--full", action="store_true", help="seven distributions, eight maps up to condition 100, more views and lights")
    p.add_argument("--heightfield", metavar="FILE", help="check this surface instead: EXR, PGM, PNG, TIFF ..., read by musurf surface read")
    for name, value in READING.items():
        how = {"metavar": value} if value else {"action": "store_true", "default": None}
        p.add_argument(f"--{name}", help="of the heightfield; see musurf surface read --help", **how)
    p.add_argument("--transform", metavar="a,c,b,d", type=transform, action="append", default=[],
                   help="under this M, rows [a c] and [b d], and the identity instead; may be repeated")
    p.add_argument("--view", metavar="x,y,z", type=view, action="append", default=[],
                   help="from these views of the original instead; up to three")
    p.add_argument("--json", action="store_true", help="validate.json on stdout instead of verdict lines")
    p.add_argument("-o", metavar="DIR", dest="output", default=os.path.join(build, "validate"), help="output folder (%(default)s)")
    p.add_argument("--seed", type=bounded(int, 1, 2**31), default=2022, help="of surfaces and the random M (%(default)s)")
    p.add_argument("--size", type=bounded(int, 64, 1024), help="cells per side of the period (192; 256 with --full)")
    p.add_argument("--threads", type=bounded(int, 1, 256), default=os.cpu_count() or 1,
                   help="POV-Ray processes at a time (%(default)s); the result does not depend on it")
    p.add_argument("--plugin-path", metavar="DIR", help="where musurf looks for material plugins (MUSURF_PLUGIN_PATH)")
    options = p.parse_args(arguments)
    if len(options.view) > 3:
        p.error("--view: POV-Ray's image carries three views, one per colour; more were given")
    if options.scene and options.heightfield:
        p.error("SCENE and --heightfield: one of them")
    given = {name: getattr(options, name.replace("-", "_")) for name in READING}
    options.reading = [f"--{name}={value}" if value is not True else f"--{name}" for name, value in given.items() if value is not None]
    if options.reading and not options.heightfield:
        p.error(f"{options.reading[0].partition('=')[0]} is of --heightfield")
    if options.border == "crop":
        p.error("--border crop: POV-Ray is shown a surface that repeats; mirror or blend makes one of yours")
    return options
