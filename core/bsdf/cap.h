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

#include "core/bsdf/real.h"

/* A visible normal of GGX whose slope roughness is sqrt(u2), from w (any length); n of any length.
 * Not in the paper: h.z = (1 - u0)(1 + w.z) and the sine as sqrt(o (2 - o)) lose no digits near the horizon.
 */
static inline void cap_visible(const real w[3], real root_u2, real u0, real u1, real n[3]) {
    const real x = root_u2 * w[0], y = root_u2 * w[1];
    const real inverse = 1 / sqrt(x * x + y * y + w[2] * w[2]);
    const real o = u0 * (1 + w[2] * inverse);
    const real sine = sqrt(o * (2 - o)), phi = R(2 * PI) * u1;
    n[0] = root_u2 * (sine * cos(phi) + x * inverse);
    n[1] = root_u2 * (sine * sin(phi) + y * inverse);
    n[2] = (1 - u0) * (1 + w[2] * inverse);
}

/* The same from unit roughness, its reflections no deeper than k w.z below the horizon (bounded.h); k = 1: all of them. */
static inline void cap_visible_bounded(const real w[3], real k, real u0, real u1, real n[3]) {
    const real inverse = 1 / sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]), z = w[2] * inverse;
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
