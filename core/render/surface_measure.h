/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * surface_measure.h: what is seen of a baked surface: facets that face a view, points that it sees, G1, and G2 of pairs.
 *
 * Counts use one point per triangle, (i + 1/4, j + 1/2) in L and (i + 3/4, j + 1/2) in U. Shares use side^2 points
 * spread evenly over each triangle: those of the points ((k + 1/2)/(2 side), (l + 1/2)/side) of a cell that lie in it.
 * A standard error is that of a ratio of sums over 16 blocks of cells, 4 by 4, which is right if blocks are wide against
 * the correlation length; it says how far another surface of the same kind would lie, the surface itself being exact.
 */
#ifndef MU_SURFACE_MEASURE_H
#define MU_SURFACE_MEASURE_H

#include "core/render/surface_source.h"
#include "core/render/surface_tracer.h"

enum { MU_BLOCKS = 16, MU_MOST_VIEWS = MU_PLAN_VIEWS, MU_MOST_BINS = 256 };

typedef struct mu_estimate {
    double value, error; /* NaN where there is nothing to measure */
} mu_estimate;

/* Slopes along the view, dh/ds where s runs toward the viewer in the plane (toward +x from straight above). */
typedef struct mu_slope_bin {
    double from, to;
    uint64_t facets, visible; /* that face the view; of them, whose one point is seen */
    mu_estimate g1;           /* over the points of the facets, each facet by its macro area */
} mu_slope_bin;

typedef struct mu_view {
    double w[3];      /* as given but for a power of two, so that exact ties stay exact */
    mu_window window; /* the cells that count */
    uint64_t front_facing, visible;
    mu_estimate facet_mean, projected;
    mu_slope_bin *bins;
    uint8_t *seen[2];   /* per triangle of a family: its one point is */
    uint16_t *count[2]; /* how many of the side^2 points are */
} mu_view;

typedef struct mu_pair {
    uint32_t a, b;
    uint64_t facing_both, both_visible;
    mu_estimate g2; /* both_visible over facing_both */
} mu_pair;

typedef struct mu_measuring {
    mu_heightfield f;
    _Bool
        open; /* rays may not leave (surface_source.h); cells whose rays do are no part of the window, and not seen */
    double m[4];
    const mu_tracer *tracer;
    uint32_t side, threads, view_count;
    uint32_t bin_count;           /* 0: no bins */
    const double *edges;          /* bin_count + 1; NULL: as many facets in each */
    mu_view views[MU_MOST_VIEWS]; /* w given; the rest is filled */
    char version[128];            /* filled: what stands behind a foreign tracer; else empty */
    void (*progress)(void *context, uint32_t done, uint32_t all);
    void *context;
} mu_measuring;

/* Fills the views; frees nothing it was given. */
_Bool mu_measure(mu_measuring *measuring, mu_error *error);
void mu_measure_free(mu_measuring *measuring);
/* Needs the views. */
void mu_measure_pair(const mu_measuring *measuring, mu_pair *pair);

/* Sums per block of a window, and what becomes of two of them. */
typedef struct mu_blocks {
    double top[MU_BLOCKS], bottom[MU_BLOCKS];
} mu_blocks;
static inline uint32_t mu_block(const mu_window *w, uint32_t i, uint32_t j) {
    return (uint32_t)((uint64_t)(i - w->i0) * 4 / (w->i1 - w->i0) * 4 +
                      (uint64_t)(j - w->j0) * 4 / (w->j1 - w->j0));
}
mu_estimate mu_blocks_ratio(const mu_blocks *blocks);

/* The bins of a view whose counts are there. False: out of memory. */
_Bool mu_measure_bins(const mu_measuring *measuring, mu_view *view);

#endif
