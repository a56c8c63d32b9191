#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The tests, tested: wrong versions of the core must each be rejected by at least one check, the right one by none.

core/bsdf/mutant.h holds the mistakes. For each, core and plugin alone are built again below $BUILD/mutants/n, and the fast
checks run with that plugin until one rejects it. Three of them also go through scripts/validate, whose POV-Ray measurements are taken
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
def mistakes(source):
    """The mutants that a source file or header holds."""
    return set(map(int, re.findall(r"\bMUTANT\(\s*([0-9]+)", (ROOT / source).read_text())))


def reads(rules, number):
    """Whether the object with this .d file is made from anything that holds the mutant."""
    sources = rules.read_text().replace("\\\n", " ").splitlines()[0].split(":", 1)[1].split()
    return any(number in mistakes(source) for source in sources if source.startswith(("core/", "plugin/")))


def build(number):
    """The folder of the mutant's plugin; 0 is the plugin as built."""
    if number == 0:
        return BUILD
    folder = BUILD / "mutants" / str(number)
    shutil.rmtree(folder, ignore_errors=True)
    # what does not hold the mutant is copied as built, if built without sanitizers; make compiles the rest again
    plain = not re.search(rb"__[atu]b?san_", (BUILD / "musurf_material.so").read_bytes())
    for room in ("core/bsdf", "plugin") if plain else ():
        for made in (BUILD / "obj" / room).glob("*.o"):
            rules = made.with_suffix(".d")
            if not rules.exists() or reads(rules, number):
                continue
            there = folder / "obj" / room / made.name
            there.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(made, there)
    done = subprocess.run(["make", "--no-print-directory", f"BUILD={folder}", f"{folder}/musurf_material.so"], cwd=ROOT,
                          env=environment(CPPFLAGS=f"-DMUSURF_MUTANT={number}", OPTIMISE="-O1"), capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"mutant {number} does not build:\n{done.stderr[-2000:]}")
    shutil.copy(BUILD / "template_material.so", folder)  # for the tests that open both
    return folder


def musurf_check(folder):
    return [BUILD / "musurf", "check", "--quick"], {"BUILD": str(BUILD), "MUSURF_PLUGIN_PATH": str(folder)}


def scene(folder):
    path = check_scene.write(folder / "check_scene.json", check_scene.FEW)
    return ([BUILD / "musurf", "check", "--quick", "--n", "0", "--samples", "5000", path],
            {"BUILD": str(BUILD), "MUSURF_PLUGIN_PATH": str(folder)})


def reference(folder):
    return ([sys.executable, ROOT / "tests/test_reference.py", "--quick"],
            {"BUILD": str(BUILD), "MUSURF_PLUGIN_PATH": str(folder)})


def contract(folder):
    return [BUILD / "tests/test_abi_shading"], {"BUILD": str(folder)}


# From the fastest to the slowest. A mutant runs on until the first that rejects it; the right core must pass them all.
CHECKS = {"contract": contract, "reference": reference, "scene": scene, "check": musurf_check}


def rejects(check, folder):
    command, extra = CHECKS[check](folder)
    done = subprocess.run([str(word) for word in command], cwd=ROOT, env=environment(**extra), stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, timeout=600)
    if done.returncode not in (0, 1) and not (check == "contract" and 0 < done.returncode < 100):
        sys.exit(f"{check} did not run: exit {done.returncode}\n{done.stdout[-1500:]}{done.stderr[-1500:]}")
    return done.returncode != 0


# What scripts/validate must name, of the mutants that it must find by itself: one map, two views, small surfaces.
VALIDATE = {1: ("D facet by facet", "D of normals"), 2: ("sigma", "G1 projected mean"),
            4: ("G2 itself",)}
SMALL = ["--quick", "--size", "64", "--transform", "2,1,0,1", "--view", ".8,.3,.5", "--view=.3,-.4,.3", "--json"]


def validate(number, folder):
    """Whether the validation fails; the right core's run, the first, leaves the measurements to the others."""
    output = BUILD / "mutants" / "validate" / str(number)
    shutil.rmtree(output, ignore_errors=True)
    if number:
        output.mkdir(parents=True)
        shutil.copytree(output.parent / "0" / "store", output / "store")
    done = subprocess.run([sys.executable, str(ROOT / "scripts/validate"), *SMALL, "-o", str(output), "--plugin-path", str(folder)],
                          cwd=ROOT, env=environment(BUILD=str(BUILD)), stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode not in (0, 1) or not done.stdout:
        sys.exit(f"validate did not run: exit {done.returncode}\n{done.stderr[-1500:]}")
    failing = {row["check"] for row in json.loads(done.stdout)["checks"] if row["verdict"] == "FAILS"}
    if number and not failing >= set(VALIDATE[number]):
        print(f"validate names {sorted(failing)} of mutant {number}, but not all of {VALIDATE[number]}")
        return False
    if not number and failing:
        print(f"validate fails the right core: {sorted(failing)}")
    return bool(failing)


def judge(number):
    """What each check says of a mutant: True, it rejects it; None: another one already has, or it is not asked."""
    folder, verdicts = build(number), dict.fromkeys([*CHECKS, "validate"])
    if number in VALIDATE:
        verdicts["validate"] = validate(number, folder)
    for check in CHECKS:
        verdicts[check] = rejects(check, folder)
        if verdicts[check] and number:
            break
    return verdicts


def main():
    known = mutants()
    if sorted(known) != list(range(1, len(known) + 1)) or len(known) < 12:
        sys.exit(f"mutants could not be read from core/bsdf/mutant.h: {known}")
    right_validates = not validate(0, BUILD)
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        matrix = dict(zip([0, *known], pool.map(judge, [0, *known])))
    matrix[0]["validate"] = not right_validates
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
