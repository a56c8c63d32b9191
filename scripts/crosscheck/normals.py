# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Normals sorted into bins, and the core's distributions integrated over the same bins.

Bins are polar in the slopes of the original surface over its alpha, so that they fit every M: a transformed facet of slope
s belongs to the bin of M^T s. A bin of the original slopes t is the region M^-T t of transformed slopes, of 1/|det M| of its
area, and the share of the macro area whose facets have slopes in it is the integral of P22 = D cos^4, Eq. (4); the
share of what v sees, of D_v cos^3 (solid angle is cos^3 ds).
"""
import numpy as np

RINGS = np.array([0, 0.35, 0.6, 0.85, 1.15, 1.6, 2.4, 4.0, np.inf])
SECTORS, NODES = 12, 7
COUNT = (len(RINGS) - 1) * SECTORS


def index(slopes, m, alpha):
    """The bin of every facet, from the slopes [2, ...] of the transformed surface."""
    x, y = np.tensordot(m.T, slopes, 1)
    ring = np.searchsorted(RINGS * alpha, np.hypot(x, y), "right") - 1
    sector = np.floor((np.arctan2(y, x) / (2 * np.pi) + 0.5) * SECTORS).astype(int) % SECTORS
    return np.clip(ring, 0, len(RINGS) - 2) * SECTORS + sector


def nodes(m, alpha, panels=1):
    """Gauss-Legendre in every bin: (slopes of the transformed surface [2, bin, node], weights in ds [bin, node]).

    The last ring, to infinity, is integrated in u = edge/r over (0, 1]. panels: parts of every ring and sector.
    """
    x, w = np.polynomial.legendre.leggauss(NODES)
    radii, areas = [], []
    for low, high in zip(RINGS[:-1], RINGS[1:]):
        cut = np.linspace(low, high, panels + 1) if np.isfinite(high) else np.linspace(0, 1, panels + 1)
        half = np.diff(cut)[:, None] / 2
        at, width = (cut[:-1, None] + half + half * x).ravel(), (half * w).ravel()
        if not np.isfinite(high):
            at, width = low / at, width * low / at**2
        radii.append(at)
        areas.append(width * at)
    half = np.pi / SECTORS / panels
    middle = -np.pi + half * (2 * np.arange(SECTORS * panels) + 1)
    angle = (middle[:, None] + half * x).reshape(SECTORS, -1)
    turn = np.tile(half * w, panels)
    r, a = np.array(radii)[:, None, :, None], np.array(areas)[:, None, :, None]
    slopes = alpha * np.stack(np.broadcast_arrays(r * np.cos(angle)[None, :, None, :], r * np.sin(angle)[None, :, None, :]))
    weights = alpha**2 * np.broadcast_to(a * turn, slopes.shape[1:]) / abs(np.linalg.det(m))
    return np.tensordot(np.linalg.inv(m).T, slopes.reshape(2, COUNT, -1), 1), weights.reshape(COUNT, -1)


def normals_of(slopes):
    """Unit normals [..., 3] of slopes [2, ...]."""
    m = np.stack([-slopes[0], -slopes[1], np.ones_like(slopes[0])], -1)
    return m / np.linalg.norm(m, axis=-1, keepdims=True)


def pooled(shares, reference, least=0.002):
    """Bins with less than the least share in the reference are united in one; shares are [..., bin]."""
    large = reference >= least
    return np.concatenate([shares[..., large], shares[..., ~large].sum(-1, keepdims=True)], -1)


def total_variation(a, b):
    return 0.5 * float(abs(a - b).sum())
