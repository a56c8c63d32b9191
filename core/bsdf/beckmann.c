/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * beckmann.c: Gaussian slopes (Beckmann & Spizzichino 1963), shape-invariant: slopes in units of alpha, no
 * parameter. P22 = exp(-X) / pi with X the squared slope; z Lambda = r/2 ierfc(z/r), exact (Smith 1967).
 */
#include "core/bsdf/cap.h"
#include "core/bsdf/distribution.h"
#include "core/bsdf/ierfc.h"
#include "core/bsdf/random.h"

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

/* From below (a tilted surface, or a ray on its way up) GGX would propose steep facets that a Gaussian has not. There the
 * slope along w has the density (x - k) exp(-x²) beyond k = -w.z/|w.xy|, that across it exp(-y²). With x = k + t, either
 * t exp(-t²) proposes and exp(-2kt) accepts, or the other way round: at least 1 in 4. Not in the paper. */
static void visible_from_below(const real w[3], random_stream *more, real n[3]) {
    const real r = sqrt(flat_square(w)), k = smaller(-w[2] / larger(r, REAL_MIN), R(1e9));
    const real along[2] = {r > 0 ? w[0] / r : 1, r > 0 ? w[1] / r : 0};
    real t = 0;
    for (int i = 0; i < 256; i++) {
        const real once = -log(1 - random_next(more)), twice = -log(1 - random_next(more));
        t = k < 1 ? sqrt(once) : (once + twice) / (2 * k);
        if (random_next(more) < exp(k < 1 ? -2 * k * t : -t * t)) break;
    }
    const real x = k + t, y = random_normal(more) * R(0.70710678118654752);
    n[0] = along[0] * x - along[1] * y, n[1] = along[1] * x + along[0] * y, n[2] = 1;
}

/* One GGX of the same peak proposes, exp(-X) (1 + X)² e/4 accepts: at least 0.38 of the normals, so that 128
 * in vain have probability below 1e-27. Not in the paper. */
static inline void sample_visible(const base *b, const real w[3], const real u[3], real n[3]) {
    random_stream more = random_start(u);
    if (w[2] < 0) {
        visible_from_below(w, &more, n);
        return;
    }
    real u0 = u[0], u1 = u[1], accept = u[2];
    for (int i = 0; i < 128; i++) {
        cap_visible(w, 1, u0, u1, n);
        const real n2 = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        if (accept * R(4 * INV_PI / 2.71828182845904524) < density(b, n, n2)) return;
        u0 = random_next(&more), u1 = random_next(&more), accept = random_next(&more);
    }
}

static size_t table_bytes(const mu_definition *d) {
    (void)d;
    return 0;
}

static double prepare(base *b, const mu_definition *d, void *table) {
    (void)b, (void)table;
    return d->alpha;
}

enum { TRAITS = PICKS };

#define DISTRIBUTION beckmann
#include "core/bsdf/transformed.h"
