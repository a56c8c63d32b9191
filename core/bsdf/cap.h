/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * cap.h: visible normals of GGX by spherical caps (Dupuy & Benyoub 2023), and the azimuth that all samplers
 * share.
 *
 * The base of every other exact visible-normal sampler here: they draw GGX normals and accept some.
 */
#ifndef MU_CAP_H
#define MU_CAP_H

#include "core/bsdf/distribution.h"
#include "core/bsdf/random.h"

/* A visible normal of GGX whose slope roughness is sqrt(u2), from w (any length); n of any length.
 * Not in the paper: h.z = (1 - u0)(1 + w.z) and the sine as sqrt(o (2 - o)) lose no digits near the horizon, nor does
 * 1 + w.z = r²/(1 - w.z) far below it.
 */
static inline void cap_visible(const real w[3], real root_u2, real u0, real u1, real n[3]) {
    const real x = root_u2 * w[0], y = root_u2 * w[1];
    const real inverse = 1 / sqrt(x * x + y * y + w[2] * w[2]);
    const real up = w[2] * inverse,
               cap = up < 0 ? (x * inverse * (x * inverse) + y * inverse * (y * inverse)) / (1 - up) : 1 + up;
    const real o = u0 * cap;
    const real sine = sqrt(o * (2 - o)), phi = R(2 * PI) * u1;
    n[0] = root_u2 * (sine * cos(phi) + x * inverse);
    n[1] = root_u2 * (sine * sin(phi) + y * inverse);
    n[2] = (1 - u0) * cap;
}

/*
 * Visible normals of a distribution that falls off faster than GGX, from w: one GGX of the same peak (unit roughness)
 * proposes, `density_of` over that of GGX accepts: 1/pi at 0, `bound` where it is largest, at the squared slope `turn`. At
 * least 0.38 of the normals are accepted: 128 in vain have probability below 1e-27. Not in the paper.
 * From below, where a tilt may show the microsurface, no slope under c = -w.z/r is visible, and beyond `turn` the
 * quotient at c is all that the others have to stay below. What is accepted falls as a power of c there, sigma faster:
 * where all tries are in vain, there is no normal (n = 0), for nothing to speak of is visible.
 */
static inline void cap_accepted(const base *b, real (*density_of)(const base *, const real[3], real),
                                real turn, real bound, const real w[3], const real u[3], real n[3]) {
    random_stream more = random_start(u);
    real u0 = u[0], u1 = u[1], accept = u[2];
    int tries = 128;
    if (w[2] < 0) {
        const real r2 = flat_square(w), edge[3] = {-w[2], 0, sqrt(r2)};
        if (edge[0] * edge[0] > turn * r2)
            bound = density_of(b, edge, edge[0] * edge[0] + r2) * R(1 + 64 * REAL_EPSILON);
        tries = bound > 0 ? FROM_BELOW : 0;
    }
    for (int i = 0; i < tries; i++) {
        cap_visible(w, 1, u0, u1, n);
        if (accept * bound < density_of(b, n, dot(n, n))) return;
        u0 = random_next(&more), u1 = random_next(&more), accept = random_next(&more);
    }
    n[0] = n[1] = n[2] = 0;
}

/* The same from unit roughness, its reflections no deeper than k w.z below the horizon (bounded.h); k = 1: all of them. */
static inline void cap_visible_bounded(const real w[3], real k, real u0, real u1, real n[3]) {
    const real inverse = 1 / sqrt(dot(w, w)), z = w[2] * inverse;
    const real o = u0 * (1 + k * z), sine = sqrt(o * (2 - o)), phi = R(2 * PI) * u1;
    n[0] = sine * cos(phi) + w[0] * inverse;
    n[1] = sine * sin(phi) + w[1] * inverse;
    n[2] = (1 - u0) * (1 + k * z) + (1 - k) * z;
}

/* A normal of slope length r = sqrt(x2 / z2) in the azimuth of u1. */
static inline void slope_normal(real r, real z, real u1, real n[3]) {
    const real phi = R(2 * PI) * u1;
    n[0] = r * cos(phi);
    n[1] = r * sin(phi);
    n[2] = z;
}

#endif
