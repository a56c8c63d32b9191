# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Lobes of the BRDF under several M, from `musurf eval`: f cos(theta) over the hemisphere of incident directions, for one view.

In three dimensions (distance from the origin proportional to the value), from above (a disc, orthographic), and cut along the plane of the
view. All are of luminance without Fresnel's factor, in double precision.
"""
import numpy as np

MATERIAL = {"material": "musurf.microfacet", "ndf": "ggx", "alpha": 0.3}
MAPS = [("M = 1", [[1, 0], [0, 1]]), ("stretch 3 along x", [[3, 0], [0, 1]]), ("skew", [[1, 2], [0, 1]]), ("compression 0.3 along y", [[1, 0], [0, 0.3]])]
VIEW = (50.0, 30.0)  # theta and azimuth, degrees


def direction(theta, phi):
    return np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), -1)


def values(ask, m, w):
    """f cos(theta), 1/sr, for the incident directions [..., 3]."""
    wo = direction(*np.radians(VIEW)).tolist()
    said = ask([{"material": dict(MATERIAL, transform=m), "wo": wo, "wi": wi} for wi in w.reshape(-1, 3).tolist()])
    return np.array([answer["f"][0] for answer in said]).reshape(w.shape[:-1]) * w[..., 2]


def albedo(theta, phi, lobe):
    """Integral over the hemisphere by the midpoint rule on the grid of cell centres."""
    return float((lobe * np.sin(theta)).sum() * (np.pi / 2 / theta.shape[0]) * (2 * np.pi / theta.shape[1]))


def grid(rings, sectors):
    return np.meshgrid((np.arange(rings) + 0.5) * np.pi / 2 / rings, (np.arange(sectors) + 0.5) * 2 * np.pi / sectors, indexing="ij")


def draw(plt, ask, resolution, path):
    """Writes the picture; returns [{"name", "transform", "albedo"}]."""
    theta, phi = grid(resolution, 2 * resolution)
    w = direction(theta, phi)
    along = np.radians(np.linspace(-89.5, 89.5, 2 * resolution + 1))
    cut, wo = direction(along, np.radians(VIEW[1])), direction(*np.radians(VIEW))
    figure, found = plt.figure(figsize=(3.4 * len(MAPS), 9.4)), []
    for k, (name, m) in enumerate(MAPS):
        lobe = values(ask, m, w)
        found.append({"name": name, "transform": m, "albedo": albedo(theta, phi, lobe)})
        space = figure.add_subplot(3, len(MAPS), k + 1, projection="3d")
        ring = np.concatenate([lobe, lobe[:, :1]], 1)[..., None] / lobe.max() * np.concatenate([w, w[:, :1]], 1)
        space.plot_surface(ring[..., 0], ring[..., 1], ring[..., 2], cmap="viridis", linewidth=0, rstride=1, cstride=1, antialiased=True)
        space.plot(*zip((0, 0, 0), wo), color="#b3261e", linewidth=1.5)
        space.set(xlim=(-1, 1), ylim=(-1, 1), zlim=(0, 1), xticks=[], yticks=[], zticks=[], title=name, box_aspect=(2, 2, 1))
        space.view_init(elev=25, azim=-60)
        disc = figure.add_subplot(3, len(MAPS), len(MAPS) + k + 1)
        edges = np.meshgrid(np.sin(np.arange(resolution + 1) * np.pi / 2 / resolution), np.arange(2 * resolution + 1) * np.pi / resolution, indexing="ij")
        shown = disc.pcolormesh(edges[0] * np.cos(edges[1]), edges[0] * np.sin(edges[1]), lobe, cmap="magma", rasterized=True)
        disc.plot(wo[0], wo[1], marker="x", color="#7fd0ff")
        disc.set(aspect="equal", xticks=[], yticks=[])
        disc.axis("off")
        figure.colorbar(shown, ax=disc, shrink=0.7)
        polar = figure.add_subplot(3, len(MAPS), 2 * len(MAPS) + k + 1, projection="polar")
        polar.plot(along, values(ask, m, cut), color="#1f5f8b")
        polar.axvline(np.radians(VIEW[0]), color="#b3261e", linewidth=1)
        polar.set(theta_zero_location="N", theta_direction=-1, thetamin=-90, thetamax=90)
        polar.yaxis.set_major_locator(plt.MaxNLocator(3))
        polar.tick_params(labelsize=7)
    figure.savefig(path, dpi=110, bbox_inches="tight")
    plt.close(figure)
    return found
