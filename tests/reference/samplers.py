# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""Densities of the samplers other than visible normals, of reflected directions, from what each of them does.

    ndf              draws m from D cos (Eq. 25):                    D(h) h_z / (4 o.h)
    folded           turns up what visible normals reflect down:     visible(i) + visible(i_x, i_y, -i_z)
    bounded          visible normals of GGX but some that reflect down (Tokuyoshi & Eto 2023, Eq. 12 for one roughness a):
                     with k = (1 - a^2) s^2 / (s^2 + a^2 o_z^2), s = 1 + |o_xy|, of a sphere cap of 1 + k w_z in place of 1 + w_z:
                     D / (4 (sigma - (1 - k) o_z / 2)). Under M, a is the smaller slope roughness, at most 1:
                     alpha over the larger singular value of M.
    mixed            ndf, or with probability alpha (at most 1) uniform over the hemisphere (Appendix B)
    visible_uniform, folded_uniform     or with probability 3/10 uniform
"""
import mpmath as mp

NDF, MIXED, UNIFORM = ("ndf", "mixed"), ("mixed", "visible_uniform", "folded_uniform"), mp.mpf(3) / 10
FOLDED = ("folded", "folded_uniform")
ALL = ("ndf", "mixed", "visible_uniform", "folded", "folded_uniform", "bounded")


def largest_singular_value(M):
    (a, c), (b, d) = M
    square, det = a * a + b * b + c * c + d * d, a * d - b * c
    return mp.sqrt((square + mp.sqrt(square * square - 4 * det * det)) / 2)


def pdf(case, sampler, o, i, h, sigma):
    """(density, density of its normals that rounding near a format's smallest number may move it by one of)"""
    D = case.D(h)
    oh = sum(p * q for p, q in zip(o, h))
    if sampler in NDF:
        own = D * h[2] / (4 * oh)
    elif sampler == "bounded":
        a = min(mp.mpf(1), case.shape()[0] / largest_singular_value(case.M))
        s = 1 + mp.sqrt(o[0] ** 2 + o[1] ** 2)
        less = a * a * (o[2] ** 2 + s * s) / (s * s + a * a * o[2] ** 2)  # 1 - k
        own = D / (4 * (sigma - less * o[2] / 2))
    else:
        own = D / (4 * sigma)
    if sampler in FOLDED and o[2] > i[2]:  # the half-vector of o and the direction below points up
        g = [o[0] + i[0], o[1] + i[1], o[2] - i[2]]
        length = mp.sqrt(sum(e * e for e in g))
        more = case.D([e / length for e in g])
        own, D = own + more / (4 * sigma), D + more
    if sampler in MIXED:
        share = min(mp.mpf(1), case.shape()[0]) if sampler == "mixed" else UNIFORM
        own = (1 - share) * own + share / (2 * mp.pi)
        D = max(D, own)
    return own, D
