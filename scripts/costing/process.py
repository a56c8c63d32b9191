# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Runs a program and tells wall seconds, processor seconds and peak memory (MB, 2^20 bytes) of the very process and its children.

wait4's maximum resident set counts what the parent held when it forked, before the exec. So the program is started by a
bare Python of about 8 MB, which also tells its own peak: below that, memory is only known to be less. Of a program that
starts another (POV-Ray), memory is that of the larger one, time is the sum.
"""
import json
import os
import subprocess
import sys

STARTER = """
import json, os, sys, time
start = time.monotonic()
child = os.posix_spawnp(sys.argv[1], sys.argv[1:], os.environ, file_actions=[(os.POSIX_SPAWN_OPEN, 0, "/dev/null", os.O_RDONLY, 0)])
status, used = os.wait4(child, 0)[1:]
seconds = time.monotonic() - start
own = int(open("/proc/self/status").read().partition("VmHWM:")[2].split()[0])
print(json.dumps({"code": os.waitstatus_to_exitcode(status), "seconds": seconds, "cpu_seconds": used.ru_utime + used.ru_stime,
                  "megabytes": used.ru_maxrss / 1024, "floor": own / 1024}), file=sys.stderr)
"""


class ProgramError(Exception):
    """A program failed; the message holds its own words."""


def call(*command, folder=None):
    """(standard output, {"seconds", "cpu_seconds", "megabytes", "floor"}); raises ProgramError."""
    command = [str(part) for part in command]
    done = subprocess.run([sys.executable, "-I", "-S", "-c", STARTER, *command], cwd=folder, capture_output=True, text=True)
    said, _, last = done.stderr.rstrip("\n").rpartition("\n")
    try:
        used = json.loads(last)
    except ValueError:
        raise ProgramError(f"{os.path.basename(command[0])}: {last}") from None
    if used.pop("code"):
        lines = [line for line in said.splitlines() if "rror" in line] or said.splitlines()[-1:] or ["no message"]
        raise ProgramError(f"{os.path.basename(command[0])} {' '.join(command[1:3])}: {lines[0]}")
    return done.stdout, used


def total(costs):
    """Of runs one after another: times add, memory is the largest."""
    return {"seconds": sum(c["seconds"] for c in costs), "cpu_seconds": sum(c["cpu_seconds"] for c in costs),
            "megabytes": max(c["megabytes"] for c in costs)}


def mean(costs):
    return {key: sum(c[key] for c in costs) / len(costs) for key in ("seconds", "cpu_seconds", "megabytes")}
