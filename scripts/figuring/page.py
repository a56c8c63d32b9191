# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The figures as a section of the report: what was made, with captions."""
import base64
import html

CAPTIONS = {
    "figure6": ["figure6.png", "Figure 6: an elastic dielectric at rest (both ends) and deformed, without and with the deformation of its microsurface."],
    "figure7": ["figure7.png", "Figure 7: triangles at rest (blue) and deformed (red) in the frame of the texture’s u direction, and what T makes of a circle."],
    "figure8": ["figure8.png", "Figure 8: brushed aluminium, α = 0.01, 0.04, 0.16, γ = 1 above and 3.5 below, stretched 5/2 along the brush."],
    "balloon": ["balloon.gif", "A balloon as it is inflated: one material on the left; a microsurface that stretches with it on the right."]}


def fragment(told, folder, chosen):
    shown = []
    for name in chosen:
        file, caption = CAPTIONS[name]
        data, text = base64.b64encode((folder / file).read_bytes()).decode(), html.escape(caption)
        shown.append(f'<figure><img alt="{text}" src="data:image/{file[-3:]};base64,{data}"><figcaption>{text}</figcaption></figure>')
    if "figure7" in told:
        shown.append(f"<p>Of all triangles that were tried, T as <code>musurf tension</code> prints it differs by at most {told['figure7']['largest_difference']:.1e} from "
                     "D R⁻¹ computed apart.</p>")
    return "<h2>Figures 6 to 8</h2>\n" + "\n".join(shown) + f"\n<p class=faint>{told['seconds']:.0f} s. <code>{html.escape(told['command'])}</code></p>\n"
