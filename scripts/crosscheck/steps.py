# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Time of each step, and progress with the time left on standard error."""
import contextlib
import sys
import threading
import time


class Steps:
    """Collects {"step", "seconds"}; advance() tells of work done, total is all of the step's."""

    def __init__(self, quiet=False):
        self.list, self.total, self.done, self.quiet, self.lock = [], 0.0, 0.0, quiet, threading.Lock()
        self.start = time.monotonic()
        self.terminal = sys.stderr.isatty()

    @contextlib.contextmanager
    def step(self, name):
        start, self.start, self.done, self.told = time.monotonic(), time.monotonic(), 0.0, 0.0
        self.say(name)
        yield
        self.list.append({"step": name, "seconds": round(time.monotonic() - start, 3)})
        if self.terminal and not self.quiet:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)

    def say(self, words):
        if not self.quiet:
            print(("\r\x1b[K" if self.terminal else "") + f"validate: {words}", file=sys.stderr, flush=True)

    def advance(self, what, amount):
        """On a terminal the line is written over; elsewhere a line comes every ten seconds at most."""
        with self.lock:
            self.done += amount
            spent = time.monotonic() - self.start
            if self.quiet or not (self.terminal or spent - self.told >= 10):
                return
            self.told = spent
            left = spent / self.done * max(0.0, self.total - self.done)
            line = f"validate: {min(1, self.done / max(self.total, 1e-9)):4.0%}  {what:52} {spent:5.0f} s, {left:.0f} s left"
            print("\r\x1b[K" + line if self.terminal else line, end="" if self.terminal else "\n", file=sys.stderr, flush=True)
