# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Which "integrator"s are looked at: what the program says it has, with N reads where a technique has a choice."""
import json

from . import effort as efforts
from . import program, scene

ONE_READ = ("split", "bent-normal")
BASELINE, SEED, FILTERED = "bent-normal", "major-axis", "filtered"
SQUARES = (4, 16, 64)  # what filtered sampling takes of the numbers of reads
PUBLISHED = (*ONE_READ, SEED, FILTERED)  # every other technique is an improvement, or is to be one
DEFAULT = {"by": "lobe"}  # the improvement to take, with the reads that it has where a scene names none


def names(musurf):
    """In the program's order."""
    return [name for name in json.loads(program.call(musurf, "info", "--json"))["integrators"] if name != "path"]


def all_of(musurf, effort):
    """[integrator]: one for each technique and number of reads."""
    found = []
    for name in names(musurf):
        reads = {efforts.FILTERED, *(n for n in effort.reads if name != FILTERED or n in SQUARES)}
        chosen = ["auto"] if name not in PUBLISHED and '"auto"' in json.dumps(keys()["reads"]) else []  # as many as each pixel needs
        found += [{"by": name}] if name in ONE_READ else [{"by": name, "reads": n} for n in [*sorted(reads | {efforts.SEED}), *chosen]]
        found += [DEFAULT] if name == DEFAULT["by"] else []
    return found


def contenders(musurf):
    """What is compared on whole scenes: every technique with the paper's number of reads, and the default."""
    found = [{"by": name} if name in ONE_READ else {"by": name, "reads": efforts.SEED} for name in names(musurf)]
    return [*found, DEFAULT]


def keys():
    """What an "integrator" of a scene file may say."""
    return json.loads((scene.ROOT / "scenes" / "scene.schema.json").read_text())["$defs"]["integrator"]["properties"]


def sweeps(effort):
    """{"k" or "beta": [integrator]}, as far as scene files have these keys."""
    return {key: [{"by": SEED, "reads": efforts.SEED, key: value} for value in values] for key, values in (("k", effort.k), ("beta", effort.beta)) if key in keys()}


def label(integrator):
    more = "".join(f", {key} {value:g}" for key, value in integrator.items() if key not in ("by", "reads"))
    return integrator["by"] + (", as it is" if integrator == DEFAULT else "") + (f", N = {integrator['reads']}" if "reads" in integrator else "") + more
