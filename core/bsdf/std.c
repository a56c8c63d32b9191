/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * std.c: the Student-t distribution (Ribardiere et al. 2017, "STD: Student's t-distribution of normals for microfacet based
 * scattering") of every tail gamma > 3/2, shape-invariant: slopes in units of
 * alpha. P22 = (1 + X/b)^-gamma / pi with b = gamma - 1 and X the squared slope; Phong (n) is that of b alpha² = 1, gamma =
 * n/2 + 2. Samplers of visible normals: not in the papers.
 */
#include "core/bsdf/cap.h"
#include "core/bsdf/parts.h"
#include "core/bsdf/smith.h"
#include "core/bsdf/std.h"

static inline real density(const base *b, const real u[3], real n2) {
    const real *s = b->shape;
    const real r2 = flat_square(u) / s[STD_B], z2 = larger(u[2] * u[2], REAL_MIN), t = n2 / (z2 + r2);
    return smaller(R(INV_PI) * t * t * exp((2 - s[STD_GAMMA]) * log1p_ratio(r2, z2)), REAL_MAX);
}

/* z Lambda = H r J(T), J = int_0^1 (1 + 1/(u T)²)^-p du, T² = b r² / z², p = gamma - 3/2; H: sigma at the horizon */
static inline real z_lambda(const base *b, const real w[3]) {
    const real *s = b->shape;
    const real r2 = flat_square(w), r = sqrt(r2);
#if MU_REAL_BITS == 53
    return s[STD_HORIZON] * r * mu_std_integral(s[STD_P], r * sqrt(s[STD_B]), w[2]);
#else
    const float sum = larger(sqrtf(w[2] * w[2] + r2) + w[2], REAL_MIN), v = r2 / sum / sum;
    const float power = expf(-s[STD_P] * log1pf(w[2] * w[2] / larger(s[STD_B] * r2, REAL_MIN)));
    return s[STD_HORIZON] * r * power * smith_table_at(b->table, (int32_t)s[STD_OCTAVES], s[STD_TO_FIRST], v);
#endif
}

/* The slope's length under D cos: X/b = (1 - u)^(-1/b) - 1. */
static void plain(const base *b, real u, real part[2]) {
    const real ln = -log1p(-u) / b->shape[STD_B];
    part[0] = sqrt(b->shape[STD_B] * -expm1(-ln));
    part[1] = exp(-ln / 2);
}

/* The same times the length: X/b is a quotient of gamma deviates of shapes 3/2 and p. */
static void by_length(const base *b, random_stream *more, real part[2]) {
    const real most = MU_REAL_BITS == 24 ? 40 : 300;
    const real ln = (random_log_gamma(more, R(1.5)) - random_log_gamma(more, b->shape[STD_P])) / 2;
    part_from_log(smaller(ln, most) + log(b->shape[STD_B]) / 2, part);
}

static inline void sample_slope(const base *b, const real u[3], real n[3]) {
    slope_by_parts(plain, b, u, n);
}

/* From far below, w = (r, 0, z), c = -z/r > 1, gamma > 5/2: x = c + s has the density s (1 + (2cs + s²)/B)^(1/2 - gamma), B =
 * b + c². Without s² that is a quotient of gamma deviates of shapes 2 and gamma - 5/2; y / sqrt(b + x²) has the density (1 +
 * y²)^-gamma, a normal deviate over the root of a gamma deviate. Not in the paper. */
static void visible_from_below(const real *shape, const real w[3], real r, const real u[3], real n[3]) {
    random_stream more = random_start(u);
    const real c = -w[2] / r, b = shape[STD_B], gamma = shape[STD_GAMMA], B = b + c * c;
    real s = 0;
    for (int k = 0; k < 1024; k++) {
        s = exp(random_log_gamma(&more, 2) - random_log_gamma(&more, gamma - R(2.5))) * (B / (2 * c));
        if (random_next(&more) < exp((R(0.5) - gamma) * log1p(s * s / (B + 2 * c * s)))) break;
    }
    const real x = c + s, y = random_normal(&more) * sqrt((b + x * x) / 2) *
                              exp(-random_log_gamma(&more, gamma - R(0.5)) / 2);
    n[0] = (w[0] * x - w[1] * y) / r;
    n[1] = (w[1] * x + w[0] * y) / r;
    n[2] = 1;
}

/* gamma >= 2: (1 + X)² (1 + X/b)^-gamma is largest at X = 1. */
static inline void sample_visible(const base *b, const real w[3], const real u[3], real n[3]) {
    const real *s = b->shape;
    if (s[STD_GAMMA] < 2) {
        const parts p = {s[STD_HORIZON], plain, by_length};
        visible_by_parts(&p, b, w, u, n);
        return;
    }
    const real r = w[2] < 0 ? sqrt(flat_square(w)) : 0;
    if (r > 0 && -w[2] > r && s[STD_GAMMA] > R(2.6))
        visible_from_below(s, w, r, u, n);
    else
        cap_accepted(b, density, 1, s[STD_BOUND], w, u, n);
}

static int octaves(double gamma) {
    return mu_smith_octaves(1 / sqrt(fmax(1, gamma - 1)));
}

static size_t table_bytes(const mu_definition *d) {
    return MU_REAL_BITS == 53 ? 0 : mu_smith_table_bytes(octaves(d->gamma));
}

static double prepare(base *b, const mu_definition *d, void *table) {
    const double gamma = d->gamma;
    real *s = b->shape;
    s[STD_GAMMA] = R(gamma);
    s[STD_B] = R(gamma - 1);
    s[STD_P] = R(gamma - 1.5);
    s[STD_HORIZON] = R(mu_std_horizon(gamma));
    /* largest at X = 1: 4 (1 - 1/gamma)^gamma, and room for rounding */
    s[STD_BOUND] = R(4 * INV_PI * exp(gamma * log1p(-1 / gamma)) * (1 + 16 * REAL_EPSILON));
    b->table = NULL;
    if (MU_REAL_BITS == 24) {
        s[STD_OCTAVES] = R(octaves(gamma));
        s[STD_TO_FIRST] = R(ldexp(1, octaves(gamma)));
        mu_std_table_build(table, octaves(gamma), gamma);
        b->table = table;
    }
    return d->alpha;
}

enum { TRAITS = PICKS };

#define DISTRIBUTION std
#include "core/bsdf/transformed.h"
