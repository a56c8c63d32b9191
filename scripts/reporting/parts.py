# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Runs what the report shows, part after part. One that fails is told in the page and loses none of the others.

Each part leaves a file; one that was not written since the part began is an older run's, and is not shown as this one's.
"""
import datetime
import html
import os
import pathlib
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
# name: (command, its quick form, the file that it leaves below the build folder)
PARTS = {"gallery": (["scripts/gallery"], ["--quick"], [], "gallery/gallery.json"),
         "plates": (["scripts/demo", "--plates-only"], ["--spp", "8", "--size", "320x180"], [], "plates/plates.json"),
         "curves": (["scripts/curves"], [], [], "curves/1-masking-time.json"),
         "costs": (["scripts/costs"], ["--quick"], [], "costs/costs.json"),
         "efficiency": (["scripts/efficiency"], ["--quick"], [], "efficiency/efficiency.json"),
         "ibl": (["scripts/ibl"], ["--quick"], [], "ibl/ibl.json"),
         "geometry": (["scripts/geometry-pair"], ["--quick"], [], "geometry/geometry.json"),
         "deformed": (["scripts/geometry-tension"], ["--quick"], [], "geometry-tension/deformed.json"),
         "figures": (["scripts/figures"], ["--quick"], [], "figures/figures.json"),
         "validate": (["scripts/validate"], ["--quick"], ["--full"], "validate/validate.json")}


def run(build, quick, names=tuple(PARTS)):
    """[{"name", "command", "code", "seconds", "fresh", "said"}]; "said" is the last line of a failed part's standard error."""
    found = []
    for number, name in enumerate(names, 1):
        command, short, long, file = PARTS[name]
        command = [*command, *(short if quick else long)]
        print(f"report: [{number}/{len(names)}] {' '.join(command)}", file=sys.stderr, flush=True)
        start, began, last = time.monotonic(), time.time(), ""
        child = subprocess.Popen([sys.executable, str(ROOT / command[0]), *command[1:]], cwd=ROOT, env=dict(os.environ, BUILD=str(build)), stdin=subprocess.DEVNULL,
                                 stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace")
        try:
            for line in child.stderr:
                print(line, end="", file=sys.stderr, flush=True)
                last = line.strip() or last
            code = child.wait()
        except BaseException:
            child.terminate()
            child.wait()
            raise
        left = build / file
        found.append({"name": name, "command": " ".join(command), "code": code, "seconds": round(time.monotonic() - start, 1),
                      "fresh": left.exists() and left.stat().st_mtime >= began - 1, "said": last if code else ""})
    return found


def section(found):
    """The command lines, and how they ended."""
    rows = "".join(f'<tr class="{"fails" if p["code"] else ""}"><td>{p["name"]}</td><td><code>{html.escape(p["command"])}</code></td><td>{p["seconds"]:.0f}</td>'
                   f'<td>{p["code"]}</td><td class=text>{html.escape(p["said"])}</td></tr>' for p in found)
    return ('<h2 id="parts">Command lines</h2>\n<p>What was run for this page, from the top of the source tree. Exit code 1 of the cross-check can also mean that a check '
            f"failed. Made {datetime.datetime.now().astimezone():%Y-%m-%d %H:%M %Z}.</p>\n<table><thead><tr><th>part</th><th>command</th><th>seconds</th><th>exit</th>"
            f"<th>last words</th></tr></thead><tbody>{rows}</tbody></table>")
