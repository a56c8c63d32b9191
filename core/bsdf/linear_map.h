/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * linear_map.h: the 2x2 map M of Eq. (9), and a tilt, acting on directions and micronormals. It knows no
 * distribution.
 *
 * Everything a distribution answers is homogeneous: D of an unnormalised normal has degree -4, the projected
 * area sigma of an unnormalised direction degree 1. So nothing is ever normalised, and Eq. (22) reads
 *
 *     D_M(m) = |det M| / |M^T m|^4 D(M^T m / |M^T m|) = |det M| D(M^T m) = D(|det M|^(-1/4) M^T m).
 *
 * Choosing the scale in advance keeps every intermediate within range for M scaled by 1e+-12 and more, in
 * float.
 *
 * Not in the paper: a tilt t adds t.p to the height over position p before M acts, so that the mean slope of the
 * microsurface is t: (p, h) -> (M p, h + t.p), of determinant det M as before. Whatever holds for M holds for it.
 */
#ifndef MU_LINEAR_MAP_H
#define MU_LINEAR_MAP_H

#include "core/bsdf/mutant.h"
#include "core/bsdf/real.h"

/* Prepares M (two rows) and the tilt for a distribution whose slopes are measured in units of `unit`. 0 if M is
 * singular. */
int MU(map_make)(map *out, const double m[4], const double tilt[2], double unit);
/* Raises the smaller slope roughness of a surface of roughness `base` (in slope units) under the map to at least
 * `alpha`; 1 if it did, and then the map is that of roughness 1. The mean slope stays. */
int MU(map_widen)(map *m, double base, double alpha);

/* The map as a surface of roughness 1 has to have it to stand for one whose slopes have the covariance L L^T, L = [root[0]
 * 0; root[1] root[2]] in slope units: a Gaussian's alpha² is twice its variance. To be widened: its normals are not set. */
void MU(map_stand_for)(map *m, const double root[3]);

/* The smaller singular value of (slope unit) M^-T = view^T / view_z: the least slope roughness, in slopes, of what is 1 in
 * slope units. Sums of squares in place of the difference that would cancel. */
static inline real map_least(const map *m) {
    const real *t = m->view, det = square(square(m->normal_z));
    const real plus = square(t[0] + t[3]) + square(t[1] - t[2]),
               minus = square(t[0] - t[3]) + square(t[1] + t[2]);
    return 2 * det * m->view_z / (sqrt(plus) + sqrt(minus));
}

/* What a kernel was compiled for. */
typedef enum plan_kind {
    PLAN_GENERAL, /* any M */
    PLAN_UNIFORM, /* M is a multiple of 1: no matrix is multiplied */
    PLAN_FULL, /* any M, with all that the two others leave out: tilt, masking forms, refraction, mixed samplers */
    PLAN_COMPENSATED, /* the full plan, and multiple scattering by tables of what it loses (compensated.c) */
    PLAN_WALK,        /* the full plan, and multiple scattering by random walks (walk.c) */
    PLAN_COUNT
} plan_kind;

/* v = (rows [a b], [c d]) u. */
static inline void matrix_times(plan_kind plan, real a, real b, real c, real d, const real u[2], real v[2]) {
    v[0] = plan == PLAN_UNIFORM ? a * u[0] : a * u[0] + b * u[1];
    v[1] = plan == PLAN_UNIFORM ? a * u[1] : c * u[0] + d * u[1];
}

/* u = M^T m, Eq. (13) and (14), in slope units. */
static inline void map_normal(plan_kind plan, const map *m, const real n[3], real u[3]) {
    matrix_times(plan, m->normal[0], m->normal[1], m->normal[2], m->normal[3], n, u);
    u[2] = m->normal_z * n[2];
    if (plan == PLAN_FULL) u[0] += m->tilt[0] * u[2], u[1] += m->tilt[1] * u[2];
}

/* w = M^-1 v, Eq. (12), times view_z. Returns what the tilt adds to w.z. */
static inline real map_view(plan_kind plan, const map *m, const real v[3], real w[3]) {
    matrix_times(plan, m->view[0], m->view[1], m->view[2], m->view[3], v, w);
    const real raised = plan == PLAN_FULL ? -(m->tilt[0] * w[0] + m->tilt[1] * w[1]) : 0;
    w[2] = m->view_z * v[2] + raised;
    return raised;
}

/* View_z times the mean slope of the transformed microsurface, M^-T t; by sign, what its normals lean to is minus that. */
static inline void map_mean(const map *m, real mean[2]) {
    for (int k = 0; k < 2; k++) mean[k] = m->tilt[0] * m->view[k] + m->tilt[1] * m->view[2 + k];
}

/* m = M^-T u, Eq. (26), not normalised. */
static inline void map_normal_back(plan_kind plan, const map *m, const real u[3], real n[3]) {
    const real flat[2] = {u[0] - (plan == PLAN_FULL ? m->tilt[0] * u[2] : 0),
                          u[1] - (plan == PLAN_FULL ? m->tilt[1] * u[2] : 0)};
    matrix_times(plan, m->view[0], m->view[2], m->view[1], m->view[3], flat, n);
    n[2] = m->view_z * u[2];
}

#endif
