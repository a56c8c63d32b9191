/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * sheen.c: the sheen of cloth (Conty & Kulla 2017, "Production friendly microfacet sheen BRDF"): D = (2 + 1/r) sin^(1/r) / 2 pi, r = alpha. With k = 1/2r
 * and x the squared slope, P22 = (k+1)/pi (x / (1+x))^k / (1+x)²: GTR of alpha 0 and gamma -k. Slopes in units of sqrt(k +
 * 1), where most of them lie. Masking is Smith's, exact, not the authors' fit.
 */
#include "core/bsdf/cap.h"
#include "core/bsdf/parts.h"
#include "core/bsdf/sheen.h"
#include "core/bsdf/smith.h"

static inline real density(const base *b, const real u[3], real n2) {
    const real *s = b->shape;
    const real r2 = s[SHEEN_UNIT] * flat_square(u) * s[SHEEN_UNIT], z2 = larger(u[2] * u[2], REAL_MIN);
    const real t = s[SHEEN_UNIT] * n2 / (z2 + r2) * s[SHEEN_UNIT];
    if (r2 == 0 && s[SHEEN_K] > 0) return 0;
    return R(INV_PI) * t * t * exp(-s[SHEEN_K] * log1p_ratio(z2, larger(r2, REAL_MIN)));
}

static inline real z_lambda(const base *b, const real w[3]) {
    const real *s = b->shape;
    const real r2 = flat_square(w), z = w[2];
#if MU_REAL_BITS == 53
    return mu_sheen_z_lambda(s[SHEEN_K], sqrt(r2), z, 16);
#else
    return smith_table_z_lambda(b->table, (int32_t)s[SHEEN_OCTAVES], s[SHEEN_TO_FIRST], r2, z);
#endif
}

/* The slope's length under D cos: sin² = u^(1/(k+1)). */
static void plain(const base *b, real u, real part[2]) {
    const real ln = log(larger(u, REAL_MIN)) / (b->shape[SHEEN_K] + 1);
    part[0] = exp(ln / 2) / b->shape[SHEEN_UNIT];
    part[1] = sqrt(-expm1(ln));
}

/* The same times the length: x is a quotient of gamma deviates of shapes k + 3/2 and 1/2. */
static void by_length(const base *b, random_stream *more, real part[2]) {
    const real narrow = fabs(random_normal(more)) * R(0.70710678118654752440);
    const real ln = random_log_gamma(more, b->shape[SHEEN_K] + R(1.5)) / 2 - log(larger(narrow, REAL_MIN));
    part_from_log(ln - log(b->shape[SHEEN_UNIT]), part);
}

static inline void sample_slope(const base *b, const real u[3], real n[3]) {
    slope_by_parts(plain, b, u, n);
}

static inline void sample_visible(const base *b, const real w[3], const real u[3], real n[3]) {
    const parts p = {b->shape[SHEEN_HORIZON], plain, by_length};
    visible_by_parts(&p, b, w, u, n);
}

/* phi is smooth on the scale of the unit: the fewest octaves serve */
static size_t table_bytes(const mu_definition *d) {
    (void)d;
    return MU_REAL_BITS == 53 ? 0 : mu_smith_table_bytes(mu_smith_octaves(1));
}

static double prepare(base *b, const mu_definition *d, void *table) {
    const double k = mu_sheen_k(d->alpha), unit = sqrt(k + 1);
    real *s = b->shape;
    s[SHEEN_K] = R(k);
    s[SHEEN_UNIT] = R(unit);
    s[SHEEN_HORIZON] = R(mu_sheen_horizon(k));
    b->table = NULL;
    if (MU_REAL_BITS == 24) {
        s[SHEEN_OCTAVES] = R(mu_smith_octaves(1));
        s[SHEEN_TO_FIRST] = R(ldexp(1, mu_smith_octaves(1)));
        mu_sheen_table_build(table, mu_smith_octaves(1), k);
        b->table = table;
    }
    return unit;
}

enum { TRAITS = PICKS };

#define DISTRIBUTION sheen
#include "core/bsdf/transformed.h"
