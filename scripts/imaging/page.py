# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The study as text, as a section of the report, and as the README's table."""
import base64
import html

from reporting import curves as drawing

from . import draw, techniques, verdicts
from . import effort as efforts

HEADS = ["technique", "reads", "frame", "shading", "FLIP, α_lin < 0.5", "> 0.5", "relative error, < 0.5", "> 0.5"]

NOTE = "*: what a scene that names no reads gets."


def row(entry, bent):
    means = [("–" if entry[key][place] is None else f"{entry[key][place]:.4f}" if key == "flip_means" else f"{entry[key][place]:.3f}")
             for key in ("flip_means", "relative_means") for place in ("below", "above")]
    return [entry["label"] + (" *" if entry["integrator"] == techniques.DEFAULT else ""), f"{entry['reads']:.3g}", f"{entry['frame']:.2f}", f"{entry['shading_ns'] / bent['shading_ns']:.2f}", *means]


def rows(found):
    bent = verdicts.of(found, by=techniques.BASELINE)
    return [row(entry, bent) for entry in found]


def verdict(claim):
    return "holds" if claim["holds"] else "DOES NOT HOLD"


def summary(result):
    widths = (30, 6, 7, 8, 18, 7, 22, 7)
    for cells in [HEADS, *rows(result["techniques"])]:
        yield "  " + " ".join(f"{cell:<{w}}" if k == 0 else f"{cell:>{w}}" for k, (cell, w) in enumerate(zip(cells, widths)))
    for scene in result["scenes"]:
        yield f"  {scene['name']} ({scene['environment']}): " + ", ".join(f"{e['label']} {e['flip']:.4f} (frame {e['frame']:.2f})" for e in scene["techniques"])
    for claim in result["claims"]:
        yield f"{verdict(claim)}: {claim['claim']} {claim['number']}"


def table(head, body):
    made = "".join("<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in cells) + "</tr>" for cells in body)
    return f"<table><thead><tr>{''.join(f'<th>{html.escape(h)}</th>' for h in head)}</tr></thead><tbody>{made}</tbody></table>"


def figure(folder, name, caption):
    data, text = base64.b64encode((folder / name).read_bytes()).decode(), html.escape(caption)
    return f'<figure><img alt="{text}" src="data:image/png;base64,{data}"><figcaption>{text}</figcaption></figure>'


def about(result):
    noise = result["noise_means"]
    return (f"Silver spheres (GGX) of α_lin {', '.join(f'{x:g}' for x in result['roughness'])} and η {', '.join(f'{x:g}' for x in result['anisotropy'])}, {result['effort']['cell']} pixels wide "
            f"each, under {', '.join(result['environments'])}; against {2 * result['effort']['truth']} paths a pixel, whose two halves differ by FLIP "
            f"{noise['flip']['below']:.4f} (α_lin < 0.5) and {noise['flip']['above']:.4f}. A frame is the processor time of one thread for the whole picture, shading that less camera "
            "rays and what they meet, both with the bent normal = 1, medians of the same run.")


def fragment(result, folder, curves, shown):
    judged = "".join(f'<tr class="{"agrees" if c["holds"] else "fails"}"><td class=text>{html.escape(c["claim"])}</td>'
                     f'<td class=text>{html.escape(c["number"])}</td><td>{verdict(c)}</td></tr>' for c in result["claims"])
    scenes = [[s["name"], s["environment"], e["label"], f"{e['frame']:.2f}", f"{e['flip']:.4f}", f"{e['relative']:.3f}", f"{s['noise']['flip']:.4f}"] for s in result["scenes"] for e in s["techniques"]]
    return ("<h2>Image-based lighting</h2>\n<p>Techniques of <code>musurf render --integrator</code> (Cocco, Zanni and Chermain 2024) against path tracing. "
            f"{html.escape(about(result))}</p>\n"
            f"<table><thead><tr><th>claim</th><th>found</th><th>verdict</th></tr></thead><tbody>{judged}</tbody></table>\n"
            + table(HEADS, rows(result["techniques"])) + "<p class=faint>" + NOTE + "</p>\n"
            + "\n".join(figure(folder, name, caption) for name, caption in shown)
            + ("<p>Whole scenes. The pot shades itself in the truth, and in no other picture.</p>" if scenes else "")
            + (table(["scene", "environment", "technique", "frame", "FLIP", "relative error", "FLIP of the truth’s halves"], scenes) if scenes else "")
            + drawing.figures(curves) + f"<p class=faint>{result['seconds']:.0f} s. <code>{html.escape(result['command'])}</code></p>\n")


def readme(result):
    bent = verdicts.of(result["techniques"], by=techniques.BASELINE)
    chosen = [e for e in result["techniques"] if e["integrator"].get("reads") in (None, 4, 8, 16, 64, "auto") or e["integrator"] == {"by": techniques.FILTERED, "reads": efforts.FILTERED}]
    lines = ["| " + " | ".join(cells) + " |" for cells in [HEADS, ["---"] * len(HEADS), *(row(entry, bent) for entry in chosen)]]
    scenes = [f"{s['name']} under {s['environment']}: " + ", ".join(f"{e['label']} {e['flip']:.4f}" for e in s["techniques"]) for s in result["scenes"]]
    claims = [f"- {verdict(c)}: {c['claim']} ({c['number']})" for c in result["claims"]]
    return about(result) + "\n\n" + "\n".join(lines) + "\n\n" + NOTE + "\n\n" + ("Mean FLIP of whole scenes: " + "; ".join(scenes) + ".\n\n" if scenes else "") + "\n".join(claims) + "\n"
