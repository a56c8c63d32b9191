# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The verdicts as words, as JSON and as HTML tables."""
import html
import json
import math

from . import verdicts

EXPLAIN = {
    "masking": "Bits of visibility of the original from v (POV-Ray's height_field) against those of the transformed mesh, "
               "M baked into its vertices, from Mv/|Mv|, at the same points: 9 in each facet (\"facets\": the middle ones). "
               "Eq. (11), pure geometry; at most 1e-4 may differ, for rays that graze an edge within POV-Ray's precision.",
    "control": "The same comparison with the light in a wrong direction. It must fail by at least 1e-2 of the bits, or the "
               "masking check would prove nothing.",
    "G1 projected mean": "Visible over facing projected area, measured in POV-Ray, against the core's G1. For every "
               "periodic heightfield this is the identity cos/sigma, so it tests D, sigma and the use of M (Eq. 12), not "
               "Smith's assumption. Tolerance: Student's t of block errors at a family-wise level of 0.01, plus 1e-3 for 9 points per facet.",
    "sigma": "Projected area of the facing facets per unit macro area at Mv, over 16 surfaces, against the core's sigma.",
    "D of normals": "Normals of the transformed facets of 16 surfaces against the core's D_M (Eq. 22) integrated over polar "
               "bins of slope: total variation. Tolerance: what the bins' standard errors make by chance, plus four standard "
               "deviations. No facet is fitted; only the slopes' covariance is fixed.",
    "G1 per slope": "Average visibility of the facets whose slope along the view, over alpha, lies in a bin. Smith gives one "
               "value to all; Gaussian surfaces do not. The known deviation was measured beforehand by an exact caster.",
    "G2 / (G1 G1)": "Being seen by both over what independence predicts, for facets of like normals. The core's "
               "height-correlated G2 must lie between independence and the measurement, be symmetric, not exceed the smaller G1, "
               "and be the same within the BRDF f.",
}
COLUMNS = (("map", "M"), ("view", "view of the original"), ("lit_from", "lit from"), ("bin", "bin"), ("low", "slope from"),
           ("high", "to"), ("different", "differing bits"), ("total", "of"), ("different_from_mesh", "from the untransformed mesh"),
           ("different_facets", "facets"), ("share", "share"),
           ("measured", "measured"), ("standard_error", "standard error"), ("predicted", "core"), ("deviation", "deviation"),
           ("facet_mean", "facet mean"), ("facet_error", "its error"), ("chance", "chance"), ("known", "known deviation"),
           ("tolerance", "tolerance"), ("chance_mean", "expected by chance"), ("rms", "rms per bin"), ("verdict", "verdict"))
PERCENT = {"deviation", "known", "rms"}


def finite(value):
    """The value with infinities as null, fit for JSON."""
    if isinstance(value, dict):
        return {k: finite(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def dumps(value):
    return json.dumps(finite(value), indent=1, ensure_ascii=False, default=lambda x: x.tolist()) + "\n"


def worst(rows):
    order = [verdicts.AGREES, verdicts.KNOWN, verdicts.FAILS]
    return max((r["verdict"] for r in rows), key=order.index)


def lines(rows):
    """One line per check and M: verdict and the number that says most."""
    for check in EXPLAIN:
        for name in dict.fromkeys(r["map"] for r in rows if r["check"] == check):
            group = [r for r in rows if r["check"] == check and r["map"] == name]
            if check in ("masking", "control"):
                extreme = (max if check == "masking" else min)(group, key=lambda r: r["share"])
                most, limit = ("most", "at most") if check == "masking" else ("fewest", "at least")
                words = f"{most} {extreme['different']} of {extreme['total']} bits differ " \
                        f"({extreme['share']:.1e}; {limit} {extreme['tolerance']:.0e})"
            elif check == "D of normals":
                only = group[0]
                words = f"total variation {only['measured']:.4f} (by chance {only['chance_mean']:.4f}, " \
                        f"at most {only['tolerance']:.4f})"
            else:
                extreme = max(group, key=lambda r: abs(r["deviation"]))
                words = f"largest deviation {extreme['deviation']:+.2%} ({extreme['measured']:.4f} +- " \
                        f"{extreme['standard_error']:.4f}, core {extreme['predicted']:.4f}) at {extreme['view']}"
            yield f"{worst(group):29} {check + ', ' + name:34} {words}"


def cell(key, value):
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "–"
    if isinstance(value, (list, tuple)):
        return " to ".join(cell(key, v) for v in value)
    if isinstance(value, float):
        if math.isinf(value):
            return "−∞" if value < 0 else "∞"
        if key in PERCENT:
            return f"{value:+.2%}"
        return f"{value:.3g}" if abs(value) < 1e-3 or key in ("low", "high") else f"{value:.4f}"
    return html.escape(str(value))


def table(rows):
    keys = [(k, title) for k, title in COLUMNS if any(k in r for r in rows)]
    body = "".join("<tr class=\"%s\">%s</tr>\n" % (
        {"FAILS": "fails", "agrees": "agrees"}.get(r["verdict"], "known"),
        "".join(f"<td>{cell(k, r.get(k))}</td>" for k, _ in keys)) for r in rows)
    return "<table><thead><tr>%s</tr></thead>\n<tbody>%s</tbody></table>" % ("".join(f"<th>{t}</th>" for _, t in keys), body)


def sections(rows):
    """One HTML section per check."""
    parts = []
    for check, words in EXPLAIN.items():
        group = [r for r in rows if r["check"] == check]
        if group:
            parts.append(f"<h3>{check}: {worst(group)}</h3>\n<p>{html.escape(words)}</p>\n{table(group)}")
    return "\n".join(parts)


def steps(entries):
    body = "".join(f"<tr><td>{html.escape(e['step'])}</td><td>{e['seconds']:.2f}</td><td>{e['povray_seconds']:.2f}</td>"
                   f"<td>{e['megabytes']:.0f}</td></tr>" for e in entries)
    return ("<h3>Time and memory of each step</h3><table><thead><tr><th>step</th><th>seconds</th>"
            "<th>seconds inside POV-Ray, all processes</th><th>largest POV-Ray process, MB</th></tr></thead>"
            f"<tbody>{body}</tbody></table>")
