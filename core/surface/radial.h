/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * radial.h: the slope density of an isotropic distribution as a table over the slope's length.
 *
 * Fits ask for ln P22 at many thousand slopes for hundreds of parameters. Any distribution of the library enters as a
 * black box: its D is asked at MU_RADIAL radii, ln P22 = ln (D cos^4) is interpolated in x = ln r by cubic Hermite
 * polynomials, and the share of steeper facets is the integral of 2 pi r^2 P22 dx over these. Slopes are tan theta,
 * unit 1. With nodes h = 0.05 apart and derivatives of fourth order the interpolation is off by h^4/384 = 1.6e-8
 * times a fourth derivative: at most 2 gamma of powers, 16 r^2/alpha^2 of Gaussians; the integral by no more.
 *
 * Below the first radius and beyond the last ln P22 goes on linearly in x, as a power. Where D is too small for a
 * double, it goes on linearly in r^2, as a Gaussian does.
 */
#ifndef MU_RADIAL_H
#define MU_RADIAL_H

#include <math.h>

#include "core/bsdf/musurf.h"

enum { MU_RADIAL = 401 };
static const double mu_radial_first = -12, mu_radial_step = 0.05; /* of ln r */

typedef struct mu_radial {
    double value[MU_RADIAL], slope[MU_RADIAL]; /* ln P22 and its derivative by ln r */
    double above[MU_RADIAL];                   /* the share of facets steeper than r */
} mu_radial;

/* Only the definition's ndf, alpha, gamma and exponent are looked at. 0 if they are refused, or `memory` (of
 * mu_radial_bytes of the definition, aligned to 16) is NULL. */
size_t mu_radial_bytes(const mu_definition *definition);
_Bool mu_radial_make(mu_radial *out, const mu_definition *definition, void *memory);
/* The share of facets steeper than exp(x). */
double mu_radial_above(const mu_radial *table, double x);

/* Where x = ln r lies among the nodes, and the weights of the values and slopes of nodes k and k + 1. */
typedef struct mu_radial_place {
    int k;
    double v0, v1, s0, s1; /* ln P22 = v0 value[k] + v1 value[k+1] + s0 slope[k] + s1 slope[k+1] */
    double dv, ds0, ds1;   /* its derivative = dv (value[k+1] - value[k]) + ds0 slope[k] + ds1 slope[k+1] */
} mu_radial_place;

static inline mu_radial_place mu_radial_find(double x) {
    const double place = (x - mu_radial_first) / mu_radial_step, h = mu_radial_step;
    if (!(place > 0)) return (mu_radial_place){0, 1, 0, x - mu_radial_first, 0, 0, 1, 0};
    if (place >= MU_RADIAL - 1) {
        const double last = mu_radial_first + (MU_RADIAL - 1) * mu_radial_step;
        return (mu_radial_place){MU_RADIAL - 2, 0, 1, 0, x - last, 0, 0, 1};
    }
    const int k = (int)place;
    const double t = place - k, u = 1 - t;
    return (mu_radial_place){k,
                             u * u * (1 + 2 * t),
                             t * t * (1 + 2 * u),
                             h * t * u * u,
                             -h * t * t * u,
                             6 * t * u / h,
                             u * (1 - 3 * t),
                             t * (3 * t - 2)};
}

static inline double mu_radial_value(const mu_radial *table, const mu_radial_place *p) {
    const double *v = table->value + p->k, *s = table->slope + p->k;
    return p->v0 * v[0] + p->v1 * v[1] + p->s0 * s[0] + p->s1 * s[1];
}

static inline double mu_radial_slope(const mu_radial *table, const mu_radial_place *p) {
    const double *v = table->value + p->k, *s = table->slope + p->k;
    return p->dv * (v[1] - v[0]) + p->ds0 * s[0] + p->ds1 * s[1];
}

#endif
