# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Sums the records up: per quantity the worst and the 99th percentile, as they are and beyond what the inputs explain."""
import html

import numpy as np

from .measure import ROWS



def symbol(row):
    return row.replace("Lambda", "Λ").replace("sigma", "σ")


FORMATS = ("double", "float")


def summary(records):
    """{precision: {quantity: numbers}}; percentiles are over the values that their inputs determine."""
    result = {}
    for precision in FORMATS:
        result[precision] = {}
        for quantity in ROWS:
            rows = [r for r in records if r["precision"] == precision and r["quantity"] == quantity]
            sure = [r for r in rows if r["determined"]]
            if not sure:
                continue
            worst = max(sure, key=lambda r: r["error"])
            beyond = max(sure, key=lambda r: r["excess"])
            column = {key: np.array([r[key] for r in sure]) for key in ("error", "ulp", "excess", "allowed")}
            result[precision][quantity] = {
                "values": len(rows), "undetermined": len(rows) - len(sure),
                "median": float(np.median(column["error"])), "p99": float(np.percentile(column["error"], 99)),
                "worst": worst["error"], "where": worst["id"], "ulp_p99": float(np.percentile(column["ulp"], 99)),
                "ulp_worst": float(column["ulp"].max()), "excess_p99": float(np.percentile(column["excess"], 99)),
                "excess_worst": beyond["excess"], "excess_where": beyond["id"],
                "of_allowed": float((column["error"] / column["allowed"]).max())}
    return result


def coverage(records, axes, wanted):
    """[(axis, value, questions, values judged in double and float)]; a question none of whose values has an exact one counts 0."""
    rows = []
    for axis, values in wanted.items():
        for value in values:
            judged = sum(r[axis] == value for r in records if axis in r)
            rows.append((axis, value, sum(a[axis] == value for a in axes), judged))
    return rows


def number(x):
    return "0" if x == 0 else f"{x:.1e}"


def full(sums):
    """Head and rows of the whole table."""
    head = ["", "format", "values", "not determined", "median", "p99", "worst", "p99 ULP", "worst ULP", "p99 beyond inputs",
            "worst beyond inputs", "of the bound", "worst at", "worst beyond inputs at"]
    rows = []
    for quantity in ROWS:
        for precision in FORMATS:
            s = sums[precision].get(quantity)
            if s:
                rows.append([symbol(quantity), precision, str(s["values"]), str(s["undetermined"]),
                             *(number(s[k]) for k in ("median", "p99", "worst")),
                             *(f"{s[k]:.3g}" for k in ("ulp_p99", "ulp_worst")),
                             *(number(s[k]) for k in ("excess_p99", "excess_worst")), f"{s['of_allowed']:.3f}", s["where"],
                             s["excess_where"] if s["excess_worst"] else ""])
    return head, rows


def short(sums):
    """Head and rows for the README."""
    head = ["", "double, p99", "worst", "beyond inputs", "float, p99", "worst", "beyond inputs"]
    return head, [[symbol(quantity), *(number(sums[precision][quantity][key]) for precision in FORMATS
                                                     for key in ("p99", "worst", "excess_worst"))]
                  for quantity in ROWS if all(quantity in sums[p] for p in FORMATS)]


def markdown(head, rows):
    return "".join("| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |\n"
                   for row in [head, ["---"] * len(head), *rows])


def as_html(head, rows):
    def line(cells, tag):
        return "<tr>" + "".join(f"<{tag}>{html.escape(cell)}</{tag}>" for cell in cells) + "</tr>\n"

    return "<table>\n" + line(head, "th") + "".join(line(row, "td") for row in rows) + "</table>\n"
