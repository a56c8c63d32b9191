/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * gtr_smith.c: the exact Smith integral of GTR for every gamma >= 0, and what its float table holds. Compiled once, in
 * double. Not in the paper, whose Appendix A is exact at integers only.
 */
#include "core/bsdf/gtr.h"
#include "core/bsdf/smith.h"

#if MU_REAL_BITS == 53

/* (1 - a) / -ln a  y / expm1(y), y = sign (gamma - 1) ln a */
static double over_expm1(double alpha, double gamma, double sign) {
    const double ln_a = 2 * log(alpha), y = sign * (gamma - 1) * ln_a;
    const double first = ln_a < 0 ? -(1 - alpha) * (1 + alpha) / ln_a : 1;
    return first * (y == 0 ? 1 : y > 700 ? y * exp(-y) : y / expm1(y));
}

double mu_gtr_peak(double alpha, double gamma) {
    return over_expm1(alpha, gamma, 1);
}

double mu_gtr_tail(double alpha, double gamma) {
    return over_expm1(alpha, gamma, -1);
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
static double survival_at(const void *shape, double x) {
    const survival *q = shape;
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
    if (zeta > 1e8) return mu_gtr_tail(alpha, gamma) * r / (4 * zeta); /* Q = c/x to 1e-16 */
    const survival q = survival_make(alpha, gamma);
    const double end = log(alpha) - log(fmax(1, gamma)) / 2 - 45; /* y far below all widths of Q */
    return mu_smith_z_lambda(survival_at, &q, end, r, z, digits);
}

/* phi = Lambda / that of unit GGX. */
typedef struct tabulated {
    double alpha, gamma, unit;
} tabulated;

static double phi(const void *shape, double v) {
    const tabulated *t = shape;
    double r, z;
    const double entry = smith_table_place(v, &r, &z);
    return entry * mu_gtr_z_lambda(t->alpha, t->gamma, r / t->unit, z, 9);
}

void mu_gtr_table_build(float *table, int octaves, double alpha, double gamma, double unit) {
    const tabulated shape = {alpha, gamma, unit};
    mu_smith_table_build(table, octaves, phi, &shape);
}

#endif
