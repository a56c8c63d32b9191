/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * flake_cone.c: a cone of normals as a box in (p, q), flakes.h. Radians, the distribution's own space. Compiled once, in
 * double. Not in the paper.
 *
 * The solid angle of a sector is its azimuth times cos(theta_1) - cos(theta_2). That difference is 2 sin(theta) sin(tau)
 * for a ring and 1 - cos(theta + tau) for a cap; both equal 2 sin²(tau) at theta = tau, where one becomes the other.
 * Neither is computed as a difference, so that small cones keep their digits.
 */
#include "core/bsdf/flakes.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 53

double mu_flake_cdf_ggx(double slope2) {
    return slope2 < 1 ? slope2 / (1 + slope2) : 1 / (1 + 1 / slope2);
}

double mu_flake_cdf_beckmann(double slope2) {
    return -expm1(-slope2);
}

mu_flake_normals mu_flake_cone(mu_flake_cdf *cdf, const double m[3], double tau) {
    const double h = sin((tau > 1e-6 ? smaller(tau, PI / 2) : 1e-6) / 2);
    const double sin_tau = 2 * h * sqrt((1 - h) * (1 + h)), cos_tau = 1 - 2 * h * h;
    const double r = hypot(m[0], m[1]), length = hypot(r, m[2]);
    const double s = length > 0 ? r / length : 0, c = length > 0 ? larger(m[2], 0) / length : 1;

    const double sin_1 = s * cos_tau - c * sin_tau, cos_1 = c * cos_tau + s * sin_tau;
    const double sin_2 = s * cos_tau + c * sin_tau, cos_2 = c * cos_tau - s * sin_tau;
    const int cap = !(sin_1 > 0), horizon = !(cos_2 > 0);
    const double height = cap       ? (horizon ? 1 : sin_2 * sin_2 / (1 + cos_2))
                          : horizon ? cos_1
                                    : 2 * s * sin_tau;
    mu_flake_normals box;
    box.p[0] = cap ? 0 : cdf(square(sin_1 / cos_1));
    box.p[1] = horizon ? 1 : cdf(square(sin_2 / cos_2));
    if (box.p[1] - box.p[0] < 0x1p-40) { /* the far tail of Beckmann, where D is no more than that either */
        box.p[1] = smaller(box.p[0] + 0x1p-40, 1);
        box.p[0] = box.p[1] - 0x1p-40;
    }
    box.q_width = smaller(2 * h * h / height, 1);
    const double q = atan2(m[1], m[0]) / (2 * PI) - box.q_width / 2;
    box.q = q - floor(q);
    return box;
}

#endif
