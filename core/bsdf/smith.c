/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * smith.c: the Smith integral of any isotropic distribution. Compiled once, in double. Not in the paper.
 *
 * With Q(x) = P(slope² > x),
 *     z Lambda(r/z) = 1/pi int_0^inf Q((z² + y²) / r²) y² / (z² + y²) dy.
 * With y = r e^s every term is positive and, where all singularities of Q(e^(2s)) lie on Im s = +-pi/2, the trapezoid
 * rule converges as exp(-pi²/h); a Gaussian Q leaves a strip of pi/4 and exp(-pi²/2h), still below 1e-16 at h = 1/8: h is
 * about 2 over the digits asked for.
 * The right tail falls as e^-s only where Q falls as 1/x; s = p + e^(p - right - 3) makes it short and costs 5 % of the
 * strip at the rightmost singularity.
 */
#include "core/bsdf/smith.h"

#if MU_REAL_BITS == 53

double mu_smith_step(int digits) {
    return (digits > 9 ? 2.0 : 2.25) / digits;
}

double mu_smith_z_lambda(mu_survival Q, const void *shape, double end, double r, double z, int digits) {
    const double zeta = z / r, zeta2 = zeta * zeta, right = log1p(zeta2) / 2;
    const double h = mu_smith_step(digits), negligible = pow(10, -digits - 2);
    if (Q(shape, zeta2) == 0) return 0; /* Q falls with x: it underflows throughout */
    double sum = 0, p = right + (digits > 9 ? 6.625 : 6.25);
    for (; p > end; p -= h) {
        const double e = exp(p - right - 3), y = exp(p + e), y2 = y * y, x = zeta2 + y2;
        const double term = (1 + e) * Q(shape, x) * (zeta2 > 0 ? y * (y2 / x) : y);
        sum += term;
        if (sum > 0 ? term <= negligible * sum : y2 < 1e-30 * zeta2) break; /* below zeta terms only fall */
    }
    return r / PI * h * sum;
}

#endif
