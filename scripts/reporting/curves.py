# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Curves of error against run time: a picture with the numbers below it, for each JSON file of a folder (measure.py)."""
import base64
import html
import io
import json
import os


def load(folder):
    found = [json.loads(path.read_text()) for path in sorted(folder.glob("*.json"))]
    if not found:
        raise ValueError(f"{folder} holds no curve")
    return found


def picture(curve):
    """PNG of the curve. The drawing library is asked for here: a report without curves does not need it."""
    os.environ.setdefault("MPLBACKEND", "Agg")
    import matplotlib.pyplot as plt

    figure, axis = plt.subplots(figsize=(9, 5))
    for k, series in enumerate(curve["series"]):
        xs, ys = [p["x"] for p in series["points"]], [p["y"] for p in series["points"]]
        axis.plot(xs, ys, linestyle="-" if series.get("line") else "", marker="o", markersize=4, label=series["name"], color=f"C{k}")
        for p in series["points"] if len(series["points"]) < 20 else []:
            axis.annotate(p.get("label", ""), (p["x"], p["y"]), xytext=(4, 3), textcoords="offset points", fontsize=7, color=f"C{k}")
    axis.set(xlabel=curve["x"]["label"], ylabel=curve["y"]["label"], xscale="log" if curve["x"].get("log") else "linear",
             yscale="log" if curve["y"].get("log") else "linear")
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8)
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=110, bbox_inches="tight")
    plt.close(figure)
    return data.getvalue()


def section(curves):
    parts = ['<h2 id="curves">Error against run time</h2>', "<p>Error and time of a curve were measured in the same run.</p>"]
    for curve in curves:
        title, data = html.escape(curve["title"]), base64.b64encode(picture(curve)).decode()
        rows = "".join(f"<tr><td>{html.escape(series['name'])}</td><td>{html.escape(p.get('label', ''))}</td><td>{p['x']:.4g}</td><td>{p['y']:.3g}</td></tr>"
                       for series in curve["series"] for p in series["points"])
        parts.append(f'<h3>{title}</h3><p>{html.escape(curve.get("text", ""))}</p><figure><img alt="{title}" src="data:image/png;base64,{data}">'
                     f'<figcaption>{title} · <code>{html.escape(curve.get("command", ""))}</code></figcaption></figure><table><thead><tr><th></th><th></th>'
                     f"<th>{html.escape(curve['x']['label'])}</th><th>{html.escape(curve['y']['label'])}</th></tr></thead><tbody>{rows}</tbody></table>")
    return "\n".join(parts)
