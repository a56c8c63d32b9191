# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Rendered plates: each picture with what its EXR says about it, and error against run time as a table."""
import base64
import html
import json
import math

from . import exr_header


def load(folder):
    """Entries of plates.json, or one per PNG; each with "data" (the PNG) and the EXR's header where there is one."""
    listing = folder / "plates.json"
    if listing.exists():
        entries = json.loads(listing.read_text())["plates"]
    else:
        entries = [{"name": png.stem, "png": png.name, "exr": png.with_suffix(".exr").name} for png in sorted(folder.glob("*.png"))]
    if not entries:
        raise ValueError(f"{folder} holds no PNG")
    loaded = []
    for entry in entries:
        exr = folder / entry["exr"] if entry.get("exr") else None
        header = exr_header.read(exr) if exr and exr.exists() else {}
        loaded.append(dict(entry, data=(folder / entry["png"]).read_bytes(), header=header))
    return loaded


def facts(plate):
    """(size, samples per pixel, seconds rendering, mean relative standard error, seed) as texts."""
    header = plate["header"]
    size = header.get("dataWindow")
    noise, seconds = header.get("noise"), header.get("seconds", plate.get("seconds"))
    return (f"{size[0]} × {size[1]}" if size else "–", str(header.get("samples", "–")),
            f"{seconds:.1f}" if seconds is not None else "–",
            f"{noise:.2%}" if noise is not None and math.isfinite(noise) else "–", html.escape(str(header.get("seed", "–"))))


def section(plates):
    figures, rows = [], []
    for plate in plates:
        caption = html.escape(plate.get("caption", plate["name"]))
        size, samples, seconds, noise, seed = facts(plate)
        data = base64.b64encode(plate["data"]).decode()
        figures.append(f'<figure><img alt="{caption}" src="data:image/png;base64,{data}"><figcaption>{caption} · {samples} samples'
                       f" per pixel, {seconds} s, noise {noise}</figcaption></figure>")
        command = html.escape(plate.get("command") or plate["header"].get("command", ""))
        rows.append(f"<tr><td>{caption}</td><td>{size}</td><td>{samples}</td><td>{seconds}</td><td>{noise}</td><td>{seed}</td>"
                    f"<td><code>{command}</code></td></tr>")
    return ('<h2 id="plates">Rendered plates</h2>\n<p>Rendered through the shared-object plugin. Noise is the mean over pixels of '
            "the standard error of luminance over luminance, of the very image shown.</p>\n"
            f'<div class="plates">{"".join(figures)}</div>\n<h3>Error against run time</h3>\n<table><thead><tr><th>plate</th>'
            "<th>size</th><th>samples per pixel</th><th>seconds</th><th>noise</th><th>seed</th><th>command</th></tr></thead>"
            f"<tbody>{''.join(rows)}</tbody></table>")
