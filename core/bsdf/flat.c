/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * flat.c: no microfacets but the surface itself: a mirror, or a pane. D = delta(u.xy), the limit of every distribution as its
 * roughness goes to 0: it reflects, and if it transmits refracts, into one direction each. M times nothing is nothing; a tilt
 * leans the mirror and masks it as it does any other (Lambda of the slope 0: none away from the viewer is seen).
 */
#include "core/bsdf/distribution.h"

static inline real density(const base *b, const real u[3], real n2) {
    (void)b, (void)u, (void)n2;
    return 0; /* but for one normal, where it is no number: traits say so */
}

static inline real z_lambda(const base *b, const real w[3]) {
    (void)b, (void)w;
    return 0;
}

static inline void sample_slope(const base *b, const real u[3], real n[3]) {
    (void)b, (void)u;
    n[0] = n[1] = 0, n[2] = 1;
}

static inline void sample_visible(const base *b, const real w[3], const real u[3], real n[3]) {
    (void)w;
    sample_slope(b, u, n);
}

static size_t table_bytes(const mu_definition *d) {
    (void)d;
    return 0;
}

static double prepare(base *b, const mu_definition *d, void *table) {
    (void)b, (void)d, (void)table;
    return 1;
}

enum { TRAITS = IS_DELTA };

#define DISTRIBUTION flat
#include "core/bsdf/transformed.h"
