# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Puts the questions to `musurf eval` in float and double, and says of each number how wrong it is and how wrong it may be.

Per number: the relative error; the same in ULP, units in the last place of the exact value in that format; the part
that the inputs explain, C c 2^-p (tests/test_reference.py derives C and the bound); and the excess, what is left.
Failures: what is not finite or of the wrong sign, G1 or G2 outside [0, 1], a refusal, and an error beyond the bound.
"""
import json
import math
import subprocess
from concurrent.futures import ThreadPoolExecutor

import test_reference as bound  # of tests

QUANTITIES = ("D", "Dv", "G1", "G2", "Lambda", "sigma", "F", "f", "pdf")
# Rows of the tables, by the kind of question: a prefix of the row, and the quantities that count there. None: all in one row.
KINDS = {"families": ("", QUANTITIES), "discrete": ("", QUANTITIES), "flat": ("", QUANTITIES),
         "samplers": ("other samplers: ", ("pdf",)), "tabulated": ("tabulated: ", QUANTITIES),
         "spline": ("spline: ", ("G1", "G2", "Lambda", "sigma", "f")), "samples": ("drawn: ", ("f", "pdf", "weight"))}
ROWS = tuple(dict.fromkeys(prefix + name for prefix, names in KINDS.values() for name in names))


def row(kind, name):
    """Where a quantity counts: in the row of its kind, or with the rest."""
    prefix, names = KINDS[kind]
    return prefix + name if name in names else name


def ask(program, questions, precision):
    """The answers, in order; by two processes at once, since what is slow is to prepare the materials."""
    if len(questions) > 100:
        half = len(questions) // 2
        with ThreadPoolExecutor(2) as pool:
            parts = pool.map(lambda part: ask_one(program, part, precision), (questions[:half], questions[half:]))
            return [answer for part in parts for answer in part]
    return ask_one(program, questions, precision)


def ask_one(program, questions, precision):
    questions = [{key: value for key, value in question.items() if key != "sampled"} for question in questions]
    text = "".join(json.dumps(question) + "\n" for question in questions)
    done = subprocess.run([program, "eval", "--precision", precision], input=text, text=True, capture_output=True)
    answers = [json.loads(line) for line in done.stdout.splitlines()]
    if len(answers) != len(questions):
        raise RuntimeError(f"{len(questions)} questions, {len(answers)} answers, exit {done.returncode}: {done.stderr.strip()}")
    return answers


def bits(precision):
    return bound.FORMATS[precision][0]


def ulp(value, bits):
    return 2.0 ** max(math.frexp(value)[1] - bits, -1074 if bits == 53 else -149)


def ranges(answer, precision):
    """What must hold of any answer, known or not."""
    rounding = 12 * 2.0 ** -bound.FORMATS[precision][0]  # F is a mean of squares of quotients of sums
    for key, value in bound.flatten(answer).items():
        if isinstance(value, bool) or key == "id" or (value is None and key == "Lambda"):
            continue
        if not isinstance(value, (int, float)) or not math.isfinite(value):
            yield f"{key} = {value} is not finite"
        elif value < 0 and key != "Lambda":
            yield f"{key} = {value} is negative"
        elif key in ("G1", "G2") and value > 1 or key[0] == "F" and value > 1 + rounding:
            yield f"{key} = {value} is above 1"


def approximation(exact, answers):
    """How far the spline of Appendix A is from the masking it approximates: (|error|, |error| / exact) of each G1 and G2."""
    return [(abs(answer[key] - float(line["approximated"][key])), abs(answer[key] / float(line["approximated"][key]) - 1))
            for line, answer in zip(exact, answers, strict=True) if "approximated" in line and "error" not in answer
            for key in ("G1", "G2") if float(line["approximated"].get(key, 0)) > 0]


def judge(exact, axes, answers, precision):
    """(records, failures): one record for each number that has an exact value."""
    bits, base, small, large = bound.FORMATS[precision]
    records, failures = [], []
    is_sampled = bool(axes) and axes[0].get("kind") == "samples"
    for line, where, answer in zip(exact, axes, answers, strict=True):
        expect = {key: float(value) for key, value in line["expect"].items()}
        if "error" in answer:
            if max(map(abs, expect.values())) < large:
                failures.append(f"{line['id']}: {answer['error']}")
            continue
        failures += [f"{line['id']}: {problem}" for problem in ranges(answer, precision)]
        got = bound.flatten(answer)
        if is_sampled:  # what `musurf sample` says
            expect = {key: expect[key] for key in ("f0", "f1", "f2", "pdf", "weight") if key in expect}
        for key, value in expect.items():
            number = got.get(key)
            name = key.rstrip("012") if key[0] in "fF" else key
            if name != key and key[1] != "0" and (value, number) == (expect[name + "0"], got[name + "0"]):
                continue  # three channels that are one
            if not isinstance(number, (int, float)) or not math.isfinite(number):
                failures.append(f"{line['id']}: {key} = {number}, exactly {value}")
                continue
            explained = bound.C * line[f"c{bits}"][key] * 2.0 ** -bits + bound.underflow(precision, line, key)
            allowed = base + explained
            if abs(value) > large or abs(value) < small:
                if abs(value) < small and allowed < 0.5 and abs(number) > 10 * small:
                    failures.append(f"{line['id']}: {key} = {number!r}, exactly {line['expect'][key]}")
                continue
            error = abs(number / value - 1)
            determined = allowed < 0.5
            records.append({"precision": precision, "quantity": row(where.get("kind", "families"), name), "id": line["id"], **where, "exact": value,
                            "error": error, "ulp": abs(number - value) / ulp(value, bits), "c": line[f"c{bits}"][key],
                            "allowed": allowed, "excess": max(0.0, error - explained), "determined": determined})
            if determined and error > allowed:
                failures.append(f"{line['id']}: {key} = {number!r}, exactly {line['expect'][key]}: off by {error:.3g}, "
                                f"allowed {allowed:.3g}")
    return records, failures
