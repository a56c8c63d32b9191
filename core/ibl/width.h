/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * width.h: the lobe's width in reflected space, Section 5.5 and Appendix C.
 *
 * Micronormals m and n reflect the view o to directions 2 |(m.o) m - (n.o) n| apart, which is 2 |(m x n) x o|. Small roughness
 * and a low view make that small, and it keeps its digits only if it is made of what is small. Between the boundary's points
 * t + delta and t - delta + pi, with the slopes g + d and g - d, half sum and half difference,
 *     g = sin delta (-rx sin t, ry cos t),  d = cos delta (rx cos t, ry sin t),
 *     m x n = 2 (-d.y, d.x, g.y d.x - g.x d.y) / (lengths of (g + d, 1) and (g - d, 1)),
 * whose last component is a sum of terms of one sign, and d.o = cos delta p (extrema.h).
 */
#ifndef MU_IBL_WIDTH_H
#define MU_IBL_WIDTH_H

#include "core/ibl/extrema.h"

static inline real shifted_width(const real r[2], const real o[3], const extremum *t, real s, real c) {
    const real g[2] = {-s * (r[0] * t->sine), s * (r[1] * t->cosine)};
    const real d[2] = {c * (r[0] * t->cosine), c * (r[1] * t->sine)};
    const real m = length3(g[0] + d[0], g[1] + d[1], 1), n = length3(g[0] - d[0], g[1] - d[1], 1);
    const real up = (g[1] / m) * (d[0] / n) - (g[0] / m) * (d[1] / n);
    const real x = d[0] / m / n * o[2] - up * o[1], y = d[1] / m / n * o[2] + up * o[0];
    return 4 * length3(x, y, c * t->p / m / n);
}

#endif
