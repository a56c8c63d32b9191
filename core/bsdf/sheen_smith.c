/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* sheen_smith.c: the exact Smith integral of the sheen distribution (its authors give a fit), and its float table. Compiled
 * once, in double. Slopes in units of sqrt(k + 1). Not in the papers. */
#include "core/bsdf/sheen.h"
#include "core/bsdf/gamma_ratio.h"
#include "core/bsdf/smith.h"

#if MU_REAL_BITS == 53

double mu_sheen_k(double alpha) {
    return fmin(0.5 / alpha, 1e290);
}

/* Gamma(k + 3/2) / (sqrt(pi) Gamma(k + 1) sqrt(k + 1)) */
double mu_sheen_horizon(double k) {
    return (k + 0.5) / (k + 1) * gamma_ratio(k + 1) * sqrt((k + 1) / PI);
}

/* 1 - (x / (1 + x))^(k+1), x = (k + 1) X */
static double survival(const void *shape, double X) {
    const double k1 = *(const double *)shape + 1;
    return -expm1(-k1 * log1p(1 / (k1 * X)));
}

double mu_sheen_z_lambda(double k, double r, double z, int digits) {
    if (!(r > 0)) return 0;
    const double zeta = z / r;
    if (zeta > 1e8) return r / (4 * zeta); /* survival = 1/X to 1e-16 */
    return mu_smith_z_lambda(survival, &k, -80, r, z, digits);
}

static double phi(const void *shape, double v) {
    double r, z;
    const double entry = smith_table_place(v, &r, &z);
    return entry * mu_sheen_z_lambda(*(const double *)shape, r, z, 9);
}

void mu_sheen_table_build(float *table, int octaves, double k) {
    mu_smith_table_build(table, octaves, phi, &k);
}

#endif
