/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * gtr_table.c: sigma of one GTR material in float, without quadrature per call. Compiled once.
 *
 * Tabulated is phi = Lambda / Lambda of unit GGX, over v = tan²(theta/2) in slope units of the material: v =
 * 1 is the horizon, included, where phi stays analytic. The singularities of phi lie on the negative v axis,
 * so pieces that are half an octave long converge as 10^-k in the degree: [2^-k, 1.5 2^-k] and [1.5 2^-k,
 * 2^-k+1], each by a polynomial of degree 7 in the mantissa, and one more piece from 0 to the last octave.
 */
#include "core/bsdf/gtr.h"

#if MU_REAL_BITS == 53

int mu_gtr_table_octaves(double unit) {
    /* the nearest singularity is at v = -unit²/4; the piece at 0 ends at a quarter of that */
    const int octaves = (int)ceil(4 - 2 * log2(unit));
    return octaves < 4 ? 4 : octaves > GTR_OCTAVES_MAX ? GTR_OCTAVES_MAX : octaves;
}

static double phi(double v, double alpha, double gamma, double unit) {
    const double z = (1 - v) / (1 + v), r = 2 * sqrt(v) / (1 + v);
    return mu_gtr_z_lambda(alpha, gamma, r / unit, z, 9) * (1 + v) / v;
}

/* The polynomial in x in [-1,1], in powers of x, through the Chebyshev points of [low, high]. */
static void fit(float *cell, double low, double high, double alpha, double gamma, double unit) {
    double f[GTR_CELL], c[GTR_CELL];
    for (int j = 0; j < GTR_CELL; j++) {
        const double x = cos(PI * (j + 0.5) / GTR_CELL);
        f[j] = phi(low + (high - low) * (x + 1) / 2, alpha, gamma, unit);
    }
    double power[GTR_CELL] = {0}, t0[GTR_CELL] = {1}, t1[GTR_CELL] = {0, 1};
    for (int k = 0; k < GTR_CELL; k++) {
        c[k] = 0;
        for (int j = 0; j < GTR_CELL; j++) c[k] += f[j] * cos(PI * k * (j + 0.5) / GTR_CELL);
        c[k] *= (k ? 2.0 : 1.0) / GTR_CELL;
        for (int i = 0; i < GTR_CELL; i++) power[i] += c[k] * t0[i];
        double next[GTR_CELL];
        for (int i = 0; i < GTR_CELL; i++) next[i] = (i ? 2 * t1[i - 1] : 0) - t0[i];
        for (int i = 0; i < GTR_CELL; i++) t0[i] = t1[i], t1[i] = next[i];
    }
    for (int i = 0; i < GTR_CELL; i++) cell[i] = fabs(power[i]) < 1e-30 ? 0 : (float)power[i];
}

void mu_gtr_table_build(float *table, int octaves, double alpha, double gamma, double unit) {
    fit(table, 0, ldexp(1, -octaves), alpha, gamma, unit);
    for (int k = 0; k < octaves; k++) {
        const double start = ldexp(1, k - octaves);
        fit(table + GTR_CELL * (1 + 2 * k), start, 1.5 * start, alpha, gamma, unit);
        fit(table + GTR_CELL * (2 + 2 * k), 1.5 * start, 2 * start, alpha, gamma, unit);
    }
}

#endif
