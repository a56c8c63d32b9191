#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf eval` against the tables of tests/reference, which were computed apart from the C code to 25 digits: eval.jsonl
(GGX, Beckmann and GTR under M) and families.jsonl (every other family, anisotropy, tilt, maskings, refraction).

A value v computed in p bits passes if |v - exact| <= |exact| (base + C c 2^-p), where
  c     is the measured ill-conditioning in the file: what one 2^-p of relative change in every input number does;
  C = 8 because an input number meets at most 8 roundings before nothing amplifies them any more: read into
        p bits (1), the sum of squares, its root and the division that normalise a direction (3), the half-vector's
        sum (1), the product and sum of M^T m or adj(M) v (2), and the determinant or its root (1);
  base  is what all the arithmetic after that, which amplifies nothing, may cost: 1e-12 in double, 1e-4 in float.
Where base + C c 2^-p reaches 1/2 the inputs do not determine a digit: there only the sign and finiteness count. Values too
small or too large for the format are held to be near zero, or not compared; and where D itself leaves the format's normal
numbers, what is made of it (Dv, and of D at the half-vector f and pdf) may be off by the smallest normal number over D; so for sigma before M.

    tests/test_reference.py [--quick]      --quick: every fifth line; the exit status tells
"""
import json
import math
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / os.environ.get("BUILD", "build")
C = 8
TABLES = ("eval", "families")
FORMATS = {"double": (53, 1e-12, 1e-290, 1e300), "float": (24, 1e-4, 1e-36, 1e37)}  # bits, base, small, large
SMALLEST = {"double": 2.0**-1022, "float": 2.0**-126}
WITH_WM = ("D", "G1", "Dv")


def flatten(answer):
    """f and F are triples in the program's answer and f0, f1, f2, F0, ... in the file."""
    flat = {key: value for key, value in answer.items() if key not in ("f", "F")}
    for key in ("f", "F"):
        flat.update({f"{key}{i}": value for i, value in enumerate(answer[key])})
    return flat


def underflow(precision, line, key):
    """What rounding D and sigma near the format's smallest number may do to a value made of them, relative."""
    expect, made_of = line["expect"], []
    if key in ("sigma", "G1", "Dv", "pdf") and "sigma0" in line:  # it vanishes where tilt turns every facet from the viewer
        made_of.append(line["sigma0"])
    if key == "Dv":
        made_of.append(expect["D"])
    if (key in ("pdf", "weight") or key[0] == "f") and "Dh" in line:
        made_of.append(line.get("Dpdf", line["Dh"]) if key == "pdf" else line["Dh"])
    return sum(SMALLEST[precision] / float(value) if float(value) else math.inf for value in made_of)


def question(line):
    return json.dumps({key: line[key] for key in ("id", "material", "wo", "wm", "wi")}) + "\n"


def table(name):
    return [json.loads(text) for text in open(ROOT / f"tests/reference/{name}.jsonl")]


def compare(precision, lines, answers):
    bits, base, small, large = FORMATS[precision]
    worst, largest, failures, compared, undetermined, sharp = {}, {}, [], 0, 0, 0
    for line, answer in zip(lines, answers):
        exact = {key: float(value) for key, value in line["expect"].items()}
        if answer.get("id") != line["id"]:
            failures.append(f"{line['id']}: answered by {answer.get('id')!r}")
            continue
        if "error" in answer:
            if max(map(abs, exact.values())) < large:
                failures.append(f"{line['id']}: {answer['error']}")
            continue
        got = flatten(answer)
        for key, value in exact.items():
            number = got.get(key)
            if not isinstance(number, (int, float)) or not math.isfinite(number) \
                    or (number < 0 and key != "Lambda"):  # Lambda is negative where tilt turns the surface to the viewer
                failures.append(f"{line['id']}: {key} = {number}, exactly {value}")
                continue
            allowed = base + C * line[f"c{bits}"][key] * 2.0 ** -bits + underflow(precision, line, key)
            if abs(value) > large or allowed >= 0.5:
                undetermined += 1
                continue
            compared += 1
            sharp += allowed < 10 * base
            if abs(value) < small:
                if abs(number) > 10 * small:
                    failures.append(f"{line['id']}: {key} = {number}, exactly {value}")
                continue
            error = abs(number / value - 1)
            name = key.rstrip("012") if key[0] in "fF" else key
            if allowed < 10 * base:
                largest[name] = max(largest.get(name, 0), error)
            if error / allowed > worst.get(name, (-1,))[0]:
                worst[name] = (error / allowed, error, line["id"])
            if error > allowed:
                failures.append(f"{line['id']}: {key} = {number!r}, exactly {line['expect'][key]}: "
                                f"off by {error:.3g}, allowed {allowed:.3g}")
    print(f"{precision}: {compared} values compared ({sharp} of them to better than {10 * base:g}), "
          f"{undetermined} that their inputs do not determine")
    for name, (ratio, error, where) in sorted(worst.items()):
        print(f"  {name:7} worst {ratio:8.4f} of what is allowed, relative error {error:.2e}, at {where}; "
              f"{largest.get(name, 0):.2e} where the inputs are well conditioned")
    for failure in failures[:12]:
        print(f"  FAILED {failure}")
    if failures:
        print(f"  {len(failures)} failures")
    return not failures and compared > 0, largest


def main():
    good = True
    for name in TABLES:
        lines = table(name)[::5 if "--quick" in sys.argv else 1]
        text = "".join(map(question, lines))
        for precision in FORMATS:
            print(f"{name}.jsonl, ", end="")
            done = subprocess.run([BUILD / "musurf", "eval", "--precision", precision], input=text, text=True,
                                  capture_output=True, timeout=600)
            answers = [json.loads(answer) for answer in done.stdout.splitlines()]
            if len(answers) != len(lines):
                print(f"{precision}: {len(lines)} lines in, {len(answers)} out, exit {done.returncode}: {done.stderr}")
                good = False
                continue
            good &= compare(precision, lines, answers)[0]
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
