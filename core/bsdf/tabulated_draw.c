/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* tabulated_draw.c: a place in a slope histogram by its sums: inversion of the rows, then of one row. Compiled once, in
 * double. Not in the papers. */
#include "core/bsdf/tabulated.h"

#include "core/bsdf/mutant.h"
#include "core/bsdf/real.h"

#if MU_REAL_BITS == 53

/* Where in n increasing sums, from 0 on, u of the last falls; the fraction of that step; never an empty one. */
static size_t invert(const double *sums, size_t n, double u, double *fraction) {
    const double target = u * sums[n];
    size_t low = 0, high = n;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (sums[middle] > target)
            high = middle;
        else
            low = middle;
    }
    while (low > 0 && !(sums[low + 1] > sums[low])) low--;
    *fraction = fmin((target - sums[low]) / (sums[low + 1] - sums[low]), 1);
    return low;
}

tabulated_place mu_tabulated_draw(const tabulated_grid *g, const double *sums, const double *below, double u0,
                                  double u1) {
    tabulated_place at;
    double x, y;
    at.row = invert(below, g->rows, u1, &y);
    at.column = invert(sums + MUTANT(15, 0, at.row) * (g->columns + 1), g->columns, u0, &x);
    at.p[0] = g->origin[0] + ((double)at.column + x) * g->cell[0];
    at.p[1] = g->origin[1] + ((double)at.row + y) * g->cell[1];
    return at;
}

#endif
