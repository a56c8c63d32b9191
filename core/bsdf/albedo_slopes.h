/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_slopes.h: a closure's microsurface as a density of slopes p of the distribution's own space, in slope units, for
 * the quadrature of its albedo. With V = s M^-1 (rows) the world's micronormal there is (mu, 1), mu = V^T (p - tilt).
 */
#ifndef MU_ALBEDO_SLOPES_H
#define MU_ALBEDO_SLOPES_H

#include "core/bsdf/distribution.h"

#if MU_REAL_BITS == 24

typedef struct albedo_slopes {
    const closure *c;
    double v[4], det, tilt[2];
} albedo_slopes;

static inline albedo_slopes albedo_slopes_of(const closure *c) {
    const double z = (double)c->map.view_z;
    albedo_slopes s = {.c = c};
    for (int k = 0; k < 4; k++) s.v[k] = (double)c->map.view[k] / z;
    for (int k = 0; k < 2; k++) s.tilt[k] = (double)c->map.tilt[k];
    s.det = fabs(s.v[0] * s.v[3] - s.v[1] * s.v[2]);
    return s;
}

/* P22 at p, per slope unit²; and the unit micronormal there. */
static inline double albedo_slope_density(const albedo_slopes *s, const double p[2], double unit[3]) {
    const double q[2] = {p[0] - s->tilt[0], p[1] - s->tilt[1]};
    const double x = s->v[0] * q[0] + s->v[2] * q[1], y = s->v[1] * q[0] + s->v[3] * q[1],
                 up2 = 1 / (x * x + y * y + 1), up = sqrt(up2);
    unit[0] = x * up, unit[1] = y * up, unit[2] = up;
    const float normal[3] = {(float)unit[0], (float)unit[1], (float)up};
    return (double)s->c->kernel->density(s->c, normal) * (up2 * up2) * s->det;
}

#endif
#endif
