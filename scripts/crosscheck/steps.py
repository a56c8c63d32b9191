# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Time and memory of each step, and progress with the time left on standard error."""
import contextlib
import sys
import time


class Steps:
    """Collects {"step", "seconds", "povray_seconds", "megabytes"}; weights tell each step's share of the work."""

    def __init__(self, total, quiet=False):
        self.list, self.total, self.done, self.quiet = [], total, 0, quiet
        self.start = time.monotonic()
        self.terminal = sys.stderr.isatty()

    @contextlib.contextmanager
    def step(self, name):
        entry = {"step": name, "seconds": 0.0, "povray_seconds": 0.0, "megabytes": 0.0}
        self.list.append(entry)
        start = time.monotonic()
        yield entry
        entry["seconds"] = round(time.monotonic() - start, 3)

    def povray(self, entry, used):
        entry["povray_seconds"] = round(entry["povray_seconds"] + used["seconds"], 3)
        entry["megabytes"] = round(max(entry["megabytes"], used["megabytes"]), 1)

    def advance(self, what, amount=1.0):
        self.done += amount
        if self.quiet:
            return
        spent = time.monotonic() - self.start
        left = spent / self.done * max(0.0, self.total - self.done)
        line = f"validate: {min(1, self.done / self.total):4.0%}  {what:44} {spent:5.0f} s, {left:.0f} s left"
        print("\r\x1b[K" + line if self.terminal else line, end="" if self.terminal else "\n", file=sys.stderr, flush=True)

    def finish(self):
        if self.terminal and not self.quiet:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)
