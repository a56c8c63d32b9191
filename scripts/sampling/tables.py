# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The study as text and as a fragment of the report: sentences, pictures inside, tables."""
import base64
import html

from . import noise

MODES = {"mis": "with light sampling", "bsdf": "BSDF sampling alone"}
CAPTIONS = {"figure9.png": "Figure 9 with the exact curves: G1 of GTR, and how far the spline of Appendix A is off between the integers.",
            "equation2.png": "Eq. (2), which defines masking: error of the spline (lines) and of exact masking (dashed).",
            "knot.png": "The torus knot of Figure 10: GTR, α = 0.3, γ = 1, lit by one rectangle.",
            "figure10.png": "Figure 10: samples per pixel for the noise that mixed sampling (Appendix B) leaves."}


def cell(value):
    if isinstance(value, float):
        return f"{value:.3g}"
    return html.escape("–" if value is None else str(value))


def table(heads, rows):
    body = "".join("<tr>" + "".join(f"<td>{cell(v)}</td>" for v in row) + "</tr>" for row in rows)
    return f"<table><thead><tr>{''.join(f'<th>{h}</th>' for h in heads)}</tr></thead><tbody>{body}</tbody></table>"


def picture(folder, name):
    data = base64.b64encode((folder / name).read_bytes()).decode()
    caption = html.escape(CAPTIONS[name])
    return f'<figure><img alt="{caption}" src="data:image/png;base64,{data}"><figcaption>{caption}</figcaption></figure>'


def summary(result):
    """One line for each mode, and one of masking."""
    lines = []
    for mode, name in MODES.items():
        mean = result["averages"][mode]
        lines.append(f"{name}: over {len(noise.GAMMAS) * len(noise.STRETCHES)} settings, samples for the noise of mixed: "
                     + ", ".join(f"{name} {row['samples']:.3f}" + (f" ± {row['standard_error']:.3f}" if row["standard_error"] is not None else "")
                                 for name, row in mean.items())
                     + f"; at most {result['goal']:g}: "
                     + ", ".join(f"{'reached' if good else 'MISSED'} by {sampler}" for sampler, good in result["reached"][mode].items()))
    worst = max(result["figure9"], key=lambda row: row["largest"])
    lines.append(f"the spline's G1 is off by up to {worst['largest']:.3f} (alpha {worst['alpha']:g}, gamma {worst['gamma']:g}, theta {worst['theta']:g}: "
                 f"{worst['spline']:.3f} for {worst['exact']:.3f})")
    return lines


def averages(result):
    rows = [(MODES[mode], name, row["samples"], row["standard_error"], row["samples_relative_noise"], row["time"], row["variance"])
            for mode, found in result["averages"].items() for name, row in found.items()]
    return table(("", "sampler", "samples for equal noise", "standard error", "the same by relative noise", "processor time for equal noise",
                  "variance at equal samples"), rows)


def readme(result):
    """Figure 10 as a table: averages over its settings, in units of the paper's mixed sampling, with standard errors."""
    effort = result["effort"]
    def said(mode, name):
        row = result["averages"][mode].get(name)
        return "" if row is None else f"{row['samples']:.2f}" + (f" ± {row['standard_error']:.2f}" if row["standard_error"] else "")
    lines = ["Samples per pixel for equal noise, over those of the paper's mixed sampling with one light sample per event, averaged over "
             "γ 0.1, 1, 4", f"and s 0, 0.25, 0.5, 0.75 (α = 0.3; {effort['size'][0]} × {effort['size'][1]} pixels, "
             f"{' and '.join(map(str, effort['counts']))} samples, {effort['seeds']} seeds; standard errors by the jackknife):", "",
             "|  | " + " | ".join(MODES.values()) + " |", "| --- |" + " --- |" * len(MODES)]
    lines += [f"| {name} | " + " | ".join(said(mode, name) for mode in MODES) + " |" for name in result["averages"]["mis"]]
    return "\n".join(lines) + "\n"


def settings(result):
    names = noise.MODES["mis"]
    rows = [(MODES[x["mode"]], float(x["gamma"]), float(x["s"]), x["chosen"], *(x["samplers"][n]["samples"][0] if n in x["samplers"] else None for n in names))
            for x in result["figure10"]]
    return table(("", "γ", "s", "auto is", *names), rows)


def fragment(result, folder):
    effort = result["effort"]
    names = ("ndf", "mixed", "visible", "visible_uniform", "folded")
    parts = [
        "<h2>Masking and sampling against the paper's own</h2>", "".join(f"<p>{html.escape(line)}.</p>" for line in summary(result)),
        f"<p><code>{html.escape(result['command'])}</code> · {result['seconds']:.0f} s</p>", picture(folder, "figure9.png"),
        table(("α", "largest error of G1", "at γ", "at θ", "exact", "spline", "mean error", "share of values at 1", "error at integers"),
              [(r["alpha"], r["largest"], r["gamma"], r["theta"], r["exact"], r["spline"], r["mean"], r["at_1"], r["at_integers"])
               for r in result["figure9"]]),
        "<h3>Against Eq. (2)</h3><p>Masking is what makes the visible facets fill the view: ∫ D(m) G1(v) max(0, v·m) dm = cos θ. Integrated "
        "with D and G1 as <code>musurf eval</code> says them, relative to cos θ. What exact masking leaves is of this integral.</p>",
        picture(folder, "equation2.png"),
        table(("α", "masking", "largest error of Eq. (2)", "at γ", "at θ", "mean error"),
              [(r["alpha"], r["smith"], r["largest"], r["gamma"], r["theta"], r["mean"]) for r in result["equation2"]]),
        "<h3>Noise on the torus knot</h3>",
        f"<p>{effort['size'][0]} × {effort['size'][1]} pixels; {' and '.join(map(str, effort['counts']))} samples per pixel with "
        f"{effort['seeds']} seed{'s' if effort['seeds'] > 1 else ''}, against 2 × {effort['reference']} samples with light sampling. All in units of mixed with one light sample per event, averaged over γ and "
        "s; standard errors by the jackknife over seeds. The paper does not say whether its light is sampled; it was measured in a production "
        "renderer, and its gain of mixed over D cos (10 %) lies nearer to that with light sampling, which is above; BSDF sampling alone is below.</p>",
        picture(folder, "knot.png"), averages(result), picture(folder, "figure10.png"), settings(result),
        "<h3>Variance of one sample in a white furnace</h3><p>GTR, α = 0.3, F = 1, azimuth 0.6; float samplers.</p>",
        table(("γ", "s", "θ", *names), [(r["gamma"], r["s"], r["theta"], *(r[n] for n in names)) for r in result["furnace"]]),
        "<h3>Bounded visible normals of GGX</h3><p>Over those of visible, geometric means of five views from 0° to 87°; time is that of the "
        "sampler alone, without rays.</p>",
        table(("α", "M", "variance", "largest", "variance × time"),
              [(r["alpha"], str([list(x) for x in r["transform"]]), r["samples"], r["worst"], r["time"]) for r in result["bounded"]]),
    ]
    return "\n".join(parts) + "\n"
