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
    lines = [series for series in curve["series"] if series.get("line")]  # points of many lines are told apart by the table
    inks = plt.get_cmap("tab20" if len(curve["series"]) > 10 else "tab10").colors
    for k, series in enumerate(curve["series"]):
        xs, ys = [p["x"] for p in series["points"]], [p["y"] for p in series["points"]]
        ink, law = inks[k % len(inks)], series.get("fit")
        name = series["name"] + (f": slope {law['slope']:+.2f}" + (f" ± {law['error']:.2f}" if law["error"] is not None else "") if law else "")
        axis.plot(xs, ys, linestyle="-" if series.get("line") else "", marker="o", markersize=4, label=name, color=ink)
        if law:
            ends = [min(xs), max(xs)]
            axis.plot(ends, [law["factor"] * x ** law["slope"] for x in ends], linestyle="--", linewidth=1, color=ink)
        bars = [(p["x"], p["y"], p["y_error"]) for p in series["points"] if p.get("y_error")]
        if bars:
            axis.errorbar(*zip(*((x, y) for x, y, _ in bars)), yerr=[[min(e, 0.9 * y) for _, y, e in bars], [e for *_, e in bars]], fmt="none", linewidth=0.8, color=ink)
        crowded = len(series["points"]) >= 20 or (series.get("line") and len(lines) > 2 and series is not lines[0])
        for p in [] if crowded else series["points"]:
            axis.annotate(p.get("label", ""), (p["x"], p["y"]), xytext=(4, 3), textcoords="offset points", fontsize=7, color=ink)
    axis.set(xlabel=curve["x"]["label"], ylabel=curve["y"]["label"], xscale="log" if curve["x"].get("log") else "linear",
             yscale="log" if curve["y"].get("log") else "linear")
    axis.grid(alpha=0.3)
    axis.legend(fontsize=8)
    data = io.BytesIO()
    figure.savefig(data, format="png", dpi=110, bbox_inches="tight")
    plt.close(figure)
    return data.getvalue()


def number(x):
    return f"{x:.0f}" if abs(x) >= 1000 else f"{x:.4g}"


def table(curve):
    """A row for each series and a column for each label if labels recur, y above x; else a row for each point."""
    x, y = (html.escape(curve[axis]["label"]) for axis in "xy")
    every = [p.get("label", "") for series in curve["series"] for p in series["points"]]
    labels = list(dict.fromkeys(every))
    if any("megabytes" in p for series in curve["series"] for p in series["points"]):
        return resources(curve, x, y)
    if len(labels) > 12 or len(labels) == len(every):
        rows = "".join(f"<tr><td>{html.escape(series['name'])}</td><td>{html.escape(p.get('label', ''))}</td><td>{number(p['x'])}</td><td>{p['y']:.3g}</td></tr>"
                       for series in curve["series"] for p in series["points"])
        return f"<table><thead><tr><th></th><th></th><th>{x}</th><th>{y}</th></tr></thead><tbody>{rows}</tbody></table>"
    rows = []
    for series in curve["series"]:
        at = {p.get("label", ""): f"{p['y']:.3g}<br><span class=faint>{number(p['x'])}</span>" for p in series["points"]}
        rows.append(f"<tr><td>{html.escape(series['name'])}</td>{''.join(f'<td>{at.get(label, chr(8211))}</td>' for label in labels)}</tr>")
    heads = "".join(f"<th>{html.escape(label)}</th>" for label in labels)
    return f'<table><caption>{y}, below it {x}</caption><thead><tr><th></th>{heads}</tr></thead><tbody>{"".join(rows)}</tbody></table>'


def resources(curve, x, y):
    """A row for each point, with what it took."""
    columns = [("seconds", "wall s"), ("cpu_seconds", "processor s"), ("megabytes", "MB")]
    rows = []
    for series in curve["series"]:
        for p in series["points"]:
            error = f" ± {p['y_error']:.1g}" if p.get("y_error") else ""
            cells = [html.escape(series["name"]), html.escape(p.get("label", "")), number(p["x"]), f"{p['y']:.3g}{error}", *(number(p[key]) for key, _ in columns)]
            rows.append(f"<tr>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>")
    heads = "".join(f"<th>{head}</th>" for head in ("", "", x, y, *(name for _, name in columns)))
    return f"<table><thead><tr>{heads}</tr></thead><tbody>{''.join(rows)}</tbody></table>"


def section(curves):
    return ('<h2 id="curves">Error against run time</h2>\n<p>Error and time of a curve were measured in the same run.</p>\n' + figures(curves))


def figures(curves):
    parts = []
    for curve in curves:
        title, data = html.escape(curve["title"]), base64.b64encode(picture(curve)).decode()
        parts.append(f'<h3>{title}</h3><p>{html.escape(curve.get("text", ""))}</p><figure><img alt="{title}" src="data:image/png;base64,{data}">'
                     f'<figcaption>{title} · <code>{html.escape(curve.get("command", ""))}</code></figcaption></figure>{table(curve)}')
    return "\n".join(parts)
