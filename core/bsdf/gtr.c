/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * gtr.c: generalised Trowbridge-Reitz (gtr_shape.h) with exact Smith masking for every gamma >= 0 (gtr_smith.c): by
 * quadrature in double, by a table of the material in float.
 */
#include "core/bsdf/gtr_shape.h"
#include "core/bsdf/smith.h"

static inline real z_lambda(const base *b, const real w[3]) {
    const real *g = b->shape;
    const real r2 = flat_square(w), z = w[2];
#if MU_REAL_BITS == 53
    return mu_gtr_z_lambda(g[GTR_ALPHA], g[GTR_GAMMA], smaller(sqrt(r2) / g[GTR_UNIT], 1e300), z, 16);
#else
    return smith_table_z_lambda(b->table, (int32_t)g[GTR_OCTAVES], g[GTR_TO_FIRST], r2 * g[GTR_TABLE_R2], z);
#endif
}

/* The table is about alpha, or the unit where that is smaller. */
static double table_unit(double alpha, double gamma) {
    return fmin(alpha, unit_of(alpha, gamma));
}

static size_t table_bytes(const mu_definition *d) {
    return MU_REAL_BITS == 53 ? 0 : mu_smith_table_bytes(mu_smith_octaves(table_unit(d->alpha, d->gamma)));
}

static double prepare(base *b, const mu_definition *d, void *table) {
    real *g = b->shape;
    const double alpha = d->alpha, gamma = d->gamma, unit = shape_prepare(b, d);
    if (table && MU_REAL_BITS == 24) {
        const int octaves = mu_smith_octaves(table_unit(alpha, gamma));
        g[GTR_OCTAVES] = R(octaves);
        g[GTR_TO_FIRST] = R(ldexp(1, octaves));
        g[GTR_TABLE_R2] = R(pow(table_unit(alpha, gamma) / unit, 2));
        mu_gtr_table_build(table, octaves, alpha, gamma, table_unit(alpha, gamma));
        b->table = table;
    }
    return unit;
}

enum { TRAITS = PICKS };

#define DISTRIBUTION gtr
#include "core/bsdf/transformed.h"
