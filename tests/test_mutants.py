#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The tests, tested: wrong versions of the core must each be rejected by at least one check, the right one by none.

core/bsdf/mutant.h holds the mistakes. Core and plugin are built again, once, with all of them, of which the environment chooses
(tests/mutant_chosen.h). For each, the fast checks run with that plugin until one rejects it; with none chosen they pass, as with the core as
built. Three of them also go through scripts/validate, whose POV-Ray measurements are taken
once, with the right core: it must fail and name what disagrees. Prints which check rejects which mutant, and writes that to
$BUILD/mutants.json: true, false, or null where the mutant was dead already.
"""
import concurrent.futures
import functools
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

import check_scene

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / os.environ.get("BUILD", "build")


def mutants():
    """Number and description, from the comment in mutant.h that defines them."""
    text = (ROOT / "core/bsdf/mutant.h").read_text()
    return {int(number): words for number, words in re.findall(r"^ \* - ([0-9]+): (.*)$", text, re.M)}


def environment(**extra):
    """Without what an outer make would pass down."""
    return {**{key: value for key, value in os.environ.items() if key not in ("MAKEFLAGS", "MFLAGS", "MAKELEVEL", "BUILD")},
            **extra}


@functools.cache
def is_wrong(source):
    """Whether a source file or header holds a mutant."""
    return "MUTANT(" in (ROOT / source).read_text()


def reads(rules):
    """Whether the object with this .d file is made from anything that does."""
    sources = rules.read_text().replace("\\\n", " ").splitlines()[0].split(":", 1)[1].split()
    return any(is_wrong(source) for source in sources if source.startswith(("core/", "plugin/")) and source != "core/bsdf/mutant.h")


def build():
    """The folder of a plugin that holds them all."""
    folder = BUILD / "mutants" / "all"
    shutil.rmtree(BUILD / "mutants", ignore_errors=True)
    # what holds none is copied as built, if built without sanitizers; make compiles the rest again
    plain = not re.search(rb"__[atu]b?san_", (BUILD / "musurf_material.so").read_bytes())
    for room in ("core/bsdf", "core/ibl", "plugin") if plain else ():
        for made in (BUILD / "obj" / room).glob("*.o"):
            rules = made.with_suffix(".d")
            if not rules.exists() or reads(rules):
                continue
            there = folder / "obj" / room / made.name
            there.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(made, there)
    settings = environment(CPPFLAGS="-DMUSURF_MUTANT=mu_mutant_chosen -include tests/mutant_chosen.h", OPTIMISE="-O1")
    done = subprocess.run(["make", "--no-print-directory", "-j2", f"BUILD={folder}", f"{folder}/musurf_material.so"], cwd=ROOT, env=settings,
                          capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"the mutants do not build:\n{done.stderr[-2000:]}")
    shutil.copy(BUILD / "template_material.so", folder)  # for the tests that open both
    return folder


def musurf_check(plugins, scratch):
    return [BUILD / "musurf", "check", "--quick"], {"BUILD": str(BUILD), "MUSURF_PLUGIN_PATH": str(plugins)}


def scene(plugins, scratch):
    path = check_scene.write(scratch / "check_scene.json", check_scene.FEW)
    return ([BUILD / "musurf", "check", "--quick", "--n", "0", "--samples", "5000", path],
            {"BUILD": str(BUILD), "MUSURF_PLUGIN_PATH": str(plugins)})


def reference(plugins, scratch):
    return ([sys.executable, ROOT / "tests/test_reference.py", "--quick"],
            {"BUILD": str(BUILD), "MUSURF_PLUGIN_PATH": str(plugins)})


def contract(plugins, scratch):
    return [BUILD / "tests/test_abi_shading"], {"BUILD": str(plugins)}


# From the fastest to the slowest. A mutant runs on until the first that rejects it; the right core must pass them all.
CHECKS = {"contract": contract, "reference": reference, "scene": scene, "check": musurf_check}


def rejects(check, plugins, number):
    scratch = BUILD / "mutants" / f"{number} of {plugins.name}"
    scratch.mkdir(parents=True, exist_ok=True)
    command, extra = CHECKS[check](plugins, scratch)
    done = subprocess.run([str(word) for word in command], cwd=ROOT, env=environment(**extra, MUSURF_CHOSEN_MUTANT=str(number)),
                          stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=600)
    if done.returncode not in (0, 1) and not (check == "contract" and 0 < done.returncode < 100):
        sys.exit(f"{check} did not run: exit {done.returncode}\n{done.stdout[-1500:]}{done.stderr[-1500:]}")
    return done.returncode != 0


# What scripts/validate must name, of the mutants that it must find by itself: one map, two views, small surfaces.
VALIDATE = {1: ("D facet by facet", "D of normals"), 2: ("sigma", "G1 projected mean"),
            4: ("G2 itself",)}
SMALL = ["--quick", "--size", "64", "--transform", "2,1,0,1", "--view", ".8,.3,.5", "--view=.3,-.4,.3", "--json"]


def validate(number, plugins):
    """Whether the validation fails; the right core's run, the first, leaves the measurements to the others."""
    output = BUILD / "mutants" / "validate" / str(number)
    shutil.rmtree(output, ignore_errors=True)
    if number:
        output.mkdir(parents=True)
        shutil.copytree(output.parent / "0" / "store", output / "store")
    done = subprocess.run([sys.executable, str(ROOT / "scripts/validate"), *SMALL, "-o", str(output), "--plugin-path", str(plugins)],
                          cwd=ROOT, env=environment(BUILD=str(BUILD), MUSURF_CHOSEN_MUTANT=str(number)), stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode not in (0, 1) or not done.stdout:
        sys.exit(f"validate did not run: exit {done.returncode}\n{done.stderr[-1500:]}")
    failing = {row["check"] for row in json.loads(done.stdout)["checks"] if row["verdict"] == "FAILS"}
    if number and not failing >= set(VALIDATE[number]):
        print(f"validate names {sorted(failing)} of mutant {number}, but not all of {VALIDATE[number]}")
        return False
    if not number and failing:
        print(f"validate fails the right core: {sorted(failing)}")
    return bool(failing)


def judge(number, plugins):
    """What each check says of a mutant: True, it rejects it; None: another one already has, or it is not asked."""
    verdicts = dict.fromkeys([*CHECKS, "validate"])
    if number in VALIDATE:
        verdicts["validate"] = validate(number, plugins)
    for check in CHECKS:
        verdicts[check] = rejects(check, plugins, number)
        if verdicts[check] and number:
            break
    return verdicts


def main():
    known = mutants()
    if sorted(known) != list(range(1, len(known) + 1)) or len(known) < 12:
        sys.exit(f"mutants could not be read from core/bsdf/mutant.h: {known}")
    wrong = build()
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        right_validates = not validate(0, BUILD)
        unchosen = pool.submit(judge, 0, wrong)
        matrix = dict(zip([0, *known], pool.map(judge, [0, *known], [BUILD] + [wrong] * len(known))))
    matrix[0]["validate"] = not right_validates
    for check, hit in unchosen.result().items():
        matrix[0][check] = matrix[0][check] or bool(hit)
    width = max(map(len, known.values()))
    print(f"{'mutant':{width + 3}}" + "".join(f"{check:>11}" for check in [*CHECKS, "validate"]))
    good, rows = True, []
    for number, verdicts in matrix.items():
        right = any(verdicts[check] for check in CHECKS) == (number > 0) and (verdicts["validate"] is None or
                                                                              verdicts["validate"] == (number > 0))
        good &= right
        rows.append({"mutant": number, "what": known.get(number, "none: the right core"), "as_it_should_be": right, **verdicts})
        words = {True: "killed", False: "-", None: ""}
        print(f"{number:2} {known.get(number, '(none)'):{width}}" + "".join(f"{words[hit]:>11}" for hit in verdicts.values())
              + ("" if right else "   WRONG"))
    (BUILD / "mutants.json").write_text(json.dumps({"checks": [*CHECKS, "validate"], "mutants": rows}, indent=1) + "\n")
    print("every mutant is killed, the right core is not" if good else "FAILED: a mutant lives, or the right core is rejected")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
