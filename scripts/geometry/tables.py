# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The comparison as text and as a section of the report."""
import base64
import html
import json


def summary(result):
    yield "facets against material: (facets / material - 1) over the plate, FLIP, FLIP between halves of the facets' realisations"
    for plate in result["plates"]:
        for row in plate["rows"]:
            yield (f"  {plate['name']:10} {row['comparison']:18} {row['deviation']:+7.2%} +- {row['error']:.2%}   FLIP {row['flip']:.3f}"
                   f"   noise {row['flip_of_noise']:.3f}")
    yield f"  sky seen directly differs by at most {max(plate['background'] for plate in result['plates']):.2%} in the mean"


def image(folder, name, caption):
    data = base64.b64encode((folder / name).read_bytes()).decode()
    return f'<figure><img alt="{html.escape(caption)}" src="data:image/png;base64,{data}"><figcaption>{html.escape(caption)}</figcaption></figure>'


def fragment(result, folder):
    rows = "".join(f"<tr><td>{html.escape(plate['name'])}</td><td>{html.escape(row['comparison'])}</td><td>{row['deviation']:+.2%} ± {row['error']:.2%}</td>"
                   f"<td>{row['flip']:.3f}</td><td>{row['flip_of_noise']:.3f}</td><td>{max(abs(r['deviation']) for r in row['by_angle']):.1%}</td></tr>"
                   for plate in result["plates"] for row in plate["rows"])
    surface, (width, height) = result["surface"], result["pixels"]
    return (
        "<h2>Rendered against explicit geometry</h2>\n"
        f"<p>A square plate of explicit mirror facets ({html.escape(surface['ndf'])}, α = {surface['alpha']:g}, {surface['size']}² cells a period, vertices baked under M, "
        f"{surface['realisations']} realisations) traced by POV-Ray surrounded by {html.escape(result['environment'])}, and the same plate as two "
        "triangles with the material that <code>musurf surface fit</code> found in the first surface, under the same M. Same camera, "
        f"{width} × {height} pixels, {result['rays_per_pixel']} rays a pixel there and {result['samples']} samples here. "
        f"Fitted: <code>{html.escape(json.dumps(result['material']))}</code>.</p>\n"
        "<p>“One reflection” loses what a second facet blocks, on both sides; “all” lets POV-Ray follow light to its exit, and the material adds "
        "the random walk on the Smith microsurface, or the compensation lobe. That Smith’s masking lets out too little after one reflection is "
        "known (the steeper, the more); nothing is tuned. Standard errors are those of the realisations. FLIP at 67 pixels a degree and the exposure "
        "shown; beside it FLIP between two halves of the facets’ own realisations, which is noise alone.</p>\n"
        "<table><thead><tr><th>M</th><th>compared</th><th>facets / material − 1</th><th>FLIP</th><th>FLIP of noise</th>"
        f"<th>largest deviation of an angle</th></tr></thead><tbody>{rows}</tbody></table>\n"
        + image(folder, result["angles"], "Deviation by the angle of the view, with standard errors")
        + "".join(image(folder, plate["picture"], f"{plate['name']}: M = {plate['transform']}") for plate in result["plates"])
        + f"<p class=faint>Sky seen directly differs by at most {max(plate['background'] for plate in result['plates']):.2%} in the mean: both programs turn the "
        f"surrounding alike. {result['seconds']:.0f} s. <code>{html.escape(result['command'])}</code></p>\n")
