/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * glint.c: how many flakes of a closure's footprint have a normal near a given one, against how many there are in the
 * mean (flakes.h): what a discrete distribution multiplies D by, of the smooth one of the same normals. Masking, shadowing
 * and the samplers stay those of the smooth surface, as in Jakob et al. 2014, Section 4.
 *
 * The flakes are those of the distribution's own space, so M takes them with it. The cone of half-angle t is one of the
 * transformed normals; flakes are counted around u = M^T m in the cone of the same share of them, t² J, where
 *     J = D_M(m) cos_m / (D(u) cos_u) = |n|³ n.z / (|u|³ u.z)
 * is the solid angle of u per solid angle of m, for n and u of any length that map_normal relates (linear_map.h: D_M(m) =
 * |n|⁴ D(u) there). Not in the papers, which know no M.
 */
#include "core/bsdf/distribution.h"

real MU(glint_count)(const closure *c, const real n[3], real n2) {
    const surface *s = c->surface;
    real mapped[3];
    map_normal(PLAN_FULL, &c->map, n, mapped);
    const double u[3] = {(double)mapped[0], (double)mapped[1], (double)mapped[2]};
    const double shrink = (double)n2 / (u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    const double tau = s->flake_cone * sqrt(shrink * sqrt(shrink) / (double)c->map.normal_z);
    const mu_flake_normals box = mu_flake_cone(s->flake_cdf, u, tau);
    return R(fmin(mu_flake_ratio(&s->flakes, c->footprint, &box), (double)REAL_MAX));
}
