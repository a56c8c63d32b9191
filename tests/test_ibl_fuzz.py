#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""`musurf ibl axis` under random lines of every size: each is answered by numbers, all finite; micronormals are unit vectors,
t is within its half turn.

    tests/test_ibl_fuzz.py [LINES]      default 20 000; `make fuzz` asks 1 000 000
"""
import json
import math
import random
import re
import subprocess
import sys
import tempfile

from command import MUSURF

SEED = 5233
NUMBERS = (0.0, 5e-324, 1e-310, 2.3e-308, 1e-160, 1e-30, 1e-9, 0.1, 0.5, 1.0, 1 + 2**-52, 1 - 2**-53, 3.0, 1e9, 1e30, 1e160, 1.7e308)
KEYS = {"id", "t", "far", "near", "tau", "far_clamped", "delta", "width", "length", "zeta", "radius", "samples"}
NOT_A_NUMBER = re.compile(rb"nan|inf|null|error", re.I)


def size(random_):
    kind = random_.random()
    return random_.choice(NUMBERS) if kind < 0.3 else 10 ** random_.uniform(-20, 20) if kind < 0.5 else random_.random() ** 2


def line(random_, number):
    su = size(random_)
    sv = su if random_.random() < 0.2 else size(random_)
    x, y, z = (random_.choice((-1, 1)) * size(random_) for _ in range(3))
    wo = [x, y, abs(z)]
    if not any(wo):
        wo[2] = 1.0
    asked = {"id": number, "sigma": [su, sv], "wo": wo, "N": random_.randint(1, 4), "appendix_c": random_.choice(("printed", "symmetric"))}
    if random_.random() < 0.8:
        asked["angle"] = random_.choice((0.0, math.pi / 2, random_.uniform(-9, 9), -size(random_)))
    if random_.random() < 0.5:
        asked["k"] = size(random_) + 2.3e-308
    if random_.random() < 0.5:
        asked["beta"] = size(random_)
    return asked


def check(asked, text):
    answer = json.loads(text)
    assert answer["id"] == asked["id"] and set(answer) == KEYS, answer
    assert len(answer["samples"]) == asked["N"], answer
    assert all(-math.pi / 2 <= t <= math.pi / 2 for t in answer["t"]), answer
    for vector in answer["far"] + answer["near"] + answer["far_clamped"] + answer["samples"]:
        assert abs(math.hypot(*vector) - 1) < 1e-14, (asked, vector)
    assert min(answer["width"], answer["length"], answer["radius"]) >= 0 and answer["zeta"] <= 1, answer


def main():
    lines = int(sys.argv[1]) if len(sys.argv) > 1 else 20_000
    random_, done = random.Random(SEED), 0
    while done < lines:
        asked = [line(random_, number) for number in range(done, min(lines, done + 50_000))]
        with tempfile.TemporaryFile() as questions:
            questions.writelines(json.dumps(each).encode() + b"\n" for each in asked)
            questions.seek(0)
            program = subprocess.run([MUSURF, "ibl", "axis"], stdin=questions, capture_output=True, timeout=600, check=False)
        wrong = NOT_A_NUMBER.search(program.stdout)
        if wrong:
            sys.exit(f"not finite: {program.stdout[:wrong.end()].splitlines()[-1][-400:]}")
        assert program.returncode == 0, program.stderr
        answers = program.stdout.splitlines()
        assert len(answers) == len(asked)
        for each, text in zip(asked, answers):
            check(each, text)
        done += len(asked)
    print(f"{done} lines, all finite")


if __name__ == "__main__":
    main()
