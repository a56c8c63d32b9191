# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What the tests of the command line share: running build/musurf and reading its JSON Lines strictly."""
import json
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(os.environ.get("BUILD", ROOT / "build")).resolve()
MUSURF = str(BUILD / "musurf")
# For the address sanitizer, where a library leaks at a cut file: whose leak it is shows only in whole call stacks.
LEAKS = {"ASAN_OPTIONS": "fast_unwind_on_malloc=0", "LSAN_OPTIONS": f"print_suppressions=0:suppressions={ROOT / 'tests/lsan.supp'}"}


def musurf(*arguments, stdin="", env=None, **options):
    """Runs the command; stdin may be text, bytes or a list of objects, one a line."""
    if isinstance(stdin, list):
        stdin = "".join(json.dumps(line) + "\n" for line in stdin)
    if isinstance(stdin, str):
        stdin = stdin.encode()
    done = subprocess.run([MUSURF, *map(str, arguments)], input=stdin, capture_output=True, timeout=120,
                          env=dict(os.environ, **(env or {})), **options)
    done.out, done.err = done.stdout.decode(), done.stderr.decode()
    return done


def refuse(name):
    raise ValueError(f"{name} is not JSON")


def strict(text):
    """JSON without Python's extensions NaN and Infinity."""
    return json.loads(text, parse_constant=refuse)


def answers(done):
    return [strict(line) for line in done.out.splitlines()]


def microfacet(**parameters):
    return {"material": "musurf.microfacet", **parameters}
