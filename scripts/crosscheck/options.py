# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The command line of scripts/validate."""
import argparse
import math
import os

import numpy as np

from . import maps

DESCRIPTION = """Cross-checks musurf with POV-Ray: is the masking of a microsurface invariant under linear maps, and
does the core's prediction hold on an explicit surface? Makes Gaussian (Beckmann) heightfields, renders them and their images under
several M, compares what is seen bit by bit, and G1, G2, sigma and D with `musurf eval`. Verdicts on stdout; numbers,
pictures and an HTML fragment in the output folder. Exit 0: all agree, or differ as Smith's model is known to; 1: a check
failed, or POV-Ray or musurf is missing; 2: usage."""


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
    p.add_argument("--quick", action="store_true", help="Gaussian surfaces of 256 x 256 cells; what is done anyway")
    p.add_argument("--full", action="store_true", help=argparse.SUPPRESS)
    p.add_argument("-o", metavar="DIR", dest="output", default=os.path.join(build, "validate"),
                   help="output folder (%(default)s)")
    p.add_argument("--json", action="store_true", help="validate.json on stdout instead of verdict lines")
    p.add_argument("--seed", type=bounded(int, 0, 2**31), default=2022, help="of surfaces and the random M (%(default)s)")
    p.add_argument("--alpha", type=bounded(float, 0.05, 0.8), default=0.5, help="Beckmann roughness (%(default)s)")
    p.add_argument("--size", type=bounded(int, 128, 1024), default=256, help="cells per side of the period (%(default)s)")
    p.add_argument("--surfaces", type=bounded(int, 1, 16), default=2, help="surfaces that POV-Ray renders (%(default)s)")
    p.add_argument("--transform", metavar="a,c,b,d", type=transform, action="append", default=[],
                   help="one more M, its rows [a c] and [b d]; may be repeated")
    p.add_argument("--view", metavar="x,y,z", type=view, action="append", default=[],
                   help="views of the original instead of 60, 75 and 85 degrees; up to three")
    p.add_argument("--threads", type=bounded(int, 1, 256), default=os.cpu_count() or 1,
                   help="POV-Ray processes at a time (%(default)s)")
    p.add_argument("--plugin-path", metavar="DIR", help="where musurf looks for material plugins (MUSURF_PLUGIN_PATH)")
    options = p.parse_args(arguments)
    if options.full:
        p.error("--full does not exist; --quick does")
    if len(options.view) > 3:
        p.error("--view: POV-Ray's image carries three views, one per colour; more were given")
    options.views = options.view or [maps.direction(60, 20), maps.direction(75, 140), maps.direction(85, 260)]
    options.maps = {"identity": np.eye(2), "stretch 5x": np.diag([5.0, 1.0]), "skew": np.array([[1.0, 2.0], [0.0, 1.0]]),
                    "random mirror": maps.random_mirror(options.seed)}
    for k, m in enumerate(options.transform, 1):
        options.maps[f"given {k}"] = m
    return options
