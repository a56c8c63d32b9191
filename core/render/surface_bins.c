/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_bins.c: G1 by the slope of facets along the view, the one number on which masking of a facet depends most. */
#include <math.h>
#include <stdlib.h>

#include "core/render/surface_measure.h"
#include "core/surface/rank.h"

/* Slope of the baked facet along the view: -N.s/N.z, s the unit vector toward the viewer in the plane. */
static double slope_along(const mu_measuring *s, const mu_view *view, uint32_t i, uint32_t j, int upper) {
    const double length = hypot(view->w[0], view->w[1]);
    const double x = length > 0 ? view->w[0] / length : 1, y = length > 0 ? view->w[1] / length : 0;
    double slope[2], normal[3];
    mu_facet_slope(&s->f, i, j, upper, slope);
    mu_facet_normal(s->m, slope, normal);
    return -(normal[0] * x + normal[1] * y) / normal[2];
}

static _Bool faces(const mu_measuring *s, const mu_view *view, uint32_t i, uint32_t j, int upper) {
    double slope[2];
    mu_facet_slope(&s->f, i, j, upper, slope);
    return mu_facet_facing(s->m, slope, view->w) > 0;
}

/* Edges between which as many front-facing facets lie. */
static _Bool equal_edges(const mu_measuring *s, const mu_view *view, double *edges) {
    const mu_window c = view->window;
    double top = -INFINITY, bottom = INFINITY;
    for (uint32_t i = c.i0; i < c.i1; i++)
        for (uint32_t j = c.j0; j < c.j1; j++)
            for (int upper = 0; upper < 2; upper++)
                if (faces(s, view, i, j, upper)) {
                    const double slope = slope_along(s, view, i, j, upper);
                    top = fmax(top, slope), bottom = fmin(bottom, slope);
                }
    mu_ranked *ranked = malloc((view->front_facing + 1) * sizeof *ranked);
    mu_ranked *spare = malloc((view->front_facing + 1) * sizeof *spare);
    size_t count = 0;
    for (uint32_t i = c.i0; ranked && spare && i < c.i1; i++)
        for (uint32_t j = c.j0; j < c.j1; j++)
            for (int upper = 0; upper < 2; upper++)
                if (faces(s, view, i, j, upper))
                    ranked[count++].key = (float)(slope_along(s, view, i, j, upper) - bottom);
    if (count) {
        mu_rank_sort(ranked, spare, count);
        for (uint32_t k = 1; k < s->bin_count; k++)
            edges[k] = bottom + (double)ranked[count * k / s->bin_count].key;
    }
    edges[0] = bottom;
    edges[s->bin_count] = nextafter(top, INFINITY); /* bins take their lower edge and not their upper one */
    const _Bool good = ranked && spare;
    free(ranked);
    free(spare);
    return good;
}

static uint32_t find(const double *edges, uint32_t bins, double slope) {
    uint32_t low = 0, high = bins;
    if (!(slope >= edges[0] && slope < edges[bins])) return bins;
    while (high - low > 1) {
        const uint32_t middle = (low + high) / 2;
        if (slope >= edges[middle])
            low = middle;
        else
            high = middle;
    }
    return low;
}

_Bool mu_measure_bins(const mu_measuring *s, mu_view *view) {
    const mu_window c = view->window;
    const uint32_t ny = s->f.ny;
    const double points = (double)s->side * s->side;
    double edges[MU_MOST_BINS + 1] = {0};
    mu_blocks *blocks = calloc(s->bin_count, sizeof *blocks);
    view->bins = calloc(s->bin_count, sizeof *view->bins);
    _Bool good = blocks && view->bins;
    if (good && s->edges)
        for (uint32_t k = 0; k <= s->bin_count; k++) edges[k] = s->edges[k];
    else if (good && view->front_facing)
        good = equal_edges(s, view, edges);
    for (uint32_t i = c.i0; good && i < c.i1; i++)
        for (uint32_t j = c.j0; j < c.j1; j++)
            for (int upper = 0; upper < 2; upper++) {
                if (!faces(s, view, i, j, upper)) continue;
                const uint32_t bin = find(edges, s->bin_count, slope_along(s, view, i, j, upper));
                if (bin == s->bin_count) continue;
                const size_t at = (size_t)i * ny + j;
                blocks[bin].bottom[mu_block(&c, i, j)]++;
                blocks[bin].top[mu_block(&c, i, j)] += view->count[upper][at] / points;
                view->bins[bin].facets++;
                view->bins[bin].visible += view->seen[upper][at];
            }
    for (uint32_t k = 0; good && k < s->bin_count; k++) {
        view->bins[k].from = edges[k];
        view->bins[k].to = edges[k + 1];
        view->bins[k].g1 = mu_blocks_ratio(&blocks[k]);
    }
    free(blocks);
    return good;
}
