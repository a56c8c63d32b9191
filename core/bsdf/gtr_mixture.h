/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * gtr_mixture.h: which GGX of the mixture (gtr.h) a visible normal of GTR comes from, 0 < gamma < 2. Not in
 * the papers.
 *
 * Seen from the direction with r/z = tan, component u shows the area z + sqrt(z² + u r²) (times 1/2), so
 *     T(s) = e^(d s) / ((1 + e^(-s-L)) (1 + e^(s-L))) (z + sqrt(z² + u r²))
 * is to be sampled. It lies below 2 z E0 + r E1, where E0 and E1 are exponentials between knots at -L and L:
 *     E0 = e^(ds) min(1, e^(s+L), e^(L-s)),   E1 = E0 times alpha | e^((s-L)/2) | 1.
 * At least 0.4 of the draws are accepted, for all alpha, gamma and directions. From below, z < 0 (a tilted surface asks
 * that), the area is u r² / (sqrt(z² + u r²) - z), below both r sqrt(u) and u r² / 2|z|: the envelope is r E1 or
 * r² / 2|z| E2 with E2 = E0 times alpha² | e^(s-L) | 1, whichever holds less.
 */
#ifndef MU_GTR_MIXTURE_H
#define MU_GTR_MIXTURE_H

#include "core/bsdf/gtr.h"
#include "core/bsdf/random.h"

/* Masses of the pieces, all times e^(-|d| L) so that none overflows: shape[GTR_LEFT] and the next three. */
static void mixture_prepare(real *shape, double d, double L) {
    const double e = d + 0.5, size = fabs(d), size_e = fabs(e);
    shape[GTR_LEFT] = R(exp(-(d + size) * L) / (1 + d));
    shape[GTR_MIDDLE] = R(size == 0 ? 2 * L : -expm1(-2 * size * L) / size);
    shape[GTR_MIDDLE_ROOT] =
        R(exp((size_e - 0.5 - size) * L) * (size_e == 0 ? 2 * L : -expm1(-2 * size_e * L) / size_e));
    shape[GTR_MIDDLE_SQUARE] = R(exp((d - size) * L) * -expm1(-2 * (1 + d) * L) / (1 + d));
    shape[GTR_RIGHT] = R(exp((d - size) * L) / (1 - d));
}

/* A draw from density ~ e^(q s) on [-L, L]. */
static inline real exponential_between(real q, real L, real u) {
    const real y = 2 * q * L;
    if (fabs(y) < R(1e-6)) return L * (2 * u - 1);
    return y > 0 ? L + log(u + (1 - u) * exp(-y)) / q : -L + log1p(u * expm1(y)) / q;
}

/* The area that component u shows, times 2. */
static inline real mixture_area(real r, real z, real u) {
    const real root = sqrt(z * z + u * r * r);
    return z >= 0 ? z + root : u * r * r / larger(root - z, REAL_MIN);
}

static inline real mixture_u(const real *shape, real r, real z, real pick, random_stream *more) {
    const real d = shape[GTR_D], L = shape[GTR_L], alpha = shape[GTR_ALPHA], a = alpha * alpha;
    const real flat = 2 * larger(z, 0); /* the envelope is flat E0 + r E1 + q E2 */
    real q = 0;
    if (z < 0) {
        const real by_root = shape[GTR_LEFT] * alpha + shape[GTR_MIDDLE_ROOT] + shape[GTR_RIGHT];
        const real by_square = shape[GTR_LEFT] * a + shape[GTR_MIDDLE_SQUARE] + shape[GTR_RIGHT];
        if (by_square * r < -2 * z * by_root) q = r / (-2 * z), q *= r;
    }
    const real root = q > 0 ? 0 : r;
    const real left = shape[GTR_LEFT] * (flat + alpha * root + a * q), middle = shape[GTR_MIDDLE] * flat,
               rooted = shape[GTR_MIDDLE_ROOT] * root, squared = shape[GTR_MIDDLE_SQUARE] * q,
               right = shape[GTR_RIGHT] * (flat + root + q);
    const real total = left + middle + rooted + squared + right;
    real u = 1;
    for (int i = 0; i < 128 && total > 0; i++) {
        real x = pick * total, ratio;
        if ((x -= left) < 0) {
            const real p = pow((x + left) / left, 1 / (1 + d)); /* e^(s+L) */
            u = a * (1 + p) / (1 + a * p);
            ratio = 1 / ((1 + p) * (1 + a * p) * (flat + alpha * root + a * q));
        } else if ((x -= middle + rooted + squared) < 0) {
            real s;
            if (x + squared >= 0)
                s = exponential_between(d + 1, L, smaller((x + squared) / squared, 1));
            else if ((x += squared) + rooted >= 0)
                s = exponential_between(d + R(0.5), L, smaller((x + rooted) / rooted, 1));
            else
                s = exponential_between(d, L, (x + rooted + middle) / middle);
            const real p = larger(exp(s - L), REAL_MIN); /* alpha e^s: no alpha is too small for it */
            u = (a + p) / (1 + p);
            ratio = 1 / ((1 + a / p) * (1 + p) * (flat + root * sqrt(p) + q * p));
        } else {
            const real p = pow(1 - smaller(x / right, 1), 1 / (1 - d)); /* e^(L-s) */
            u = (1 + a * p) / (1 + p);
            ratio = 1 / ((1 + p) * (1 + a * p) * (flat + root + q));
        }
        if (random_next(more) < ratio * mixture_area(r, z, u)) break;
        pick = random_next(more);
    }
    return u;
}

#endif
