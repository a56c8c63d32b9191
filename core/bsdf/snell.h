/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * snell.h: the geometry of refraction at one facet, in the forms that keep their digits where eta is near 1 and near total
 * reflection. Walter et al. 2007, "Microfacet models for refraction through rough surfaces": H is their Eq. (16), i their Eq.
 * (40), |H|² what stands below in their Eq. (17). Unit vectors. The forms: not in the papers.
 *
 * Both directions are on one side: i is the light's direction turned over, -wi (a microsurface seen from below shows the
 * same slopes as its point reflection). eta = n_i / n_o. The unnormalised half-vector
 *     H = +-(eta i - o)
 * is normal to the facet that refracts o into -i; (o.h - eta i.h)², which stands in the textbook, is |H|².
 */
#ifndef MU_SNELL_H
#define MU_SNELL_H

#include "core/bsdf/distribution.h"

/* The facet between o and i; H2 is |H|², 0 if there is none, facing that side. */
typedef struct MU(mu_refraction) {
    real H[3], H2;
    real o_H, i_H;
} refraction;

/* |H|² = (eta - 1)² + eta |i - o|² does not cancel. Nothing is bent where eta is 1: no one facet is the one. */
static inline refraction refraction_between(real eta, const real o[3], const real i[3]) {
    refraction r = {.H2 = 0};
    const real sign = eta > 1 ? R(1) : R(-1);
    real apart2 = 0;
    for (int k = 0; k < 3; k++) {
        const real apart = i[k] - o[k];
        apart2 += apart * apart;
        r.H[k] = sign * ((eta - 1) * i[k] + apart);
        r.o_H += r.H[k] * o[k], r.i_H += r.H[k] * i[k];
    }
    if (eta != 1 && r.H[2] > 0 && r.o_H > 0 && r.i_H > 0) r.H2 = square(eta - 1) + eta * apart2;
    return r;
}

/* (o.h)(i.h) / |H|² times d: by this, and the light's eta², a density of facets becomes one of refracted directions. */
static inline real refraction_spread(const refraction *r, real d) {
    return d * (r->o_H / r->H2) * (r->i_H / r->H2);
}

/* F of that facet, from both cosines (fresnel.c). */
static inline real refraction_fresnel(real eta, const refraction *r) {
    const real length = sqrt(r->H2);
    return MU(fresnel_between)(eta, smaller(r->o_H / length, 1), eta * smaller(r->i_H / length, 1));
}

/* The direction i into which m (unit, o.m = `facing` > 0) refracts o. Returns H.m = eta i.m - o.m; in total reflection i is 0.
 * eta i = o + (sqrt(eta² - sin²) - cos) m, the difference without its cancellation. */
static inline real refract(real eta, const real o[3], const real m[3], real facing, real i[3]) {
    const real inside = square(eta) - (1 - facing) * (1 + facing);
    if (!(inside > 0)) {
        i[0] = i[1] = i[2] = 0;
        return 0;
    }
    const real along = (eta - 1) * (eta + 1) / (sqrt(inside) + facing);
    real length2 = 0;
    for (int k = 0; k < 3; k++) i[k] = (o[k] + along * m[k]) / eta, length2 += i[k] * i[k];
    for (int k = 0; k < 3; k++) i[k] /= sqrt(length2);
    return along;
}

#endif
