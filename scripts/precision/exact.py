# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The exact answers and how ill-posed each is, from tests/reference, kept in files between runs.

A file is named by a digest of the questions and of the programs that answer them: change either and it is made anew.
"""
import hashlib
import json
import multiprocessing
import os
import pathlib

import mpmath as mp

import conditioning  # of tests/reference
import smith
from bsdf import Bsdf, unit

from .grid import clear

REFERENCE = pathlib.Path(conditioning.__file__).parent
DIGITS = 20
SOURCES = (*(REFERENCE / f"{name}.py" for name in ("bsdf", "conditioning", "families", "histogram", "model", "samplers", "smith", "spline")),
           pathlib.Path(__file__))


def text(values):
    return {key: mp.nstr(value, DIGITS) for key, value in values.items()}


def mirror(question):
    """A delta lobe, of which eval shows nothing; an even one hides nothing either."""
    expect = dict.fromkeys(("D", "Dv", "pdf", "f0", "f1", "f2"), mp.mpf(0))
    wo = unit([mp.mpf(x) for x in question["wo"]])
    if question["wo"][2] > 0 and "tilt" not in question["material"]:
        expect.update({"Lambda": mp.mpf(0), "sigma": wo[2]})
    none = dict.fromkeys(expect, 0.0)
    return {"id": question["id"], "expect": text(expect), "c53": none, "c24": none, "Dh": 0.0, "delta": True}


def answer(question):
    material = question["material"]
    if clear(material):
        return mirror(question)
    directions = question["wo"], question["wm"], question["wi"]
    case = Bsdf(material, *directions, sampled=question.get("sampled", False))
    values, c53, c24 = conditioning.measure(case, DIGITS)
    out = {"id": question["id"], "expect": text(values), "c53": c53, "c24": c24, "Dh": float(mp.nstr(case.density, 4)),
           "Dpdf": float(mp.nstr(case.density_pdf, 4)), "sigma0": float(mp.nstr(case.visible, 4))}
    if case.spline:  # what it approximates
        case = Bsdf({key: value for key, value in material.items() if key != "smith"}, *directions)
        smooth = case.evaluate(lambda *point: smith.Lambda(*point[:-1], digits=DIGITS))
        out["approximated"] = text({key: smooth[key] for key in ("G1", "G2", "Lambda", "sigma") if key in smooth})
    return out


def answers(questions, folder, say, name="exact"):
    digest = hashlib.sha256(json.dumps([mp.__version__, questions]).encode())
    for source in SOURCES:
        digest.update(source.read_bytes())
    path = folder / f"{name}-{digest.hexdigest()[:16]}.jsonl"
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
        for old in set(folder.glob(f"{name}-*.jsonl")) - {path}:
            old.unlink()
    return [json.loads(line) for line in open(path)]
