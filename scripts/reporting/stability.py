# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The summary of `make stability` (scripts/precision): relative errors of `musurf eval`, as measured and beyond the inputs'."""
import base64
import html
import json

HOW = "make stability"
KEYS = ("median", "p99", "worst", "excess_worst", "of_allowed")
HEADS = ("", "format", "values", "median", "p99", "worst", "beyond inputs", "of the bound", "worst at")


def load(folder):
    """Numbers alone, with the pictures beside them; the single records stay in their own file."""
    found = json.loads((folder / "stability.json").read_text())
    pictures = [(path.stem, path.read_bytes()) for path in sorted(folder.glob("*.png"))]
    return {key: found[key] for key in ("points", "drawn", "failures", "summary", "told", "checks", "coverage") if key in found}, pictures


def table(heads, rows):
    cells = "".join("<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{''.join(f'<th>{html.escape(h)}</th>' for h in heads)}</tr></thead><tbody>{cells}</tbody></table>"


def held(found):
    """What was held to ranges alone, and what the questions were."""
    told = "".join(f"<p>{html.escape(text)}</p>" for text in found.get("told", []))
    checks = found.get("checks", {})
    names = list(dict.fromkeys(name for held in checks.values() for name in held["numbers"]))
    rows = [[name, *(held["numbers"].get(name, 0) for held in checks.values()), sum(held["failures"].get(name, 0) for held in checks.values())]
            for name in names]
    asked = table(("axis", "value", "questions", "values judged"), found["coverage"]) if found.get("coverage") else ""
    asked = asked and f"<details><summary>What was asked</summary>{asked}</details>"
    return told + (table(("held to ranges and bounds", *checks, "failures"), rows) if rows else "") + asked


def section(found, pictures):
    head = '<h2 id="stability">Numerical stability</h2>'
    if not found:
        return f"{head}<p>Not measured yet: <code>{HOW}</code> holds stiff and extreme cases, in float and double, to 50-digit answers.</p>"
    rows = []
    for quantity in next(iter(found["summary"].values())):
        for precision, sums in found["summary"].items():
            s = sums.get(quantity)
            if s:
                numbers = "".join(f"<td>{s[key]:.2g}</td>" for key in KEYS)
                rows.append(f"<tr><td>{html.escape(quantity)}</td><td>{precision}</td><td>{s['values']}</td>{numbers}<td class=text>{html.escape(str(s['where']))}</td></tr>")
    figures = "".join(f'<figure><img alt="error against {name}" src="data:image/png;base64,{base64.b64encode(data).decode()}">'
                      f"<figcaption>Relative error against {html.escape(name)}.</figcaption></figure>" for name, data in pictures)
    failures = "".join(f"<li>{html.escape(str(failure))}</li>" for failure in found["failures"])
    return (f"{head}<p>Relative errors over {found['points']} materials and directions against 50-digit answers: {len(found['failures']) or 'no'} failures. "
            "<i>Beyond inputs</i> is what is left of the worst when the rounding of the inputs themselves is taken off; an error must stay within "
            f"its bound (1). <code>{HOW}</code></p><table><thead><tr>{''.join(f'<th>{h}</th>' for h in HEADS)}</tr></thead><tbody>{''.join(rows)}</tbody>"
            f"</table>{f'<ul>{failures}</ul>' if failures else ''}{held(found)}{figures}")
