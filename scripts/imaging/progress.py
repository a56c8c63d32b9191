# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Lines on stderr: which step, how long it has taken, how long it will take by the share of the work that is done."""
import sys
import time


class Progress:
    def __init__(self, total):
        """total: of the steps' weights."""
        self.total, self.done, self.start, self.last = total, 0.0, time.monotonic(), 0.0

    def seconds(self):
        return time.monotonic() - self.start

    def step(self, what, weight):
        """Before a step."""
        now = self.seconds()
        if self.done == 0 or now - self.last > 1:
            left = f"{now / self.done * (self.total - self.done):.0f} s to go" if self.done > 0 and now > 1 else "?"
            print(f"ibl: {100 * self.done / self.total:3.0f} %  {what}; {now:.0f} s, {left}", file=sys.stderr, flush=True)
            self.last = now
        self.done += weight
