/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_probability.h: how surprising a statistic is, and when the surprises of a whole run are too many. */
#ifndef MU_CHECK_PROBABILITY_H
#define MU_CHECK_PROBABILITY_H

#include <stddef.h>

/* Regularised upper incomplete gamma function Q(a, x), a > 0, x >= 0. Relative error below 1e-12 for a <=
 * 1000. */
double mu_gamma_q(double a, double x);

/* P(chi^2 with that many degrees of freedom >= statistic). */
double mu_chi2_p(double statistic, double freedom);

/*
 * Bernstein's bound on P(|mean of n - its expectation| >= deviation) for independent variables of the given
 * variance that never leave an interval of length `range`. A bound for every n, unlike the normal
 * approximation, which fails exactly where these checks look: outcomes of probability 1e-5.
 */
double mu_bernstein_p(double deviation, double variance, double range, double n);

/* Level of each of `tests` independent tests such that all pass with probability 1 - family (Sidak). */
double mu_sidak(double family, size_t tests);

#endif
