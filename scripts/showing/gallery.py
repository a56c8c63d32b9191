# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Makes the pictures: surfaces.png, lobes.png, gallery.json, fragment.html."""
import argparse
import base64
import html
import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tests"))
import exr  # noqa: E402

from . import lobes, surfaces  # noqa: E402


class GalleryError(Exception):
    """The program failed; the message holds its own words."""


def call(*command, stdin=None):
    done = subprocess.run([str(part) for part in command], input=stdin, capture_output=True, text=True)
    if done.returncode:
        raise GalleryError(f"musurf {command[1]}: {(done.stderr or done.stdout).strip().splitlines()[-1:]}")
    return done.stdout


def asker(musurf):
    def ask(questions):
        return [json.loads(line) for line in call(musurf, "eval", stdin="".join(json.dumps(q) + "\n" for q in questions)).splitlines()]
    return ask


def figure(path, caption):
    data, text = base64.b64encode(path.read_bytes()).decode(), html.escape(caption)
    return f'<figure><img alt="{text}" src="data:image/png;base64,{data}"><figcaption>{text}</figcaption></figure>'


def fragment(result, folder):
    rows = "".join(f"<tr><td>{html.escape(s['name'])}</td><td>{s['total_variation']:.4f}</td><td>{s['deviation'][0]:.2%}</td><td>{s['deviation'][1]:.2%}</td>"
                   f"<td>{s['steepest']:.3g}</td></tr>" for s in result["surfaces"])
    light = "; ".join(f"{lobe['name']}: {lobe['albedo']:.4f}" for lobe in result["lobes"])
    return ("<h2>Surfaces and lobes</h2>\n" + figure(folder / "surfaces.png", f"Heightfields of {result['size']}² cells by musurf surface make, lit from the upper left, "
            "and the slopes of their facets (to the 99th percentile) against the law.")
            + "<table><thead><tr><th>law</th><th>total variation of U facets’ slopes</th><th>relative rms of 20 equal masses, L</th><th>U</th><th>steepest slope</th></tr></thead>"
            f"<tbody>{rows}</tbody></table>\n"
            + figure(folder / "lobes.png", "Lobes of GGX, α = 0.3, under M: f cos θ over incident directions for a view at 50° (red line, blue cross): in space, from above, "
                     "and cut along the view’s plane; 1/sr.")
            + f"<p>Light that leaves after one reflection, as the integral of what is drawn: {html.escape(light)}.</p>\n"
            f"<p class=faint><code>{html.escape(result['command'])}</code></p>\n")


def run(options, build):
    os.environ.setdefault("MPLBACKEND", "Agg")
    import matplotlib.pyplot as plt

    musurf, folder = build / "musurf", pathlib.Path(options.output)
    folder.mkdir(parents=True, exist_ok=True)
    ask, size, shown, told = asker(musurf), 64 if options.quick else 256, [], []
    with tempfile.TemporaryDirectory(prefix="musurf-gallery-") as scratch:
        for ndf, given in surfaces.LAWS:
            file = pathlib.Path(scratch) / "surface.exr"
            law = [part for key, value in given.items() for part in (f"--{key}", value)]
            made = json.loads(call(musurf, "surface", "make", "--ndf", ndf, *law, "--size", size, "--seed", 1, "-o", file))
            h = next(iter(exr.read(file)[1].values())).astype(float)
            found = surfaces.compared(h, ask, ndf, given)
            shown.append((ndf, given, h, found))
            told.append({"name": surfaces.named(ndf, given), "total_variation": found["total_variation"],
                         **{key: made[key] for key in ("deviation", "steepest", "limit", "range")}})
    surfaces.draw(plt, shown, folder / "surfaces.png")
    result = {"command": options.command, "size": size, "surfaces": told,
              "lobes": lobes.draw(plt, ask, 24 if options.quick else 72, folder / "lobes.png")}
    for name, text in (("gallery.json", json.dumps(result, indent=1, ensure_ascii=False)), ("fragment.html", fragment(result, folder))):
        (folder / f"{name}.new").write_text(text, encoding="utf-8")
        (folder / f"{name}.new").replace(folder / name)
    return result


def main(arguments, build):
    parser = argparse.ArgumentParser("scripts/gallery", description="Draws a surface of every distribution, its slopes against the law, and lobes of the BRDF "
                                     "under several M. Leaves the pictures, gallery.json and fragment.html for scripts/report. Exit 0; 1 if musurf failed; 2 on wrong usage.")
    parser.add_argument("--quick", action="store_true", help="small")
    parser.add_argument("-o", metavar="DIR", dest="output", default=str(build / "gallery"))
    options = parser.parse_args(arguments)
    options.command = " ".join(["scripts/gallery", *arguments])
    try:
        run(options, build)
    except (OSError, GalleryError) as error:
        print(f"gallery: {error}", file=sys.stderr)
        return 1
    print(pathlib.Path(options.output) / "gallery.json")
    return 0
