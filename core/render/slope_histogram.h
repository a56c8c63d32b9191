/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* slope_histogram.h: how often each slope is met on a heightfield. */
#ifndef MU_SLOPE_HISTOGRAM_H
#define MU_SLOPE_HISTOGRAM_H

#include <stddef.h>

/* Heights of a periodic heightfield of nx x ny cells of size 1: heights[i ny + j] over (i, j). Each cell is two triangles, split
 * along (i+1, j)-(i, j+1). */

/* The bounds (x_min, x_max, y_min, y_max) of all slopes, a millionth of their extent wider. */
void mu_slope_bounds(const float *heights, size_t nx, size_t ny, double bounds[4]);
/* Counts the slopes of both triangles of each cell into bins x bins weights, row by row from y_min on. Returns how many lie
 * outside the bounds; those are not counted. */
size_t mu_slope_histogram(const float *heights, size_t nx, size_t ny, const double bounds[4], size_t bins,
                          double *weights);

#endif
