/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * cloud.h: all facet slopes of a heightfield, in one pass, as a few thousand weighted points.
 *
 * A pilot ellipse, centre and shape of a Student-t cloud of two degrees of freedom (which is GGX), fitted to a sample
 * of the facets by iterated weights, turns slopes s into v = A^-1 (s - centre) of order 1. Rings of asinh(10 |v|) times
 * sectors of the azimuth hold the facets; each bin keeps their number, mean and covariance, and stands in sums over
 * facets for four points of that mean and covariance: such sums are off by the fourth order of the bins' size only.
 * Measured, bins a third as wide move fitted alphas and gammas by 1e-5 of themselves.
 * Facets beyond the ellipse |v| = edge, which holds the share `keep` of them, are only counted: what a maker of
 * surfaces or an instrument did to the tail then matters no further than how many facets are in it.
 *
 * The heightfield is divided into 24 x 24 patches, whose counts per bin are kept: facets near each other are alike, and
 * only whole patches of many correlation lengths may be taken for independent. Two folds, the fields of a 6 x 6
 * chessboard, are the halves for fits and for what judges them.
 */
#ifndef MU_CLOUD_H
#define MU_CLOUD_H

#include "core/surface/heightfield.h"

enum { MU_PATCHES = 24, MU_RINGS = 64, MU_SECTORS = 32, MU_FOLDS = 2 };
enum { MU_BINS = MU_RINGS * MU_SECTORS, MU_TAIL = MU_BINS }; /* the tail is the bin after the last */

/* The slopes of a heightfield under M: M^-T times the differences of heights. */
typedef struct mu_slopes {
    mu_heightfield f;
    double cotransform[4]; /* M^-T, row by row */
    _Bool open;            /* the surface does not repeat: facets over its last row and column do not exist */
} mu_slopes;

typedef struct mu_bin_moments {
    double count, mean[2], square[3]; /* sums: of v, and of its products xx, xy, yy */
} mu_bin_moments;

typedef struct mu_point {
    double v[2], weight;
    uint32_t bin;
} mu_point;

/* Facets of a fold, or of all. */
typedef struct mu_point_set {
    mu_point *points;
    size_t count;
    double facets, tail;
} mu_point_set;

typedef struct mu_cloud {
    double centre[2], shape[4];      /* s = centre + shape v; shape symmetric */
    double edge;                     /* of |v| */
    double correlation;              /* of how steep facets are, to 1/e, in cells */
    mu_bin_moments *moments;         /* [fold, or all][bin and tail] */
    uint32_t *counts;                /* [patch][bin and tail] */
    mu_point_set sets[MU_FOLDS + 1]; /* the folds, then all */
} mu_cloud;

/* Cells a side whose facets exist. */
static inline uint32_t mu_slopes_side(const mu_slopes *s) {
    const uint32_t least =
        s->f.nx < s->f.ny ? s->f.nx : s->f.ny; /* a square of cells; of a longer side its first part */
    return s->open ? least - 1 : least;
}

static inline void mu_slope_at(const mu_slopes *s, uint32_t i, uint32_t j, int upper, double out[2]) {
    double d[2];
    mu_facet_slope(&s->f, i, j, upper, d);
    out[0] = s->cotransform[0] * d[0] + s->cotransform[1] * d[1];
    out[1] = s->cotransform[2] * d[0] + s->cotransform[3] * d[1];
}

static inline uint32_t mu_patch_row(const mu_slopes *s, uint32_t i) {
    return (uint32_t)((uint64_t)i * MU_PATCHES / mu_slopes_side(s));
}

/* 0 or 1 of patch (row, column). */
static inline int mu_fold_of(uint32_t row, uint32_t column) {
    return (int)((row / 4 + column / 4) & 1);
}

/* At most MU_SAMPLE slopes (x, y) of facets spread evenly over the surface; how many. */
enum { MU_SAMPLE = 65536 };
uint32_t mu_cloud_sample(const mu_slopes *s, double *sample);
/* The pilot: false if the cloud of slopes has no extent in some direction (shape is singular then). */
_Bool mu_cloud_pilot(mu_cloud *cloud, const mu_slopes *s, double keep, const double *sample, uint32_t count);
/* The pass over the facets. False if memory is short. */
_Bool mu_cloud_fill(mu_cloud *cloud, const mu_slopes *s);
void mu_cloud_free(mu_cloud *cloud);

#endif
