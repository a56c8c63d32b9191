/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * exponential.c: a distribution that musurf does not have, added from outside against an installed libmusurf: slopes of
 * exponential length, P22 = exp(-r) / 2 pi in units of alpha, with r the slope's length. Q = P(slope² > r²) = (1 + r) exp(-r).
 * Compiled twice, with -DMU_REAL_BITS=24 and 53; it defines mu_kernel_exponential_f and _d.
 */
#include "core/bsdf/cap.h"
#include "core/bsdf/parts.h"
#include "core/bsdf/shape_invariant.h"
#include "core/bsdf/smith.h"

static inline real density(const base *b, const real u[3], real n2) {
    (void)b;
    const real z = larger(u[2], R(1e-18)), t = n2 / (z * z);
    return R(INV_PI / 2) * square(t * exp(-sqrt(flat_square(u)) / z / 2));
}

static double survival(const void *shape, double x) {
    (void)shape;
    return (1 + sqrt(x)) * exp(-sqrt(x));
}

static inline real z_lambda(const base *b, const real w[3]) {
    (void)b;
    const double r = sqrt((double)flat_square(w));
    return r > 0 ? R(mu_smith_z_lambda(survival, NULL, -60, r, (double)w[2], MU_REAL_BITS == 24 ? 9 : 16))
                 : 0;
}

/* A gamma deviate of shape 2, by inverting Q with Newton's method in ln Q. */
static void plain(const base *b, real u, real part[2]) {
    (void)b;
    const double target = log1p(-(double)u);
    double r = sqrt(2 * (double)u) + (double)u;
    for (int i = 0; i < 40; i++) r = fmax(r + (log1p(r) - r - target) * (1 + r) / fmax(r, 1e-12), 1e-12);
    part[0] = R(r), part[1] = 1;
}

static void by_length(const base *b, random_stream *more, real part[2]) {
    (void)b;
    part_from_log(random_log_gamma(more, 3), part);
}

static inline void sample_slope(const base *b, const real u[3], real n[3]) {
    slope_by_parts(plain, b, u, n);
}

static inline void sample_visible(const base *b, const real w[3], const real u[3], real n[3]) {
    const parts p = {R(2 * INV_PI), plain, by_length}; /* the mean length is 2 */
    visible_by_parts(&p, b, w, u, n);
}

enum { TRAITS = PICKS };

#define DISTRIBUTION exponential
#include "core/bsdf/transformed.h"
