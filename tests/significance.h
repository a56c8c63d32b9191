/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * significance.h: the one level at which random tests fail.
 *
 * If nothing is wrong, the whole suite fails by chance with probability 0.01 (family-wise, Sidak).
 * FAMILY_SIZE bounds the number of random comparisons in all test programs together; a test that makes n of
 * them adds n to its share of that budget. Seeds are fixed before the first run and never changed: a failing
 * seed is a finding.
 */
#ifndef MU_SIGNIFICANCE_H
#define MU_SIGNIFICANCE_H

#include <math.h>

#define FAMILY_LEVEL 0.01
#define FAMILY_SIZE  4096

/* The level of a single comparison, 2.45e-6: p-values below it fail. */
static inline double significance_level(void) {
    return -expm1(log1p(-FAMILY_LEVEL) / FAMILY_SIZE);
}

/* Two-sided p-value of a standard normal deviate. */
static inline double p_of_z(double z) {
    return erfc(fabs(z) * 0.70710678118654752);
}

/* Upper tail of chi^2 with k degrees of freedom: the regularised gamma function Q(k/2, x/2)
 * (DLMF 8.7.1, 8.9.2). */
static inline double p_of_chi2(double x2, double k) {
    const double a = k / 2, x = x2 / 2;
    if (!(x > 0)) return 1;
    const double front = exp(a * log(x) - x - lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; n < 100000 && term > 1e-17 * sum; n++) sum += term *= x / (a + n);
        return 1 - front * sum;
    }
    /* Lentz's evaluation of the continued fraction. */
    double b = x + 1 - a, c = 1e300, d = 1 / b, fraction = d;
    for (int n = 1; n < 100000; n++) {
        const double an = -n * (n - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        fraction *= c * d;
        if (fabs(c * d - 1) < 1e-15) break;
    }
    return front * fraction;
}

#endif
