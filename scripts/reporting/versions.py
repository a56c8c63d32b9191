# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""With what the page was made: musurf and its libraries, POV-Ray, Python, the machine."""
import html
import json
import platform
import subprocess


def output(*command):
    """What a program prints, or nothing if it cannot be run."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=20)
    except (OSError, subprocess.TimeoutExpired):
        return ""
    return done.stdout


def flattened(value, prefix=""):
    for key, inner in value.items():
        if isinstance(inner, dict):
            yield from flattened(inner, f"{prefix}{key} ")
        elif isinstance(inner, (str, int, float)):
            yield f"{prefix}{key}", str(inner)


def processor():
    try:
        with open("/proc/cpuinfo") as file:
            names = [line.partition(":")[2].strip() for line in file if line.startswith("model name")]
        return f"{names[0]}, {len(names)} logical processors"
    except (OSError, IndexError):
        return platform.machine()


def gather(build, validation):
    rows = [("machine", processor()), ("system", f"{platform.system()} {platform.release()}"), ("python", platform.python_version())]
    try:
        rows += list(flattened(json.loads(output(str(build / "musurf"), "info", "--json")).get("build", {}), "musurf "))
    except ValueError:
        pass
    if validation.get("povray"):
        rows.append(("cross-check with", validation["povray"]))
    return rows


def section(rows):
    body = "".join(f"<tr><td>{html.escape(k)}</td><td>{html.escape(v)}</td></tr>" for k, v in rows)
    return f'<h2 id="versions">Versions</h2>\n<table><tbody>{body}</tbody></table>'
