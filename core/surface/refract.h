/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * refract.h: light refracted once by the facets of a baked surface between two dielectrics, the transmitted part of
 * Eq. (11f) of On Microsurface Transformations (Golubev), each facet seen at one point:
 *     L_t(v) = 1/eta^2 sum over facets of (v.m) A (1 - F(v.m)) L(t) V(v) V(t) / ((v.n) A_macro),
 * eta = eta_t/eta_v the index on the far side, t's, over that on the viewer's; t by Snell's law, Eq. (12b). The paper
 * prints the inverse of the factor 1/eta^2, against its own Eq. (9c), where eta_t is the viewer's: radiance over the square of
 * the index is what refraction keeps, so light is dimmer where the index is lower. Without the factor, and with L = 1,
 * the sum is the share of the light along v that gets through.
 *
 * L(t) is the light that comes along -t from below; V(t) is underside.h's. Written apart from core/bsdf, so that explicit
 * surfaces test the material. Frame and the rest: reflect.h.
 */
#ifndef MU_REFRACT_H
#define MU_REFRACT_H

#include "core/surface/reflect.h"

/* Where the facet of unit normal m sends unit w, w.m = cosine > 0; false: it reflects all. Unit t, t.m < 0. */
_Bool mu_refract(double eta, const double w[3], const double m[3], double cosine, double t[3]);

/* Unit normal of the baked facet, and w refracted by it; returns (w.m) A / ((w.n) A_macro), or 0 if it turns away. t is 0
 * if it reflects all. */
double mu_facet_refract(const mu_heightfield *f, const double m[4], const double w[3], double eta, uint32_t i,
                        uint32_t j, int upper, double normal[3], double t[3]);

/*
 * L_t from groups of facets that do not reflect all, F and L asked once per group, at its mean normal. This one does not
 * reflect all either: what refracts are the normals of a cap about w, which holds the mean of any that it holds.
 */
double mu_refract_groups(const mu_group *groups, size_t count, const double w[3], double eta,
                         const mu_lighting *lighting);

#endif
