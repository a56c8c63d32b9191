/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * tabulated_sampling.h: normals of a slope histogram (part of tabulated.c): by D cos, by inversion of its sums
 * (tabulated_draw.c); and visible ones, by rejection and then by inversion (tabulated_visible.c). Not in the papers.
 */
#ifndef MU_TABULATED_SAMPLING_H
#define MU_TABULATED_SAMPLING_H

#include "core/bsdf/distribution.h"
#include "core/bsdf/random.h"
#include "core/bsdf/tabulated.h"

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

#endif
