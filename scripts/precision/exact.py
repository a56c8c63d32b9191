# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The exact answers and how ill-posed each is, from tests/reference, kept in a file between runs.

The file is named by a digest of the questions and of the programs that answer them: change either and it is made anew.
"""
import hashlib
import json
import multiprocessing
import os
import pathlib

import mpmath as mp

import conditioning  # of tests/reference
from bsdf import Bsdf

REFERENCE = pathlib.Path(conditioning.__file__).parent
DIGITS = 20
SOURCES = ("bsdf.py", "conditioning.py", "families.py", "model.py", "smith.py")


def answer(question):
    material = question["material"]
    if material.get("alpha") == 0:  # a mirror: a delta lobe, of which eval shows nothing
        expect = dict.fromkeys(("D", "Dv", "pdf", "f0", "f1", "f2"), "0.0")
        none = dict.fromkeys(expect, 0.0)
        return {"id": question["id"], "expect": expect, "c53": none, "c24": none, "Dh": 0.0, "delta": True}
    case = Bsdf(material, question["wo"], question["wm"], question["wi"])
    values, c53, c24 = conditioning.measure(case, DIGITS)
    return {"id": question["id"], "expect": {key: mp.nstr(value, DIGITS) for key, value in values.items()},
            "c53": c53, "c24": c24, "Dh": float(mp.nstr(case.density, 4)), "sigma0": float(mp.nstr(case.visible, 4))}


def answers(questions, folder, say):
    digest = hashlib.sha256(json.dumps(questions).encode())
    for name in SOURCES:
        digest.update((REFERENCE / name).read_bytes())
    path = folder / f"exact-{digest.hexdigest()[:16]}.jsonl"
    if not path.exists():
        folder.mkdir(parents=True, exist_ok=True)
        say(f"computing {len(questions)} exact answers to {DIGITS} digits, once")
        part = path.with_suffix(".part")
        with multiprocessing.Pool(os.cpu_count()) as pool, open(part, "w") as out:
            for number, line in enumerate(pool.imap(answer, questions, chunksize=4), 1):
                out.write(json.dumps(line) + "\n")
                if number % 500 == 0:
                    say(f"  {number} of {len(questions)}")
        part.replace(path)
        for old in set(folder.glob("exact-*.jsonl")) - {path}:
            old.unlink()
    return [json.loads(line) for line in open(path)]
