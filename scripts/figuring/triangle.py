# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Figure 7: a triangle at rest and deformed, both turned into the texture's frame, and T between them.

T is computed here as section 5.1 of *Microsurface Transformations* says, with numpy, and held to what `musurf tension` prints.
"""
import numpy as np


def local(points, uv):
    """[2, 2]: the edges p1 - p0 and p2 - p0 as columns, in the triangle's plane with the texture's u direction as x."""
    edges = points[1:] - points[0]
    (a, c), (b, d) = uv[1:] - uv[0]
    along = (d * edges[0] - c * edges[1]) / (a * d - b * c)  # dp/du
    normal = np.cross(*edges)
    t = along / np.linalg.norm(along)
    return np.stack([edges @ t, edges @ np.cross(normal / np.linalg.norm(normal), t)])


class Pair:
    """One face of two meshes: R, D, T as printed by `musurf tension`, and how far that is from D R^-1."""

    def __init__(self, rest, deformed, face, printed):
        corners, uv = rest.faces[face], rest.uv[rest.faces[face]]
        self.r, self.d, self.t = local(rest.points[corners], uv), local(deformed.points[corners], uv), printed
        self.difference = float(np.abs(self.d @ np.linalg.inv(self.r) - printed).max())


def clearest(pairs):
    """Of triangles that are not slender at rest, the one that is deformed most."""
    round_ones = [pair for pair in pairs if np.linalg.cond(pair.r) < 4] or pairs
    return max(round_ones, key=lambda pair: np.abs(np.log(np.linalg.svd(pair.t, compute_uv=False))).max())


def draw(plt, shown, path):
    """A panel for each (title, pair): blue at rest, red deformed, and what T makes of a circle."""
    figure, axes = plt.subplots(1, len(shown), figsize=(3.4 * len(shown), 3.7), squeeze=False)
    turn = np.linspace(0, 2 * np.pi, 200)
    circle = np.stack([np.cos(turn), np.sin(turn)])
    for axis, (title, pair) in zip(axes[0], shown):
        size = max(np.abs(pair.r).max(), np.abs(pair.d).max())
        for edges, colour, name in ((pair.r / size, "#1f5f8b", "r"), (pair.d / size, "#b3261e", "d")):
            corners = np.column_stack([(0, 0), edges, (0, 0)])
            axis.fill(*corners, color=colour, alpha=0.12)
            axis.plot(*corners, color=colour, linewidth=0.8)
            for k in (0, 1):
                axis.annotate("", edges[:, k], (0, 0), arrowprops={"arrowstyle": "-|>", "color": colour, "linewidth": 1.6})
                axis.annotate(f"${name}_{k + 1}$", edges[:, k], color=colour, fontsize=11, xytext=(3, 3), textcoords="offset points")
        for ring, colour in ((circle, "#1f5f8b"), (pair.t @ circle, "#b3261e")):
            axis.plot(*(0.3 * ring), color=colour, linewidth=0.9, linestyle=(0, (4, 2)))
        axis.annotate("u", (1, -0.1), xycoords=("axes fraction", "data"), fontsize=9, color="0.4", ha="right", va="top")
        axis.axhline(0, color="0.8", linewidth=0.7, zorder=0)
        axis.set(aspect="equal", xticks=[], yticks=[])
        axis.margins(0.15)
        axis.set_title("{}\nT = [{:.3f} {:.3f}; {:.3f} {:.3f}]".format(title, *np.round(np.ravel(pair.t), 3) + 0.0), fontsize=9)
    figure.savefig(path.with_suffix(".new.png"), dpi=110, bbox_inches="tight")
    plt.close(figure)
    path.with_suffix(".new.png").replace(path)
