# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Pictures of the study: Figure 9 with the exact curves beside the spline's, Figure 10's bars, the knot itself."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from . import equation2, masking, noise  # noqa: E402

INK = {"ndf": "#8c8c8c", "mixed": "#c44e52", "visible": "#1f77b4", "visible_uniform": "#55a868", "folded": "#dd8452", "folded_uniform": "#937860", "auto": "#8172b3",
       "mixed, 4 candidates": "#e8a5a7", "as rendered": "#222222"}


def save(figure, path):
    """Beside, then renamed: no half picture replaces a whole one."""
    fresh = path.with_suffix(".new.png")
    figure.savefig(fresh, dpi=110, bbox_inches="tight")
    plt.close(figure)
    fresh.replace(path)
    return path


def figure_9(exact, spline, path):
    shown = (0.3, 0.7, 1.2, 1.5, 2.5)
    figure, axes = plt.subplots(2, len(masking.ALPHAS), figsize=(15, 7.2), squeeze=False)
    for k, alpha in enumerate(masking.ALPHAS):
        top, low = axes[:, k]
        for c, gamma in enumerate(shown):
            g = int(np.abs(masking.GAMMAS - gamma).argmin())
            top.plot(masking.ANGLES, exact[k, g], color=f"C{c}", label=f"γ = {gamma:g}")
            top.plot(masking.ANGLES, spline[k, g], color=f"C{c}", linestyle=(0, (3, 2)))
        top.set(title=f"α = {alpha:g}", xlabel="θ, degrees", ylim=(0, 1.03))
        away = np.abs(spline[k] - exact[k])
        for c, theta in enumerate((30, 60, 80, 88, 89.9)):
            a = int(np.abs(masking.ANGLES - theta).argmin())
            low.semilogy(masking.GAMMAS, np.maximum(away[:, a], 1e-16), color=f"C{c}", label=f"θ = {masking.ANGLES[a]:g}°")
        low.set(xlabel="γ", ylim=(1e-7, 1))
    axes[0, 0].set_ylabel("G1: exact (lines), spline (dashed)")
    axes[1, 0].set_ylabel("error of the spline's G1")
    axes[0, 0].legend(fontsize=8)
    axes[1, 0].legend(fontsize=8)
    return save(figure, path)


def equation_2(away, path):
    """Error of Eq. (2) over gamma: the spline's in lines, what exact masking (and the integral itself) leaves dashed."""
    figure, axes = plt.subplots(1, len(masking.ALPHAS), figsize=(15, 3.8), squeeze=False, sharey=True)
    for k, alpha in enumerate(masking.ALPHAS):
        axis = axes[0, k]
        for c, theta in enumerate((30, 60, 85, 89.5)):
            a = int(np.abs(equation2.ANGLES - theta).argmin())
            for smith, line in (("spline", "-"), ("exact", (0, (3, 2)))):
                axis.semilogy(equation2.GAMMAS, np.maximum(np.abs(away[smith][k, :, a]), 1e-16), color=f"C{c}", linestyle=line,
                              label=f"θ = {theta:g}°" if smith == "spline" else None)
        axis.set(title=f"α = {alpha:g}", xlabel="γ")
    axes[0, 0].set_ylabel("relative error of Eq. (2)")
    axes[0, 0].legend(fontsize=8)
    return save(figure, path)


def figure_10(settings, path):
    """The paper's setting above, BSDF sampling alone below."""
    figure, axes = plt.subplots(2, len(noise.GAMMAS), figsize=(15, 7), squeeze=False, sharey="row")
    for row, (mode, name) in enumerate((("mis", "with light sampling"), ("bsdf", "BSDF sampling alone"))):
        for column, gamma in enumerate(noise.GAMMAS):
            axis = axes[row, column]
            found = [x for x in settings if x["mode"] == mode and x["gamma"] == gamma]
            names = noise.MODES[mode]
            for k, sampler in enumerate(names):
                heights = [x["samplers"][sampler]["samples"][0] for x in found]
                axis.bar(np.arange(len(found)) + 0.11 * (k - len(names) / 2), heights, 0.1, color=INK[sampler], label=sampler)
            axis.axhline(1, color="#888", linewidth=0.8)
            axis.set_xticks(range(len(found)), [f"s = {x['s']:g}" for x in found])
            axis.set_title(f"γ = {gamma:g}, {name}", fontsize=10)
            axis.set_yscale("log")
        axes[row, 0].set_ylabel("samples for the same noise, over mixed", fontsize=8)
    figure.subplots_adjust(hspace=0.35)
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="upper center", ncols=len(noise.MODES["mis"]), fontsize=9)
    return save(figure, path)


def knots(pictures, path):
    """One picture for each stretch."""
    figure, axes = plt.subplots(1, len(pictures), figsize=(15, 3.2), squeeze=False)
    for axis, (s, picture) in zip(axes[0], pictures):
        axis.imshow(np.clip(picture / 0.6, 0, 1) ** (1 / 2.2), cmap="gray", vmin=0, vmax=1)
        axis.set_title(f"s = {s:g}", fontsize=10)
        axis.axis("off")
    return save(figure, path)
