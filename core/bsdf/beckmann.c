/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * beckmann.c: Gaussian slopes (Beckmann & Spizzichino 1963), shape-invariant: slopes in units of alpha, no
 * parameter. P22 = exp(-X) / pi with X the squared slope (Walter et al. 2007, Eq. (25)); z Lambda = r/2 ierfc(z/r), exact (Smith
 * 1967; their Eq. (26) in other words). D cos: their Eq. (28), (29). Visible normals: cap.h.
 */
#include "core/bsdf/cap.h"
#include "core/bsdf/ierfc.h"
#include "core/bsdf/random.h"
#include "core/bsdf/shape_invariant.h"

static inline real density(const base *b, const real u[3], real n2) {
    (void)b;
    const real z2 = larger(u[2] * u[2], REAL_MIN), t = n2 / z2, e = exp(-flat_square(u) / z2 / 2);
    return e > 0 ? smaller(R(INV_PI) * square(e * t), REAL_MAX) : 0; /* t may be infinite where e is 0 */
}

static inline real z_lambda(const base *b, const real w[3]) {
    (void)b;
    const real r = sqrt(flat_square(w));
    return r / 2 * ierfc(w[2] / larger(r, REAL_MIN));
}

static inline void sample_slope(const base *b, const real u[3], real n[3]) {
    (void)b;
    slope_normal(sqrt(-log1p(-u[0])), 1, u[1], n);
}

/* From far below, w = (r, 0, z), c = -z/r > 1: y is Gaussian, and x = c + s has the density s exp(-2cs - s²): a gamma deviate
 * of shape 2, accepted with exp(-s²), at least 0.5. Not in the paper. */
static void visible_from_below(const real w[3], real r, const real u[3], real n[3]) {
    random_stream more = random_start(u);
    const real c = -w[2] / r, y = random_normal(&more) * R(0.70710678118654752440);
    real s = 0;
    for (int k = 0; k < 128; k++) {
        s = -log((1 - random_next(&more)) * (1 - random_next(&more))) / (2 * c);
        if (random_next(&more) < exp(-s * s)) break;
    }
    n[0] = (w[0] * (c + s) - w[1] * y) / r;
    n[1] = (w[1] * (c + s) + w[0] * y) / r;
    n[2] = 1;
}

/* exp(-X) (1 + X)² is largest at X = 1: 4/e */
static inline void sample_visible(const base *b, const real w[3], const real u[3], real n[3]) {
    const real r = w[2] < 0 ? sqrt(flat_square(w)) : 0;
    if (r > 0 && -w[2] > r)
        visible_from_below(w, r, u, n);
    else
        cap_accepted(b, density, 1, R(4 * INV_PI / 2.71828182845904524), w, u, n);
}

enum { TRAITS = PICKS };

#define DISTRIBUTION beckmann
#include "core/bsdf/transformed.h"
