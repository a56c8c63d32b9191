/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * shadowing.h: the forms of Smith's shadowing-masking G2, from sigma and Lambda of two directions on the upper side.
 *
 * Height-correlated (Ross et al. 2005; Heitz 2014): G2 = 1 / (1 + Lambda_o + Lambda_i); separable: G1 G1. Direction- and
 * height-correlated: Eq. (13c) of Golubev 2024, "On microsurface transformations", has no valid g with g(1) = 1; what is valid, for any g in [0, 1], is
 *     G2 = 1 / (1 + max(Lambda_o, Lambda_i) + (1 - g) min(Lambda_o, Lambda_i)),   g = 1 / (1 + 4.41 phi)
 * with phi the azimuth between the two (van Ginneken et al. 1998). It never exceeds either G1, and is G1 where both
 * directions agree. phi is taken in the untransformed space, between M^-1 v and M^-1 l, so that G2 stays invariant
 * under M. A tilted microsurface has Lambda < 0 where it leans toward the viewer: that counts as 0, and G1 as 1.
 *
 * All of sigma and Lambda here carry the map's factor view_z, written s.
 */
#ifndef MU_SHADOWING_H
#define MU_SHADOWING_H

#include "core/bsdf/distribution.h"

/* g of the directions' original-space vectors. */
static inline real direction_correlation(const closure *c, const real i[3]) {
    real v[3], l[3];
    map_view(PLAN_FULL, &c->map, c->wo, v);
    map_view(PLAN_FULL, &c->map, i, l);
    for (int k = 0; k < 2; k++) v[k] = MUTANT(11, c->wo[k], v[k]), l[k] = MUTANT(11, i[k], l[k]);
    const real across = fabs(v[0] * l[1] - v[1] * l[0]), along = v[0] * l[0] + v[1] * l[1];
    return 1 / (1 + R(4.41) * atan2(across, along));
}

/* s cos_o cos_i / G2, of all plans: finite at the horizon, where G2 is 0. */
static inline real unshadowed(plan_kind plan, const closure *c, const real i[3], real sigma_i, real lambda_i,
                              int transmitted) {
    const real cos_o = c->wo[2], cos_i = i[2];
    if (plan != PLAN_FULL) return MUTANT(4, cos_i * c->sigma, cos_i * c->sigma + cos_o * lambda_i);
    const real s = c->map.view_z, lambda_o = MUTANT(12, c->lambda, larger(c->lambda, 0)),
               sigma_o = s * cos_o + lambda_o;
    lambda_i = MUTANT(12, lambda_i, larger(lambda_i, 0));
    const mu_masking_form form = c->surface->masking;
    if (form == MU_SEPARABLE) return sigma_o / s * larger(sigma_i, s * cos_i);
    if (form == MU_HEIGHT_CORRELATED || transmitted)
        return MUTANT(4, cos_i * sigma_o, cos_i * sigma_o + cos_o * lambda_i);
    const real by_o = lambda_o * cos_i, by_i = lambda_i * cos_o, g = direction_correlation(c, i);
    return s * cos_o * cos_i + larger(by_o, by_i) + (1 - g) * smaller(by_o, by_i);
}

/* G2 itself, for cosines that may be so small that their product underflows. */
static inline real shadowing_of(plan_kind plan, const closure *c, const real i[3], real lambda_i,
                                int transmitted) {
    const real s = c->map.view_z;
    const real most = REAL_MAX / 4; /* lest 0 times infinity be asked for */
    const real Lambda_o = smaller(larger(c->lambda / s / c->wo[2], 0), most),
               Lambda_i = smaller(larger(lambda_i / s / i[2], 0), most);
    const mu_masking_form form = plan == PLAN_FULL ? c->surface->masking : MU_HEIGHT_CORRELATED;
    if (form == MU_SEPARABLE) return 1 / (1 + Lambda_o) / (1 + Lambda_i);
    if (form == MU_HEIGHT_CORRELATED || transmitted) return 1 / (1 + Lambda_o + Lambda_i);
    const real g = direction_correlation(c, i);
    return 1 / (1 + larger(Lambda_o, Lambda_i) + (1 - g) * smaller(Lambda_o, Lambda_i));
}

#endif
