/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * fresnel.c: reflectance of a flat facet, unpolarised, at the cosine between a direction and the micronormal.
 * Exact for dielectric (Walter et al. 2007, "Microfacet models for refraction through rough surfaces", Eq. (22)) and conductor
 * (Born & Wolf, Principles of Optics, Section 14.2), written as sums of squares: no difference of nearly equal numbers anywhere.
 */
#include "core/bsdf/distribution.h"

/* Schlick 1994, "An inexpensive BRDF model for physically-based rendering" */
static void schlick(const fresnel *f, real c, real out[3]) {
    const real x = 1 - c, x2 = x * x, x5 = x2 * x2 * x;
    for (int k = 0; k < 3; k++) out[k] = f->a[k] + (1 - f->a[k]) * x5;
}

/* Walter et al. 2007, Eq. (22). n_below / n_above = eta, also below 1, where F = 1 beyond the critical angle. */
real MU(fresnel_dielectric)(real eta, real c) {
    const real g2 = (eta - 1) * (eta + 1) + c * c;
    if (!(g2 > 0)) return eta == 1 ? 0 : 1;
    return MU(fresnel_between)(eta, c, sqrt(g2));
}

/* The same from both cosines, c and g = eta cos_t: next to total reflection, where F feels g alone, g from eta and c has
 * few digits. */
real MU(fresnel_between)(real eta, real c, real g) {
    const real sum = g + c, s = (eta - 1) * (eta + 1) / square(sum); /* (g - c) / (g + c) */
    const real p = (c * sum - 1) / (c * (g - c) + 1);
    return smaller(s * s * (1 + p * p) / 2, 1); /* two roundings above 1 are still above 1 */
}

/* n + ik: |.|² of both amplitudes; a + ib = sqrt((n + ik)² - sin²) */
static real conductor(real n, real k, real c) {
    const real s2 = larger((1 - c) * (1 + c), 0), t = (n - k) * (n + k) - s2, nk2 = 2 * n * k;
    const real length = hypot(t, nk2), big = sqrt((length + fabs(t)) / 2),
               small = big > 0 ? nk2 / (2 * big) : 0;
    const real a = t > 0 ? big : small, b = t > 0 ? small : big;
    const real rs = (square(a - c) + b * b) / (square(a + c) + b * b);
    const real rp = (square(a * c - s2) + square(b * c)) / (square(a * c + s2) + square(b * c));
    return smaller(rs * (1 + rp) / 2, 1);
}

void MU(fresnel_eval)(const fresnel *f, real eta, real cosine, real out[3]) {
    switch (f->kind) {
    case MU_FRESNEL_SCHLICK:
        schlick(f, cosine, out);
        return;
    case MU_FRESNEL_DIELECTRIC:
        out[0] = out[1] = out[2] = MU(fresnel_dielectric)(eta, cosine);
        return;
    case MU_FRESNEL_CONDUCTOR:
        for (int k = 0; k < 3; k++) out[k] = conductor(f->a[k], f->b[k], cosine);
        return;
    case MU_FRESNEL_NONE:
        break;
    }
    out[0] = out[1] = out[2] = 1;
}
