/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * clamp.h: the part of the major axis that reflects above the horizon, Appendix B and Eq. (8).
 *
 * The two ends have opposite slopes, so what is interpolated between their micronormals is interpolated linearly between
 * their slopes: at tau it is (1 - 2 tau) times that of the first. In the plane of the axis let a micronormal have the angle
 * theta to z, towards the first end, T = tan theta, and let f be the view's component that way: it reflects to the height
 * f sin 2 theta + o.z cos 2 theta, which is zero where o.z T² - 2 f T - o.z = 0. One root is positive, the other is -1 over
 * it; both are written here without a difference. A view along the horizon from straight across (f = o.z = 0) has the
 * limit's: 1 and -1.
 */
#ifndef MU_IBL_CLAMP_H
#define MU_IBL_CLAMP_H

#include "core/ibl/length.h"

typedef struct clamped {
    real tau[2]; /* not clamped */
    real cut[2]; /* T of the ends: cut[0] >= 0 >= cut[1] */
    real skew;   /* tau0' + tau1' - 1, from -1/2 to 1/2: what the first end loses less what the second does */
} clamped;

/* Of an axis with T between -steep and steep. */
static inline clamped clamp_axis(real f, real z, real steep) {
    const real length = length2(f, z);
    const real far = length > 0 ? fabs(f) + length : 1, other = length > 0 ? z : 1;
    const real up[2] = {f >= 0 ? far / other : other / far, f >= 0 ? other / far : far / other}; /* |T| */
    const real share[2] = {up[0] / steep, up[1] / steep}; /* infinite, or 0/0: nothing is cut */
    clamped c;
    for (int end = 0; end < 2; end++) {
        c.cut[end] = share[end] < 1 ? up[end] : steep;
        c.tau[end] = share[end] <= REAL_MAX ? (1 - share[end]) / 2 : 0;
    }
    if (share[0] < 1 && share[1] < 1)
        c.skew = -f / other / steep; /* the roots' sum is 2 f / z */
    else
        c.skew = (share[1] < 1 ? share[1] - 1 : 0) / 2 + (share[0] < 1 ? 1 - share[0] : 0) / 2;
    c.tau[1] = 1 - c.tau[1], c.cut[1] = -c.cut[1];
    return c;
}

#endif
