/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * smith_table.c: masking of one material in float, without quadrature per call. Compiled once. Not in the papers.
 *
 * The singularities of phi lie on the negative v axis, so pieces that are half an octave long converge as 10^-k in the
 * degree: [2^-k, 1.5 2^-k] and [1.5 2^-k, 2^-k+1], each by a polynomial of degree 7 in the mantissa.
 */
#include "core/bsdf/smith.h"

#if MU_REAL_BITS == 53

int mu_smith_octaves(double unit) {
    const int octaves = (int)ceil(4 - 2 * log2(unit));
    return octaves < 4 ? 4 : octaves > SMITH_OCTAVES_MAX ? SMITH_OCTAVES_MAX : octaves;
}

size_t mu_smith_table_bytes(int octaves) {
    return (1 + 2 * (size_t)octaves) * SMITH_CELL * sizeof(float);
}

/* The polynomial in x in [-1,1], in powers of x, through the Chebyshev points of [low, high]. */
static void fit(float *cell, double low, double high, mu_smith_phi phi, const void *shape) {
    double f[SMITH_CELL], c[SMITH_CELL];
    for (int j = 0; j < SMITH_CELL; j++) {
        const double x = cos(PI * (j + 0.5) / SMITH_CELL);
        f[j] = phi(shape, low + (high - low) * (x + 1) / 2);
    }
    double power[SMITH_CELL] = {0}, t0[SMITH_CELL] = {1}, t1[SMITH_CELL] = {0, 1};
    for (int k = 0; k < SMITH_CELL; k++) {
        c[k] = 0;
        for (int j = 0; j < SMITH_CELL; j++) c[k] += f[j] * cos(PI * k * (j + 0.5) / SMITH_CELL);
        c[k] *= (k ? 2.0 : 1.0) / SMITH_CELL;
        for (int i = 0; i < SMITH_CELL; i++) power[i] += c[k] * t0[i];
        double next[SMITH_CELL];
        for (int i = 0; i < SMITH_CELL; i++) next[i] = (i ? 2 * t1[i - 1] : 0) - t0[i];
        for (int i = 0; i < SMITH_CELL; i++) t0[i] = t1[i], t1[i] = next[i];
    }
    for (int i = 0; i < SMITH_CELL; i++) cell[i] = fabs(power[i]) < 1e-30 ? 0 : (float)power[i];
}

void mu_smith_table_build(float *table, int octaves, mu_smith_phi phi, const void *shape) {
    fit(table, 0, ldexp(1, -octaves), phi, shape);
    for (int k = 0; k < octaves; k++) {
        const double start = ldexp(1, k - octaves);
        fit(table + SMITH_CELL * (1 + 2 * k), start, 1.5 * start, phi, shape);
        fit(table + SMITH_CELL * (2 + 2 * k), 1.5 * start, 2 * start, phi, shape);
    }
}

#endif
