/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_probability.c: tail probabilities.
 *
 * Q(a,x): the power series DLMF 8.7.1 below x = a + 1, the continued fraction DLMF 8.9.2 above, each where it
 * converges fast; written here because the statistics libraries for C are under the GPL.
 */
#include "core/render/check_probability.h"

#include <float.h>
#include <math.h>

/* P(a,x) = x^a e^-x / Gamma(a+1) * (1 + x/(a+1) + x^2/((a+1)(a+2)) + ...) */
static double lower_series(double a, double x) {
    double term = 1, sum = 1;
    for (int n = 1; n < 100000 && term > DBL_EPSILON / 4 * sum; n++) sum += term *= x / (a + n);
    return sum * exp(a * log(x) - x - lgamma(a + 1));
}

/* Q(a,x) = x^a e^-x / Gamma(a) * 1/(x+1-a - 1(1-a)/(x+3-a - 2(2-a)/(x+5-a - ...))), by the modified Lentz
 * method. */
static double upper_fraction(double a, double x) {
    const double tiny = DBL_MIN / DBL_EPSILON;
    double b = x + 1 - a, c = 1 / tiny, d = 1 / b, value = d;
    for (int n = 1; n < 100000; n++) {
        const double numerator = n * (a - n);
        b += 2;
        d = b + numerator * d;
        if (fabs(d) < tiny) d = tiny;
        c = b + numerator / c;
        if (fabs(c) < tiny) c = tiny;
        d = 1 / d;
        value *= c * d;
        if (fabs(c * d - 1) < DBL_EPSILON) break;
    }
    return value * exp(a * log(x) - x - lgamma(a));
}

double mu_gamma_q(double a, double x) {
    if (!(x > 0)) return x <= 0 ? 1 : x;
    if (isinf(x)) return 0;
    return x < a + 1 ? 1 - lower_series(a, x) : upper_fraction(a, x);
}

double mu_chi2_p(double statistic, double freedom) {
    return mu_gamma_q(freedom / 2, statistic / 2);
}

double mu_bernstein_p(double deviation, double variance, double range, double n) {
    if (!(deviation > 0)) return 1;
    const double p = 2 * exp(-n * deviation * deviation / (2 * (variance + range * deviation / 3)));
    return p < 1 ? p : 1;
}

double mu_sidak(double family, size_t tests) {
    return tests ? -expm1(log1p(-family) / (double)tests) : family;
}
