/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * gtr_smith.c: the exact Smith integral of GTR for every gamma >= 0. Compiled once, in double. Not in the
 * paper, whose Appendix A is exact at integers only.
 *
 * With Q(x) = P(slope² > x), any isotropic distribution has
 *     z Lambda(r/z) = 1/pi int_0^inf Q((z² + y²) / r²) y² / (z² + y²) dy.
 * With y = r e^s every term is positive and all singularities lie on Im s = +-pi/2, so the trapezoid rule
 * converges as exp(-pi²/h); for large gamma Q nears a Gaussian, which leaves a strip of pi/4 and
 * exp(-pi²/2h), still below 1e-16 at h = 1/8. The right tail falls as e^-s only; s = p + e^(p - right - 3)
 * makes it short and costs 5 % of the strip at the rightmost singularity.
 */
#include "core/bsdf/gtr.h"

#if MU_REAL_BITS == 53

double mu_gtr_peak(double alpha, double gamma) {
    const double ln_a = 2 * log(alpha), y = (gamma - 1) * ln_a;
    const double first = ln_a < 0 ? -(1 - alpha) * (1 + alpha) / ln_a : 1;
    return first * (y == 0 ? 1 : y > 700 ? y * exp(-y) : y / expm1(y));
}

typedef struct survival {
    double a, one_minus_a, ln_a, d, inverse; /* inverse: 1 / expm1(|d| ln a), or 1 / ln a */
} survival;

static survival survival_make(double alpha, double gamma) {
    survival q = {alpha * alpha, (1 - alpha) * (1 + alpha), 2 * log(alpha), 1 - gamma, 0};
    q.inverse = 1 / (q.d == 0 ? q.ln_a : expm1(fabs(q.d) * q.ln_a));
    return q;
}

/* Q = (q^d - 1) / (a^d - 1), q = (x + a) / (1 + x) */
static double survival_at(const survival *q, double x) {
    const double away = q->one_minus_a / (1 + x);
    const double ln_q =
        away < 0.5 ? log1p(-away) : fmax(log((x + q->a) / (1 + x)), q->ln_a); /* a may underflow */
    if (q->d == 0) return ln_q * q->inverse;
    if (q->d > 0) return expm1(q->d * ln_q) * q->inverse;
    const double above = q->a > 0 ? log1p(x / q->a) - log1p(x) : ln_q - q->ln_a; /* ln(q/a) */
    return exp(q->d * above) * expm1(-q->d * ln_q) * q->inverse;
}

double mu_gtr_z_lambda(double alpha, double gamma, double r, double z, int digits) {
    if (!(r > 0)) return 0;
    const double zeta = z / r;
    if (zeta > 1e8) { /* Q = c/x to 1e-16 */
        const double c = mu_gtr_peak(alpha, gamma) * exp((gamma - 1) * 2 * log(alpha));
        return c * r / (4 * zeta);
    }
    const survival q = survival_make(alpha, gamma);
    const double h = digits > 9 ? 0.125 : 0.25, negligible = digits > 9 ? 1e-18 : 1e-11;
    const double zeta2 = zeta * zeta, right = log1p(zeta2) / 2;
    if (survival_at(&q, zeta2) == 0)
        return 0; /* Q falls with x: large gamma, small alpha underflow throughout */
    double sum = 0, p = right + (digits > 9 ? 6.625 : 6.25);
    const double end = log(alpha) - log(fmax(1, gamma)) / 2 - 45; /* y far below all widths of Q */
    for (; p > end; p -= h) {
        const double e = exp(p - right - 3), y = exp(p + e), y2 = y * y, x = zeta2 + y2;
        const double term = (1 + e) * survival_at(&q, x) * (zeta2 > 0 ? y * (y2 / x) : y);
        sum += term;
        if (sum > 0 ? term <= negligible * sum : y2 < 1e-30 * zeta2) break; /* below zeta terms only fall */
    }
    return r / PI * h * sum;
}

#endif
