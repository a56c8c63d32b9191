# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""The distribution of the transformed facets' normals as a histogram, and the core's D integrated over the same bins.

Bins live in the slopes of the transformed surface, polar: each ring holds the same share of the measured facets. The
share of the macro area whose facets have slopes in a bin is the integral of P22 = D cos^4, Eq. (4).
"""
import numpy as np

RINGS, SECTORS, NODES = 8, 12, 6


def ring_edges(slopes):
    """Radii between rings, from measured facets; the last ring reaches twice beyond the steepest."""
    radius = np.hypot(*slopes)
    inner = np.quantile(radius, np.arange(1, RINGS) / RINGS)
    return np.array([0, *inner, 2 * radius.max()])


def histogram(slopes, edges):
    """Share of the facets per ring and sector, flattened."""
    radius, angle = np.hypot(*slopes).ravel(), np.arctan2(slopes[1], slopes[0]).ravel()
    counts, _, _ = np.histogram2d(radius, angle, [edges, np.linspace(-np.pi, np.pi, SECTORS + 1)])
    return counts.ravel() / radius.size


def nodes(edges):
    """Gauss-Legendre nodes and weights over every bin: (slopes [2, bin, node], weights [bin, node])."""
    x, w = np.polynomial.legendre.leggauss(NODES)
    sectors = np.linspace(-np.pi, np.pi, SECTORS + 1)

    def spread(limits):
        half = np.diff(limits)[:, None] / 2
        return (limits[:-1, None] + half + half * x).ravel(), (half * w).ravel()

    (r, wr), (phi, wphi) = spread(edges), spread(sectors)
    slopes = np.stack([r[:, None] * np.cos(phi), r[:, None] * np.sin(phi)])
    weights = (r * wr)[:, None] * wphi

    def per_bin(a):
        a = a.reshape(a.shape[:-2] + (RINGS, NODES, SECTORS, NODES))
        return np.moveaxis(a, -2, -3).reshape(a.shape[:-4] + (RINGS * SECTORS, NODES * NODES))

    return per_bin(slopes), per_bin(weights)


def normals_of(slopes):
    """Unit normals [..., 3] of slopes [2, ...]."""
    m = np.stack([-slopes[0], -slopes[1], np.ones_like(slopes[0])], -1)
    return m / np.linalg.norm(m, axis=-1, keepdims=True)


def predicted(d, slopes, weights):
    """Share per bin from the values of D at the nodes."""
    cos4 = (1 + slopes[0] ** 2 + slopes[1] ** 2) ** -2
    return (d * cos4 * weights).sum(-1)


def pooled(shares, reference, least=0.002):
    """Bins with less than the least share in the reference are united in one; shares are [..., bin]."""
    large = reference >= least
    return np.concatenate([shares[..., large], shares[..., ~large].sum(-1, keepdims=True)], -1)


def total_variation(a, b):
    return 0.5 * float(abs(a - b).sum())
