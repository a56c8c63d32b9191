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
 * serves as well.
 */
#include "core/bsdf/std.h"
#include "core/bsdf/gamma_ratio.h"
#include "core/bsdf/smith.h"

#if MU_REAL_BITS == 53

double mu_std_horizon(double gamma) {
    return gamma_ratio(gamma - 1) * sqrt(gamma - 1) / (2 * sqrt(PI));
}

/* (1 + (z / u r)²)^-p / (1 + (z/r)²)^-p, with z / r = zeta */
static double relative(double p, double zeta2, double u) {
    if (zeta2 == 0) return 1;
    return u * u < 1e-290 * zeta2 ? 0 : exp(-p * log1p(zeta2 / (u * u) * ((1 - u) * (1 + u)) / (1 + zeta2)));
}

/* J over its value's steep factor: between 1 / (2p + 1) and 1. */
static double relative_integral(double p, double zeta2) {
    const double h = p <= 0.5 ? 0.25 : 0.125,
                 step = p <= 0.5 ? 0.77880078307140486825 : 0.88249690258459540286;
    double sum = 0;
    for (int side = -1; side <= 1; side += 2) {
        double e = side < 0 ? step : 1; /* e^-hk: off by k roundings, where its weight has fallen by e^-hk */
        for (int k = side < 0 ? 1 : 0; k < 400; k++, e *= step) {
            const double u = side > 0 ? 1 / (1 + e) : e / (1 + e);
            const double term = relative(p, zeta2, u) * e / ((1 + e) * (1 + e));
            sum += term;
            if (term < 1e-18 * sum) break;
        }
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
