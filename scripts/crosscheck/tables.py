# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The verdicts as words, as JSON and as HTML tables."""
import html
import json
import math

from . import verdicts

EXPLAIN = {
    "masking": "(a) Bits of visibility of the original from v (POV-Ray's height_field) against those of the transformed mesh, "
               "M baked into its vertices, from Mv/|Mv|, at the same points, 9 in each facet. "
               "Eq. (11), pure geometry; at most 1e-4 may differ, for rays that graze an edge within POV-Ray's precision.",
    "control": "The same comparison with the light in a wrong direction. It must fail ten times over, or the masking check "
               "would prove nothing.",
    "D facet by facet": "(b) Eq. (22) for every facet: the core's D at the baked facet's normal under M, against its D at the "
               "original facet's without M, by the facets' own cosines and |det M|; for the analytic D and for the measured one, "
               "tabulated. An identity to rounding; the bound follows from the vertices' rounding.",
    "D of normals": "(b) Normals of the transformed facets against the analytic D_M integrated over polar bins of slope: total "
               "variation, against what the bins' standard errors make by chance.",
    "sigma": "Projected area of the facing facets per unit macro area at Mv, against the core's sigma. The interval counts in what "
               "the clipped tail lacks.",
    "G1 projected mean": "(c) Visible over facing projected area against G1. For every periodic heightfield this is cos/sigma: "
               "it tests D, sigma and the use of M (Eq. 12), not Smith's assumption. Plus 1e-3 for 9 points per facet.",
    "G1 per slope": "(c) Average visibility of the facets whose slope along the view, over alpha, lies in a bin. Smith gives one "
               "value to all; explicit surfaces do not.",
    "visible normals": "(c) Normals weighted by visible projected area against D_v under M (Eq. 28): total variation. Known: half "
               "the sum over normals of what G1 is known to be off at their slope.",
    "G2 / (G1 G1)": "(d) Being seen by both over what independence predicts, for facets of like normals, against the separable, the "
               "height- and the direction-correlated form. Known: between the form and full correlation.",
    "G2 itself": "(d) G2 is symmetric, between independence and the smaller G1, and the same inside the BRDF.",
    "albedo, one reflection": "(e) Light that leaves after one reflection by mirror facets, and by dielectric facets (n = 5, POV-Ray's own "
               "Fresnel), against the integral of the single-scatter BRDF under M.",
    "BRDF per bin": "(e) The same light per bin of 7.5 by 15 degrees of the outgoing direction: total variation.",
    "energy, all reflections: compensation": "(f) Light that leaves after up to 20 reflections by dielectric facets (n = 5), against the "
               "albedo of the compensated BRDF.",
    "energy, all reflections: random walk": "(f) The same against the random walk on the Smith microsurface.",
    "energy conserved": "(f) Light that leaves perfect mirrors after up to 20 reflections: all of it, or the image would be wrong.",
}
COLUMNS = (("surface", "surface"), ("map", "M"), ("view", "view"), ("tracer", "tracer"), ("lit_from", "lit from"), ("form", "form"),
           ("fresnel", "Fresnel"), ("bin", "bin"), ("low", "slope from"), ("high", "to"), ("different", "differing bits"),
           ("total", "of"), ("different_from_mesh", "from the untransformed mesh"), ("facets", "facets"), ("share", "share"),
           ("measured", "measured"), ("confidence", "99 % confidence"), ("predicted", "core"), ("deviation", "deviation"),
           ("known", "known range"), ("source", "source"), ("tolerance", "tolerance"), ("rms", "rms per bin"), ("verdict", "verdict"))
PERCENT = {"deviation", "rms"}


def finite(value):
    """The value with infinities as null, fit for JSON."""
    if isinstance(value, dict):
        return {k: finite(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [finite(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def dumps(value):
    return json.dumps(finite(value), indent=1, ensure_ascii=False, default=lambda x: x.tolist()) + "\n"


def words(group):
    """What says most about rows of one check, surface and M."""
    check = group[0]["check"]
    if check in ("masking", "control"):
        extreme = (max if check == "masking" else min)(group, key=lambda r: r["share"])
        most, limit = ("most", "at most") if check == "masking" else ("fewest", "at least")
        return f"{most} {extreme['different']} of {extreme['total']} bits differ ({extreme['share']:.1e}; {limit} {extreme['tolerance']:.0e})"
    if check == "D facet by facet":
        return f"at most {max(r['measured'] for r in group):.1e} off (tolerance {group[0]['tolerance']:.1e})"
    if check == "energy conserved":
        return f"at least {min(r['measured'] for r in group):.5f} of the light (1 - {group[0]['tolerance']:.0e})"
    if check == "G2 itself":
        return f"{sum(r['verdict'] == verdicts.AGREES for r in group)} of {len(group)} sound"
    if check in ("D of normals", "visible normals", "BRDF per bin"):
        extreme = max(group, key=lambda r: r["measured"] - r["predicted"])
        return f"total variation {extreme['measured']:.4f} +- {extreme['standard_error']:.4f} (by chance {extreme['predicted']:.4f})" + \
            (f" at {extreme['view']}" if extreme["view"] != "all" else "")
    extreme = max(group, key=lambda r: abs(r["deviation"]))
    return f"largest deviation {extreme['deviation']:+.2%} ({extreme['measured']:.4f} +- {extreme['standard_error']:.4f}, " \
           f"core {extreme['predicted']:.4f}) at {extreme.get('form', '')}{' ' if 'form' in extreme else ''}{extreme['view']}"


def lines(rows):
    """One line per check, surface and M: verdict, tracer, and the number that says most."""
    for check in EXPLAIN:
        for place in dict.fromkeys((r["surface"], r["map"]) for r in rows if r["check"] == check):
            group = [r for r in rows if r["check"] == check and (r["surface"], r["map"]) == place]
            yield f"{verdicts.worst(group):29} {', '.join((check, *place)):62} {group[0]['tracer']:7} {words(group)}"


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
    """One HTML section per check, its table folded: there are many rows."""
    parts = []
    for check, said in EXPLAIN.items():
        group = [r for r in rows if r["check"] == check]
        if group:
            counts = ", ".join(f"{sum(r['verdict'] == v for r in group)} {v}" for v in
                               (verdicts.AGREES, verdicts.KNOWN, verdicts.FAILS) if any(r["verdict"] == v for r in group))
            parts.append(f"<h3>{check}: {counts}</h3>\n<p>{html.escape(said)}</p>\n<details><summary>{len(group)} rows</summary>\n"
                         f"{table(group)}</details>")
    return "\n".join(parts)
