/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * tabulated.c: any distribution of slopes, as a histogram: the data-driven black box of Section 4.5. P22 is constant in each
 * cell; slopes in units of their root mean square; the histogram's mean slope is no business of this file (surface.c).
 */
#include "core/bsdf/tabulated.h"

#include "core/bsdf/distribution.h"
#include "core/bsdf/padded.h"
#include "core/bsdf/random.h"

typedef struct tabulated {
    tabulated_grid grid;
    real *density;     /* P22, row by row */
    const float *away; /* H; float only */
} tabulated;

static inline real density(const base *b, const real u[3], real n2) {
    const real *origin = b->shape + TABULATED_ORIGIN, *per = b->shape + TABULATED_PER_CELL,
               *cells = b->shape + TABULATED_CELLS;
    const real inverse = 1 / larger(u[2], REAL_MIN);
    const real x = (u[0] * inverse - origin[0]) * per[0], y = (u[1] * inverse - origin[1]) * per[1];
    if (!(x >= 0 && x < cells[0] && y >= 0 && y < cells[1])) return 0;
    const tabulated *t = b->table;
    const real p22 = t->density[(size_t)y * t->grid.columns + (size_t)x], t2 = n2 * inverse * inverse;
    return p22 > 0 ? smaller(p22 * t2 * t2, REAL_MAX) : 0;
}

/* Lagrange's cubic through values at -1, 0, 1, 2. */
static inline void cubic(float f, float c[4]) {
    c[0] = -f * (f - 1) * (f - 2) / 6;
    c[1] = (f + 1) * (f - 1) * (f - 2) / 2;
    c[2] = -(f + 1) * f * (f - 2) / 2;
    c[3] = (f + 1) * f * (f - 1) / 6;
}

static inline real z_lambda(const base *b, const real w[3]) {
    const tabulated *t = b->table;
#if MU_REAL_BITS == 53
    return mu_tabulated_away(&t->grid, w);
#else
    const float *root = b->shape + TABULATED_ROOT;
    const float x = root[0] * w[0] + root[1] * w[1], y = root[2] * w[1], r = sqrtf(x * x + y * y);
    if (!(r > 0)) return 0;
    const float azimuth = (atan2f(y, x) * (float)(INV_PI / 2) + 0.5f) * TABULATED_AZIMUTHS;
    const float height = w[2] / (w[2] + r) * TABULATED_HEIGHTS;
    const int a = (int)azimuth, i = height < TABULATED_HEIGHTS - 1 ? (int)height : TABULATED_HEIGHTS - 1;
    float ca[4], ch[4], sum = 0;
    cubic(azimuth - (float)a, ca), cubic(height - (float)i, ch);
    for (int k = 0; k < 4; k++) {
        const float *h = t->away + ((a + k - 1) & (TABULATED_AZIMUTHS - 1)) * TABULATED_STRIDE + i;
        sum += ca[k] * (ch[0] * h[0] + ch[1] * h[1] + ch[2] * h[2] + ch[3] * h[3]);
    }
    return larger(sum, 0) * (w[2] + r);
#endif
}

/* 24 bits do not reach every place of a million cells: random ones follow. */
static double extended(real u, random_stream *more) {
    return MU_REAL_BITS == 53 ? (double)u : (double)u + 0x1p-24 * (double)random_next(more);
}

/* The normal at p. It stays within its cell however p is rounded: by that much at most, the cell's edge is left out. */
static void normal_at(const base *b, const double p[2], real n[3]) {
    const real *s = b->shape;
    for (int k = 0; k < 2; k++) {
        const double x = (p[k] - (double)s[TABULATED_ORIGIN + k]) * (double)s[TABULATED_PER_CELL + k],
                     cells = (double)s[TABULATED_CELLS + k];
        const double edge = cells * 4 * REAL_EPSILON;
        const double cell = fmin(fmax(floor(x), 0), cells - 1);
        const double inside = fmin(fmax(x - cell, edge), 1 - edge);
        n[k] = R((double)s[TABULATED_ORIGIN + k] + (cell + inside) / (double)s[TABULATED_PER_CELL + k]);
    }
    n[2] = 1;
}

static inline void sample_slope(const base *b, const real u[3], real n[3]) {
    const tabulated_grid *g = &((const tabulated *)b->table)->grid;
    random_stream more = random_start(u);
    const double u0 = extended(u[0], &more), u1 = extended(u[1], &more);
    normal_at(b, mu_tabulated_draw(g, g->mass, g->mass_below, u0, u1).p, n);
}

static double next(void *state) {
    return extended(random_next(state), state);
}

/* The area that p shows, w.z + w.xy p, lies below w.z + |L^T w.xy| |L^-1 p|: a part with the density of D cos, and one with
 * that times a bound of |L^-1 p| over the cell. All that these propose is accepted at the normal, 0.2 to 0.3 at the horizon
 * (measured: Gaussian, GGX, noise, a narrow oblique ridge, ten cells; 16² to 1024² cells), less from below. What 24 tries leave
 * over is drawn by inversion, which costs as much as some ten tries for 16² cells, and a hundred for 256². */
static inline void sample_visible(const base *b, const real w[3], const real u[3], real n[3]) {
    const tabulated_grid *g = &((const tabulated *)b->table)->grid;
    const double v[3] = {(double)w[0], (double)w[1], (double)w[2]};
    const double r = hypot(g->root[0] * v[0] + g->root[1] * v[1], g->root[2] * v[1]);
    const double first = fmax(v[2], 0), total = first + r * g->mean_reach;
    random_stream more = random_start(u);
    double u0 = extended(u[0], &more), u1 = extended(u[1], &more), pick = (double)u[2];
    for (int k = 0; k < 24; k++) {
        const int plain = pick * total < first;
        const tabulated_place at = plain ? mu_tabulated_draw(g, g->mass, g->mass_below, u0, u1)
                                         : mu_tabulated_draw(g, g->reach, g->reach_below, u0, u1);
        const size_t stride = g->columns + 1, i = at.row * stride + at.column;
        const double reach = (g->reach[i + 1] - g->reach[i]) / (g->mass[i + 1] - g->mass[i]);
        if (next(&more) * (first + r * reach) < v[2] + v[0] * at.p[0] + v[1] * at.p[1]) {
            normal_at(b, at.p, n);
            return;
        }
        u0 = next(&more), u1 = next(&more), pick = next(&more);
    }
    const double again[2] = {next(&more), next(&more)};
    double p[2];
    mu_tabulated_visible(g, v, again, next, &more, p);
    normal_at(b, p, n);
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
    t->density = (real *)(void *)memory;
    for (size_t j = 0; j < g->rows; j++)
        for (size_t i = 0; i < g->columns; i++)
            t->density[j * g->columns + i] = R(fmin(mu_tabulated_density(g, d, i, j), (double)REAL_MAX));
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

enum { TRAITS = PICKS | ANISOTROPIC };

#define DISTRIBUTION tabulated
#include "core/bsdf/transformed.h"
