/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_slopes.c: slopes and normals of a baked surface, facet by facet, and how soon its heights forget themselves. */
#include <math.h>
#include <stdlib.h>

#include "core/render/surface_statistics.h"
#include "core/surface/rank.h"

static void baked_slope(const mu_gathering *g, const mu_heightfield *f, uint32_t i, uint32_t j, int upper,
                        double normal[3], double slope[2]) {
    double original[2];
    mu_facet_slope(f, i, j, upper, original);
    mu_facet_normal(g->m, original, normal);
    slope[0] = -normal[0] / normal[2];
    slope[1] = -normal[1] / normal[2];
}

/* Along each axis 1.25 times the magnitude that 99 % of the facets stay below. */
static _Bool choose_bounds(mu_gathering *g, const mu_heightfield *f) {
    const size_t count = 2 * mu_cells(f);
    mu_ranked *ranked = malloc(count * sizeof *ranked), *spare = malloc(count * sizeof *spare);
    for (int axis = 0; axis < 2 && ranked && spare; axis++) {
        size_t k = 0;
        for (uint32_t i = 0; i < f->nx; i++)
            for (uint32_t j = 0; j < f->ny; j++)
                for (int upper = 0; upper < 2; upper++) {
                    double normal[3], slope[2];
                    baked_slope(g, f, i, j, upper, normal, slope);
                    ranked[k++] = (mu_ranked){(float)fabs(slope[axis]), 0};
                }
        mu_rank_sort(ranked, spare, count);
        const double most = 1.25 * (double)ranked[(size_t)(0.99 * (double)count)].key;
        g->slope_bounds[2 * axis + 1] = most > 0 ? most : 1; /* a level surface still has a cell to be in */
        g->slope_bounds[2 * axis] = -g->slope_bounds[2 * axis + 1];
    }
    const _Bool good = ranked && spare;
    free(ranked);
    free(spare);
    return good;
}

/* The first lag along an axis at which the autocorrelation of the heights falls below 1/e, between lags on a line. NaN if
 * it never does within half the period. */
static double correlation_length(const mu_heightfield *f, int axis) {
    const uint32_t nx = f->nx, ny = f->ny, period = axis ? ny : nx;
    double mean = 0, before = 1, variance = 0;
    for (size_t k = 0; k < mu_cells(f); k++) mean += f->h[k] / (double)mu_cells(f);
    for (uint32_t lag = 0; lag <= period / 2; lag++) {
        double sum = 0;
        for (uint32_t i = 0; i < nx; i++)
            for (uint32_t j = 0; j < ny; j++) {
                const uint32_t a = axis ? i : (i + lag) % nx, b = axis ? (j + lag) % ny : j;
                sum += (f->h[(size_t)i * ny + j] - mean) * (f->h[(size_t)a * ny + b] - mean);
            }
        if (!lag) variance = sum;
        if (!(variance > 0)) break;
        const double now = sum / variance, limit = exp(-1);
        if (now < limit) return lag - 1 + (before - limit) / (before - now);
        before = now;
    }
    return (double)NAN;
}

static void add_slope(mu_gathering *g, size_t unit, const double s[2]) {
    const size_t k = g->slope_cells, more = k * k;
    const double *b = g->slope_bounds;
    const double x = (double)k * (s[0] - b[0]) / (b[1] - b[0]), y = (double)k * (s[1] - b[2]) / (b[3] - b[2]);
    const _Bool inside = x >= 0 && x < (double)k && y >= 0 && y < (double)k;
    mu_ratios_add(&g->slopes, unit, inside ? (size_t)y * k + (size_t)x : more + MU_SLOPE_OUTSIDE, 1);
    mu_ratios_add(&g->slopes, unit, more + MU_SLOPE_X, s[0]);
    mu_ratios_add(&g->slopes, unit, more + MU_SLOPE_Y, s[1]);
    mu_ratios_add(&g->slopes, unit, more + MU_SLOPE_XX, s[0] * s[0]);
    mu_ratios_add(&g->slopes, unit, more + MU_SLOPE_XY, s[0] * s[1]);
    mu_ratios_add(&g->slopes, unit, more + MU_SLOPE_YY, s[1] * s[1]);
}

_Bool mu_gathering_normals(mu_gathering *g, uint32_t file, const mu_heightfield *f, uint32_t *bins,
                           mu_error *error) {
    const double *b = g->slope_bounds;
    if (!file) {
        for (int axis = 0; axis < 2; axis++) g->correlation[axis] = correlation_length(f, axis);
        g->block = fmin(f->nx, f->ny) / 4.0;
        if (!(b[0] < b[1] && b[2] < b[3]) && !choose_bounds(g, f))
            return mu_fail(error, "not enough memory to sort slopes");
    }
    for (int upper = 0; upper < 2; upper++)
        for (uint32_t i = 0; i < f->nx; i++)
            for (uint32_t j = 0; j < f->ny; j++) {
                const size_t unit = mu_gathering_unit(g, file, f, i, j);
                double normal[3], slope[2];
                baked_slope(g, f, i, j, upper, normal, slope);
                const double area =
                    sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]) / normal[2];
                const size_t bin = mu_directions_bin(&g->bins, normal);
                *bins++ = (uint32_t)bin;
                g->macro[unit]++;
                g->total++;
                g->facets[bin]++;
                mu_ratios_add(&g->normals, unit, bin, area);
                add_slope(g, unit, slope);
            }
    return 1;
}
