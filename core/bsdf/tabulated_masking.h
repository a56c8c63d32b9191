/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * tabulated_masking.h: z Lambda of a slope histogram (part of tabulated.c): in double by sums over rows (half_plane.c), in float
 * from the table, and the heavy cells, that tabulated_smith.c describes.
 */
#ifndef MU_TABULATED_MASKING_H
#define MU_TABULATED_MASKING_H

#include "core/bsdf/distribution.h"
#include "core/bsdf/tabulated.h"

/* Lagrange's cubic through values at -1, 0, 1, 2 (Abramowitz and Stegun, 25.2.13). */
static inline void cubic(float f, float c[4]) {
    c[0] = -f * (f - 1) * (f - 2) / 6;
    c[1] = (f + 1) * (f - 1) * (f - 2) / 2;
    c[2] = -(f + 1) * f * (f - 2) / 2;
    c[3] = (f + 1) * f * (f - 1) / 6;
}

static inline float away_by_table(const float root[3], const float *away, const float w[3]) {
    const float x = root[0] * w[0] + root[1] * w[1], y = root[2] * w[1], r = sqrtf(x * x + y * y);
    if (!(r > 0)) return 0;
    const float azimuth = (atan2f(y, x) * (float)(INV_PI / 2) + 0.5f) * TABULATED_AZIMUTHS;
    const float height = w[2] / (w[2] + r) * TABULATED_HEIGHTS;
    const int a = (int)azimuth, i = height < TABULATED_HEIGHTS - 1 ? (int)height : TABULATED_HEIGHTS - 1;
    float ca[4], ch[4], sum = 0;
    cubic(azimuth - (float)a, ca), cubic(height - (float)i, ch);
    for (int k = 0; k < 4; k++) {
        const float *h = away + ((a + k - 1) & (TABULATED_AZIMUTHS - 1)) * TABULATED_STRIDE + i;
        sum += ca[k] * (ch[0] * h[0] + ch[1] * h[1] + ch[2] * h[2] + ch[3] * h[3]);
    }
    return fmaxf(sum, 0) * (w[2] + r);
}

static inline real z_lambda(const base *b, const real w[3]) {
    const tabulated *t = b->table;
    const double v[3] = {(double)w[0], (double)w[1], (double)w[2]};
#if MU_REAL_BITS == 53
    return mu_tabulated_away(&t->grid, v);
#else
    const float rest = t->grid.light > 0 ? away_by_table(b->shape + TABULATED_ROOT, t->away, w) : 0;
    return t->grid.heavy ? rest + (float)mu_tabulated_heavy(&t->grid, v) : rest;
#endif
}

#endif
