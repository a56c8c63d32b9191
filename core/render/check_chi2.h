/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_chi2.h: Pearson's chi^2 of sampled micronormals against a density, over cells of about equal
 * probability.
 *
 * The cells are adapted to the density: rows of equal turn in the region's own coordinates (check_plane.h),
 * each cut at its quantiles; what a cell should hold is integrated adaptively, not taken from the quantiles.
 * Cells that expect fewer than 5 samples are pooled, with all that falls outside of the region. What integration leaves in
 * doubt is taken off the statistic.
 */
#ifndef MU_CHECK_CHI2_H
#define MU_CHECK_CHI2_H

#include <stddef.h>

#include "core/render/check_plane.h"

/* Probability per area of slopes at micronormal m. */
typedef double (*mu_slope_density)(void *context, const double m[3]);

typedef struct mu_cells mu_cells;

/* About `wanted` cells. Each is integrated from `pieces` by `pieces` panels on: more than 1 for a density with edges, lest
 * one that cuts a corner off a cell pass between the nodes. 0: the density jumps
 * (check_jumps.h). NULL without memory, or if the density vanishes or is not finite. */
mu_cells *mu_cells_make(const mu_region *region, mu_slope_density density, void *context, size_t wanted,
                        size_t pieces);
void mu_cells_free(mu_cells *cells);

/* Largest estimated error of a cell's probability, relative to the mean cell; of a density that jumps, the root mean square of
 * all errors, relative to each cell: what counts against the statistic, and no more than the largest. */
double mu_cells_error(const mu_cells *cells);

void mu_cells_add(mu_cells *cells, const double m[3]);
/* p-value of all samples added. */
double mu_cells_p(const mu_cells *cells);

#endif
