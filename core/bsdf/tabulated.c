/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * tabulated.c: any distribution of slopes, as a histogram: the data-driven black box of Section 4.5. P22 is constant in each
 * cell; slopes in units of their root mean square; the histogram's mean slope is no business of this file (surface.c).
 */
#include "core/bsdf/padded.h"
#include "core/bsdf/tabulated_masking.h"
#include "core/bsdf/tabulated_sampling.h"

static inline real density(const base *b, const real u[3], real n2) {
    const real *origin = b->shape + TABULATED_ORIGIN, *per = b->shape + TABULATED_PER_CELL,
               *cells = b->shape + TABULATED_CELLS;
    const real inverse = 1 / larger(u[2], REAL_MIN);
    const real x = (u[0] * inverse - origin[0]) * per[0], y = (u[1] * inverse - origin[1]) * per[1];
    if (!(x >= 0 && x < cells[0] && y >= 0 && y < cells[1])) return 0;
    const tabulated *t = b->table;
    const real p22 = ((const real *)t->density)[(size_t)y * t->grid.columns + (size_t)x],
               t2 = n2 * inverse * inverse;
    return p22 > 0 ? smaller(p22 * t2 * t2, REAL_MAX) : 0;
}

static size_t table_bytes(const mu_definition *d) {
    return padded(sizeof(tabulated)) + padded(mu_tabulated_grid_bytes(d)) +
           padded(d->histogram_columns * d->histogram_rows * sizeof(real)) +
           (MU_REAL_BITS == 24 ? mu_tabulated_table_bytes() : 0);
}

static double prepare(base *b, const mu_definition *d, void *table) {
    tabulated *t = table;
    char *memory = (char *)table + padded(sizeof *t);
    tabulated_grid *g = &t->grid;
    mu_tabulated_grid_make(g, d, (double *)(void *)memory);
    memory += padded(mu_tabulated_grid_bytes(d));
    real *const p22 = (real *)(void *)memory;
    t->density = p22;
    for (size_t j = 0; j < g->rows; j++)
        for (size_t i = 0; i < g->columns; i++)
            p22[j * g->columns + i] = R(fmin(mu_tabulated_density(g, d, i, j), (double)REAL_MAX));
    memory += padded(d->histogram_columns * d->histogram_rows * sizeof(real));
    t->away = NULL;
    if (MU_REAL_BITS == 24) {
        mu_tabulated_table_build(g, (float *)(void *)memory);
        t->away = (float *)(void *)memory;
    }
    for (int k = 0; k < 2; k++) {
        b->shape[TABULATED_ORIGIN + k] = R(g->origin[k]);
        b->shape[TABULATED_PER_CELL + k] = R(1 / g->cell[k]);
    }
    b->shape[TABULATED_CELLS] = R(g->columns), b->shape[TABULATED_CELLS + 1] = R(g->rows);
    for (int k = 0; k < 3; k++) b->shape[TABULATED_ROOT + k] = R(g->root[k]);
    b->table = table;
    double mean[2], covariance[3];
    mu_tabulated_moments(d, mean, covariance);
    return mu_tabulated_spread(covariance);
}

enum { TRAITS = PICKS | ANISOTROPIC | HAS_JUMPS };

#define DISTRIBUTION tabulated
#include "core/bsdf/transformed.h"
