# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What masking means on explicit facets: bits compared, G1 and G2 as averages of bits.

bits are [direction, i, j, L|U, point], the points spread evenly over the macrosurface. slopes are those of the facets
in the space of the direction. A facet's area per unit macro area, projected along v, is w = v_z - v_xy . slope, so
the average of w where w > 0 is sigma(v), and weighting bits by w gives the projected mean of G1.
"""
import numpy as np


def disagreement(a, b):
    """Differing bits and all bits, per direction."""
    different = (a != b).reshape(len(a), -1)
    return different.sum(1), different.shape[1]


def centre(bits):
    """One point per facet, at (i + 1/4, j + 1/2) and (i + 3/4, j + 1/2): the middle one of an odd square number."""
    fine = int(round(np.sqrt(bits.shape[-1])))
    p, q = np.meshgrid(np.arange(2 * fine), np.arange(fine), indexing="ij")
    lower = 2 * p + 4 * q + 3 < 4 * fine
    index = int(np.flatnonzero((p[lower] == (fine - 1) // 2) & (q[lower] == (fine - 1) // 2))[0])
    return bits[..., index : index + 1]


BLOCKS = 4  # per side; wide against the correlation length, so that blocks are nearly independent


def block_of(values):
    """The block of every cell, [i, j]."""
    x, y = (np.arange(n) * BLOCKS // n for n in values.shape[:2])
    return x[:, None] * BLOCKS + y


def per_block(values):
    """Sums of [i, j, ...] over blocks of cells, [block]."""
    return np.bincount(block_of(values).ravel(), values.reshape(*values.shape[:2], -1).sum(-1).ravel(), BLOCKS * BLOCKS)


def facing(slopes, v):
    """Projected area of each facet per unit macro area, 0 where it turns away from v."""
    return np.maximum(0, v[2] - v[0] * slopes[0] - v[1] * slopes[1])


def sigma(slopes, v):
    """Projected area of all facets that face v per unit macro area."""
    return float(facing(slopes, v).mean())


def projected_mean(bits, slopes, v):
    """G1 weighted by projected area, as (seen, all) per block. For a periodic heightfield it is cos / sigma."""
    weight = facing(slopes, v)
    return np.array([per_block(bits.mean(-1) * weight), per_block(weight)])


def facet_mean(bits, slopes, v):
    """G1 averaged over the facets that face v, each counted by its macro area, as (seen, all) per block."""
    front = facing(slopes, v) > 0
    return np.array([per_block(bits.mean(-1) * front), per_block(front)])


def binned(bits, slopes, v, scale, edges):
    """Facets by their slope along v: (seen, all) per bin and block, [bin, block], each facet counted by its macro area.

    The bin variable is scale * (slope . v_xy) / v_z; with scale = cot(theta)/alpha of the untransformed direction this
    is the untransformed slope along the view over alpha, whatever M. Facets face v where it is below scale.
    """
    variable = scale * (v[0] * slopes[0] + v[1] * slopes[1]) / v[2]
    front, visible = facing(slopes, v) > 0, bits.mean(-1)
    seen, every = [], []
    for low, high in zip(edges[:-1], edges[1:]):
        chosen = front & (variable >= low) & (variable < high)
        seen.append(per_block(chosen * visible))
        every.append(per_block(chosen))
    return np.array(seen), np.array(every)


def per_bin(values, kind, count):
    """Sums of [i, j, L|U] per block and bin, [block, bin]."""
    where = block_of(values)[..., None] * count + kind
    return np.bincount(where.ravel(), values.ravel(), BLOCKS * BLOCKS * count).reshape(-1, count)


def classes(slopes, alpha, m):
    """A class of like normals for every facet: 4 rings by 12 sectors of the untransformed slope, M^T slope."""
    x, y = np.tensordot(m.T, slopes, 1)
    ring = np.minimum(3, np.floor(4 * -np.expm1(-(x * x + y * y) / alpha**2))).astype(int)
    return ring * 12 + np.floor((np.arctan2(y, x) / (2 * np.pi) % 1) * 12).astype(int) % 12


def joint(bits, slopes, a, b, directions, kinds):
    """Facets that face both directions: (seen by both, by a, by b, all) per class of normals and block, [4, class, block]."""
    both = (facing(slopes, directions[a]) > 0) & (facing(slopes, directions[b]) > 0)
    values = ((bits[a] & bits[b]).mean(-1), bits[a].mean(-1), bits[b].mean(-1), np.ones(both.shape))
    return np.array([per_bin(x * both, kinds, 48).T for x in values])
