/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * reflect.h: light reflected once by the facets of a baked surface, Eq. (11f) of On Microsurface Transformations
 * (Golubev), each facet a mirror seen at one point:
 *     L_r(v) = sum over facets of (v.m) A F(v.m) L(r) V(v) V(r) / ((v.n) A_macro),     r = 2 (v.m) m - v.
 *
 * V(r) needs a ray of its own per facet. All of it is over one period; unit vectors, w is v.
 */
#ifndef MU_REFLECT_H
#define MU_REFLECT_H

#include "core/surface/caster.h"
#include "core/surface/statistics.h"

/* Unit normal of the baked facet, and w mirrored by it; returns (w.m) A / ((w.n) A_macro), or 0 if it turns away. */
double mu_facet_mirror(const mu_heightfield *f, const double m[4], const double w[3], uint32_t i, uint32_t j,
                       int upper, double normal[3], double r[3]);

/* V(v) V(r) of row i of one family, given V(v) of the row, `seen`; the point is (i + 1/4, j + 1/2) or (i + 3/4, ...). */
void mu_reflect_row(const mu_caster *caster, const mu_heightfield *f, const double m[4], const double w[3],
                    int upper, uint32_t i, const uint8_t *seen, uint8_t *both);

/*
 * The BRDF with F = 1, mean per bin of the direction r weighted by cos, 1/sr, from V(v) V(r) of both families, n * n
 * each. Returns the single-scatter albedo: the share of the light that leaves after one reflection.
 */
double mu_reflection_density(const mu_heightfield *f, const double m[4], const double w[3],
                             const uint8_t *const both[2], const mu_directions *d, double *out);

/* Facets sorted by their normals: per bin the sum of m (w.m) A V V / ((w.n) A_macro), and of this without m. */
typedef struct mu_group {
    double normal[3], weight;
} mu_group;
void mu_group_facets(const mu_heightfield *f, const double m[4], const double w[3],
                     const uint8_t *const both[2], const mu_directions *d, mu_group *groups);

/* The mean normal, unit; false: an empty group. */
_Bool mu_group_normal(const mu_group *group, double mean[3]);

/* Eq. (11f) from the groups, F and L asked once per group, at its mean normal. One colour. */
typedef struct mu_lighting {
    double (*fresnel)(void *context, double cosine);
    double (*radiance)(void *context, const double r[3]);
    void *context;
} mu_lighting;
double mu_reflect_groups(const mu_group *groups, size_t count, const double w[3],
                         const mu_lighting *lighting);

#endif
