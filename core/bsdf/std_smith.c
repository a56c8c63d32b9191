/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * std_smith.c: the exact Smith integral of the Student-t distribution (its authors give a fit), and its float table. Compiled
 * once, in double. Not in the papers.
 *
 * Q = (1 + X/b)^(1-gamma) in the Smith integral (smith.c) gives
 *     z Lambda = H r J,  J(T) = int_0^1 (1 + 1/(u T)²)^-p du,  T = sqrt(b) r/z,  p = gamma - 3/2
 * with no slow tail, however near to 3/2 gamma is. With u = 1 / (1 + e^-s) the singularities u T = +-i lie at |Im s| >=
 * pi/2; for large p the integrand nears a Gaussian of 1/u, which leaves a strip of pi/4: the trapezoid rule's error
 * is exp(-pi²/2h), below 1e-16 at h = 1/8; for p up to 1/2, where nothing grows before the singularities, exp(-pi²/h): 1/4
 * serves as well. Outside of left and right, where the integrand turns, its tails only fall as e^s and e^-s:
 * s = t + e^(t - right - 3) - e^(left - t - 3) makes them short and costs 5 % of the strip there.
 */
#include "core/bsdf/std.h"
#include "core/bsdf/gamma_ratio.h"
#include "core/bsdf/smith.h"

#if MU_REAL_BITS == 53

double mu_std_horizon(double gamma) {
    return gamma_ratio(gamma - 1) * sqrt(gamma - 1) / (2 * sqrt(PI));
}

/* (1 + (z / u r)²)^-p / (1 + (z/r)²)^-p, with z / r = zeta and rest = 1 - u, which rounding would lose at large p */
static double relative(double p, double zeta2, double u, double rest) {
    if (zeta2 == 0) return 1;
    return u * u < 1e-290 * zeta2 ? 0 : exp(-p * log1p(zeta2 / (u * u) * (rest * (1 + u)) / (1 + zeta2)));
}

/* (2p + 1) J / steep factor = 2F1(1, p; p + 3/2; x), x = 1 / (1 + zeta²): each term is positive and below x of the last. */
static double series(double p, double x) {
    double sum = 1, term = 1;
    for (int k = 0; term > 1e-17 * sum; k++) sum += term *= x * (p + k) / (p + 1.5 + k);
    return sum / (2 * p + 1);
}

/* J over its value's steep factor (1 + zeta²)^-p: between 1 / (2p + 1) and 1. Away from the horizon, where
 * the series has less than 200 terms, it is faster. */
static double relative_integral(double p, double zeta2) {
    if (zeta2 >= 0.25) return series(p, 1 / (1 + zeta2));
    const double h = p <= 0.5 ? 0.25 : 0.125;
    /* Where u T = 1, e^-20 of the whole at least, and where 1 - u comes to 1/p. */
    const double left = zeta2 > 1e-17 ? -log1p(1 / zeta2) / 2 : -20, start = left > -20 ? left : -20;
    const double right = log1p(2 * p * zeta2 / (1 + zeta2));
    double sum = 0;
    for (double t = right + 6.5; t > -30; t -= h) {
        const double up = exp(t - right - 3), down = exp(start - t - 3), s = t + up - down;
        const double e = exp(-fabs(s)), large = 1 / (1 + e), small = e / (1 + e);
        const double u = s > 0 ? large : small, rest = s > 0 ? small : large;
        const double term = (1 + up + down) * relative(p, zeta2, u, rest) * (large * small); /* ds/dt, du/ds */
        sum += term;
        if (term < 1e-18 * sum) break;
    }
    return h * sum;
}

double mu_std_integral(double p, double r, double z) {
    if (!(r > 0)) return 0;
    const double zeta = z / r, zeta2 = zeta * zeta;
    return exp(-p * log1p(zeta2)) * relative_integral(p, zeta2);
}

/* v = tan²(theta/2) in units of alpha, in which sqrt(b) r/z = T */
static double phi(const void *shape, double v) {
    const double gamma = *(const double *)shape, zeta = (1 - v) / (2 * sqrt(v * (gamma - 1)));
    return relative_integral(gamma - 1.5, zeta * zeta);
}

void mu_std_table_build(float *table, int octaves, double gamma) {
    mu_smith_table_build(table, octaves, phi, &gamma);
}

#endif
