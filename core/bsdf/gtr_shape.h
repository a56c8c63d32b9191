/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * gtr_shape.h: generalised Trowbridge-Reitz (Burley 2012), Eq. (32) and (33), for every gamma >= 0: its density and its
 * samplers, which exact (gtr.c) and approximate masking (gtr_spline.c) share.
 * In units of the slope unit U (squared) it is a GGX-like square times a power of a ratio in [a, 1], with no
 * 0/0 at gamma = 1 or alpha = 1 and no cancellation: gamma >= 1: U = a / max(1, peak), so that large gamma,
 * which nears Beckmann, keeps its width near 1; gamma <  1: U = 1, since the mass lies at slopes near 1
 * however small alpha is.
 */
#ifndef MU_GTR_SHAPE_H
#define MU_GTR_SHAPE_H

#include "core/bsdf/cap.h"
#include "core/bsdf/gtr.h"
#include "core/bsdf/gtr_mixture.h"

_Static_assert((int)GTR_SHAPE <= (int)MU_SHAPE, "GTR has more constants than a base holds");

static inline real density(const base *b, const real u[3], real n2) {
    const real *g = b->shape;
    const real r2 = flat_square(u), z2 = u[2] * u[2];
    const real ref = z2 + g[GTR_REF] * r2, other = g[GTR_OTHER_Z] * z2 + g[GTR_UNIT] * r2 * g[GTR_UNIT];
    const real t = n2 / ref;
    return g[GTR_SCALE] * t * t * pow(larger(other / ref, REAL_MIN), g[GTR_EXPONENT]);
}

/* D cos by inverting its distribution function in q = (x + a) / (1 + x); ln(q/a) and ln q apart, so that x
 * keeps its digits at both ends. */
static inline void sample_slope(const base *b, const real u[3], real n[3]) {
    const real *g = b->shape;
    const real d = g[GTR_D], ln_a = -2 * g[GTR_L], y = d * ln_a, alpha = g[GTR_ALPHA];
    real above = -ln_a * u[0], below = ln_a * (1 - u[0]); /* ln(q/a) and ln q, for d = 0 */
    if (d != 0) {
        above = log1p(u[0] * expm1(-y)) / d;
        below = log1p((1 - u[0]) * expm1(y)) / d;
        if (y > 40) below = above + ln_a; /* expm1 overflows, but nothing cancels */
        if (y < -40) above = below - ln_a;
    }
    /* alpha sqrt(expm1), which may be 0 times infinity if it is taken apart */
    const real r = above > 40 ? exp(above / 2 - g[GTR_L]) : alpha * sqrt(larger(expm1(above), 0));
    slope_normal(r / g[GTR_UNIT], sqrt(larger(-expm1(below), REAL_MIN)), u[1], n);
}

/* gamma < 2: one GGX of the mixture, then its cap. Not in the paper. */
static inline void sample_visible(const base *b, const real w[3], const real u[3], real n[3]) {
    const real *g = b->shape, unit = g[GTR_UNIT];
    if (g[GTR_BOUND] == 0) {
        random_stream more = random_start(u);
        const real r = sqrt(w[0] * w[0] + w[1] * w[1]) / unit;
        cap_visible(w, sqrt(mixture_u(g, r, w[2], u[2], &more)) / unit, u[0], u[1], n);
        return;
    }
    cap_accepted(b, density, g[GTR_TURN], g[GTR_BOUND], w, u, n);
}

static double unit_of(double alpha, double gamma) {
    return gamma < 1 ? 1 : fmax(alpha / sqrt(fmax(1, mu_gtr_peak(alpha, gamma))), 1e-300);
}

/* Returns the slope unit. */
static double shape_prepare(base *b, const mu_definition *definition) {
    real *g = b->shape;
    const double alpha = definition->alpha, gamma = definition->gamma;
    const double unit = unit_of(alpha, gamma), a = alpha * alpha, peak = mu_gtr_peak(alpha, gamma),
                 d = 1 - gamma;
    const double ref = gamma < 1 ? 1 : 1 / fmax(1, peak), L = -log(alpha);
    /* P22(0) = peak / (pi a); for gamma < 1, c / pi */
    g[GTR_SCALE] = R(INV_PI * (gamma < 1 ? mu_gtr_tail(alpha, gamma) : peak * ref));
    g[GTR_REF] = R(ref);
    g[GTR_OTHER_Z] = R(gamma < 1 ? a : 1);
    g[GTR_UNIT] = R(unit);
    g[GTR_EXPONENT] = R(gamma < 1 ? -gamma : gamma - 2);
    g[GTR_D] = R(d);
    g[GTR_L] = R(L);
    g[GTR_ALPHA] = R(alpha);
    g[GTR_GAMMA] = R(gamma);
    g[GTR_BOUND] = 0;
    if (gamma >= 2) {
        /* D over GGX of the same peak is 1 at 0, R² a^(gamma-2) at infinity, and has one stationary point
         * between */
        const double u2 = unit * unit, below = gamma * ref - 2 * ref + 2 * u2 * ref - gamma * u2;
        const double x = fmax(0, (2 + (gamma - 2) * u2 - gamma * ref) / below);
        const double wide = (1 + x) / (1 + ref * x),
                     there = wide * wide * pow((1 + u2 * x) / (1 + ref * x), gamma - 2);
        const double end = peak * peak * exp(-2 * (gamma - 2) * L),
                     bound = fmax(fmax(1, isfinite(there) ? there : 1), end);
        g[GTR_TURN] = R(there >= fmax(1, end) ? x : 1e30); /* or it never falls */
        g[GTR_BOUND] = R(INV_PI * bound * (1 + 4 * REAL_EPSILON));
    } else {
        mixture_prepare(g, d, L);
    }
    b->table = NULL;
    return unit;
}

#endif
