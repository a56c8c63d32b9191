# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The comparison of deformed plates as text and as a section of the report."""
import html

from . import tables


def summary(result):
    yield "highlights of facets against the material under tension: deviation in units of which the tolerance is a share, +- standard error"
    for plate in result["plates"]:
        sizes = "; ".join(f"{name} {a:.4f} x {b:.4f} at {c:.1f} deg" for name, (a, b, c) in plate["ellipses"].items())
        yield f"  {plate['name']}, tolerance {plate['tolerance']:.0%}; FLIP {plate['flip']:.3f} (noise {plate['flip_of_noise']:.3f}); {sizes}"
        for row, wrong in zip(plate["rows"], plate["as_at_rest"]):
            yield (f"    {row['measure']:10} {row['deviation']:+7.2%} +- {row['error']:.2%}  {row['verdict']:9}   "
                   f"material as at rest: {wrong['deviation']:+8.2%}  {wrong['verdict']}")


def fragment(result, folder):
    """One table for each plate."""
    parts = ["<h2>Plates deformed as a whole</h2>\n"
             f"<p>A plate with an explicit heightfield of mirror facets ({html.escape(result['surface']['ndf'])}, α = {result['surface']['alpha']:g}, "
             f"{result['surface']['size']}² cells a period, {result['surface']['realisations']} realisations) is deformed as a whole, vertices baked, and traced by POV-Ray; "
             "beside it the plate’s mesh at rest and deformed with <code>tension</code> and the material of the surface at rest. Light, peak, place and second moments of a "
             "small lamp’s highlight, in units in which the rms error that a BRDF’s bins are known to have on explicit surfaces is the tolerance "
             "(<code>scripts/geometry/highlight.py</code>). The material as it was at rest must fail.</p>\n"]
    for plate in result["plates"]:
        rows = "".join(f'<tr class="{"fails" if row["verdict"] == "FAILS" else ""}"><td>{row["measure"]}</td><td>{row["deviation"]:+.2%} ± {row["error"]:.2%}</td>'
                       f"<td>{row['verdict']}</td><td>{wrong['deviation']:+.2%}</td><td>{wrong['verdict']}</td></tr>" for row, wrong in zip(plate["rows"], plate["as_at_rest"]))
        sizes = "; ".join(f"{name} {a:.4f} × {b:.4f} at {c:.1f}°" for name, (a, b, c) in plate["ellipses"].items())
        parts.append(f"<h3>{html.escape(plate['name'])}: F = {html.escape(str(plate['deformation']))}</h3>\n<table><thead><tr><th>measure</th><th>facets against tension</th>"
                     f"<th>tolerance {plate['tolerance']:.0%}</th><th>against the material as at rest</th><th></th></tr></thead><tbody>{rows}</tbody></table>\n"
                     f"<p>Standard deviations of the highlight along its axes, in edges of the plate at rest: {html.escape(sizes)}. FLIP {plate['flip']:.3f} "
                     f"(of noise alone {plate['flip_of_noise']:.3f}).</p>\n")
    return "".join(parts) + tables.image(folder, result["picture"], "Highlights of facets, of the material under tension, and their difference") \
        + f"<p class=faint>{result['seconds']:.0f} s. <code>{html.escape(result['command'])}</code></p>\n"
