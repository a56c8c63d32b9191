/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * linear_map.h: the 2x2 map M of Eq. (9) acting on directions and micronormals. It knows no distribution.
 *
 * Everything a distribution answers is homogeneous: D of an unnormalised normal has degree -4, the projected
 * area sigma of an unnormalised direction degree 1. So nothing is ever normalised, and Eq. (22) reads
 *
 *     D_M(m) = |det M| / |M^T m|^4 D(M^T m / |M^T m|) = |det M| D(M^T m) = D(|det M|^(-1/4) M^T m).
 *
 * Choosing the scale in advance keeps every intermediate within range for M scaled by 1e+-12 and more, in
 * float.
 */
#ifndef MU_LINEAR_MAP_H
#define MU_LINEAR_MAP_H

#include "core/bsdf/mutant.h"
#include "core/bsdf/real.h"

/* Prepares M (two rows) for a distribution whose slopes are measured in units of `unit`. 0 if M is singular.
 */
int MU(map_make)(map *out, const double m[4], double unit);
/* Raises the smaller slope roughness of a surface of roughness `base` (in slope units) under the map to at least
 * `alpha`; 1 if it did, and then the map is that of roughness 1. */
int MU(map_widen)(map *m, double base, double alpha);

/* What a kernel was compiled for. */
typedef enum map_kind { MAP_GENERAL, MAP_UNIFORM } map_kind; /* MAP_UNIFORM: M is a multiple of 1 */

/* v = (rows [a b], [c d]) u. */
static inline void matrix_times(map_kind kind, real a, real b, real c, real d, const real u[2], real v[2]) {
    v[0] = kind == MAP_UNIFORM ? a * u[0] : a * u[0] + b * u[1];
    v[1] = kind == MAP_UNIFORM ? a * u[1] : c * u[0] + d * u[1];
}

/* u = M^T m, Eq. (13) and (14), in slope units: |u_xy|^2 and u_z^2. */
static inline void map_normal(map_kind kind, const map *m, const real n[3], real *r2, real *z2) {
    real u[2];
    matrix_times(kind, m->normal[0], m->normal[1], m->normal[2], m->normal[3], n, u);
    *r2 = smaller(u[0] * u[0] + u[1] * u[1], REAL_MAX / 16); /* saturates rather than overflow */
    *z2 = square(m->normal_z * n[2]);
}

/* w = M^-1 v, Eq. (12), times view_z. */
static inline void map_view(map_kind kind, const map *m, const real v[3], real w[3]) {
    matrix_times(kind, m->view[0], m->view[1], m->view[2], m->view[3], v, w);
    w[2] = m->view_z * v[2];
}

/* m = M^-T u, Eq. (26), not normalised. */
static inline void map_normal_back(map_kind kind, const map *m, const real u[3], real n[3]) {
    matrix_times(kind, m->view[0], m->view[2], m->view[1], m->view[3], u, n);
    n[2] = m->view_z * u[2];
}

#endif
