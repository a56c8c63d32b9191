/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * ggx.c: GGX (Trowbridge & Reitz 1975, Walter et al. 2007), shape-invariant: slopes in units of alpha, no
 * parameter. P22 = 1 / (pi (1 + X)²) with X the squared slope (Walter et al. 2007, Eq. (33)); Lambda = (sqrt(1 + tan²) - 1) / 2
 * (their Eq. (34): G1 = 1 / (1 + Lambda)). D cos: their Eq. (35), (36). Visible normals: cap.h.
 */
#include "core/bsdf/cap.h"
#include "core/bsdf/shape_invariant.h"

static inline real density(const base *b, const real u[3], real n2) {
    (void)b;
    const real t = n2 / (flat_square(u) + u[2] * u[2]);
    return R(INV_PI) * t * t;
}

static inline real z_lambda(const base *b, const real w[3]) {
    (void)b;
    const real r2 = flat_square(w);
    return r2 / larger(2 * (sqrt(w[2] * w[2] + r2) + w[2]),
                       REAL_MIN); /* (sqrt - z) / 2 without its cancellation */
}

static inline void sample_slope(const base *b, const real u[3], real n[3]) {
    (void)b;
    slope_normal(sqrt(u[0]), sqrt(1 - u[0]), u[1], n);
}

static inline void sample_visible(const base *b, const real w[3], const real u[3], real n[3]) {
    (void)b;
    cap_visible(w, 1, u[0], u[1], n);
}

enum { TRAITS = IS_UNIT_GGX };

#define DISTRIBUTION ggx
#include "core/bsdf/transformed.h"
