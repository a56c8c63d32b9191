#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""How often the page draws its sphere of 512² pixels, on two cores, in headless Chromium, which draws the page on them, too: while the light
turns, and while M is dragged and everything follows. The goal is 30 a second with the N that the page opens with; a machine that is
busy otherwise gives no verdict."""
import os
import pathlib
import subprocess
import sys
import time

import chromium
from command import BUILD, ROOT

GOAL, SECONDS, MOST = 30, 5, 0.1
TURN = "document.getElementById('play').click(); const step = () => 0"
DRAG = """const input = document.querySelector('[data-key="M.1"]'); let n = 0;
          const step = () => { input.value = 2 + Math.sin(++n / 20); input.dispatchEvent(new Event("input", { bubbles: true })); }"""
MEASURE = """new Promise((done) => {{
    {what};
    const frames = () => Number(document.getElementById("status").dataset.frames);
    let before, begun = 0;
    const next = (now) => {{
        step();
        if (!begun) begun = now;
        if (before === undefined && now - begun > 1000) before = frames(), begun = now; // warm
        if (before !== undefined && now - begun > {milliseconds}) done(1000 * (frames() - before) / (now - begun));
        else requestAnimationFrame(next);
    }};
    requestAnimationFrame(next);
}})"""


def busy(cores, seconds=2):
    """The share of their time that others take of these cores, now: what the load average tells is of the last minute, another benchmark's perhaps."""
    def times():
        rows = {line.split()[0]: [int(x) for x in line.split()[1:]] for line in pathlib.Path("/proc/stat").read_text().splitlines() if line.startswith("cpu")}
        return [sum(values) for values in zip(*(rows[f"cpu{core}"] for core in cores))]
    before = times()
    time.sleep(seconds)
    spent = [after - earlier for after, earlier in zip(times(), before)]
    return 1 - (spent[3] + spent[4]) / sum(spent)  # idle, and waiting for disks


def rate(state, what):
    with chromium.Page((BUILD / "musurf.html").as_uri() + "#size=512&" + state) as page:
        page.until("document.documentElement.dataset.ready && Number(document.getElementById('status').dataset.frames) > 0 && !musurf.sphere.busy")
        return page.run(MEASURE.format(what=what, milliseconds=1000 * SECONDS))


def main():
    if not chromium.program() or not pathlib.Path("/usr/lib/wasm32-wasi/libc.a").exists():
        print("the page: Chromium or wasi-libc is not installed, left out")
        return 0
    subprocess.run(["make", "run-page", f"BUILD={BUILD}"], cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    cores = sorted(os.sched_getaffinity(0))[:2]
    os.sched_setaffinity(0, cores)
    others = busy(cores)
    short = 0
    print(f"{'the page, 512² pixels, ' + str(len(cores)) + ' cores':44} {'light turns':>12} {'M is dragged':>13}  frames/s; goal: {GOAL}")
    for name, state in (("major axis, N = 8", ""), ("major axis, N = 16", "N=16"), ("bent normal", "technique=bent%20normal"),
                        ("whole lobe, N = 8", "technique=whole%20lobe"), ("one lamp, exact BRDF", "technique=lamp")):
        turning, dragging = rate(state, TURN), rate(state, DRAG)
        short += not state and min(turning, dragging) < GOAL
        print(f"{name:44} {turning:12.0f} {dragging:13.0f}", flush=True)
    if others > MOST:
        print(f"no verdict: other programs took {others:.0%} of the cores")
    return 1 if short and others <= MOST else 0


if __name__ == "__main__":
    sys.exit(main())
