/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * sphere_table.h: directions drawn in proportion to a raster over the sphere.
 *
 * The raster is latitude-longitude: v = theta / pi from the +z pole down, and u = 1/2 - phi / (2 pi), so that
 * its middle column looks along +x and, seen from inside, turning right (clockwise from above) moves right in
 * the image. Within a cell the density per steradian is constant: rows are split evenly in cos theta, not in
 * theta, which keeps the poles exact and needs no division by sin theta.
 *
 * Drawing inverts the cumulative distributions of row and column. Unlike an alias table this is monotone in
 * each uniform number, so that the stratification of the sampler survives.
 */
#ifndef MU_SPHERE_TABLE_H
#define MU_SPHERE_TABLE_H

#include <stdint.h>

#include "core/render/error.h"
#include "core/render/vector.h"

typedef struct mu_sphere_row {
    float from_pole;    /* 1 - |cos theta| where the row is nearest to its pole ... */
    float span;         /* ... and how much is added to it across the row */
    float inverse_cell; /* 1 / solid angle of one of its cells, 1/sr */
} mu_sphere_row;

/* A cumulative distribution over cells: count + 1 rising bounds from 0 to 1, and where searches begin:
 * guide[k] is the last cell that starts at or below k / buckets. Most searches end where they begin, or next
 * to it. */
typedef struct mu_distribution {
    float *bounds;
    uint32_t *guide; /* buckets + 1 */
    uint32_t count, buckets;
} mu_distribution;

typedef struct mu_sphere_table {
    uint32_t width, height;  /* 0: nothing to draw */
    mu_distribution down;    /* over rows */
    mu_distribution *across; /* over the columns of each row */
    mu_sphere_row *rows;
} mu_sphere_table;

typedef struct mu_sphere_point {
    float u, v;
    mu_vec3 direction;
    float pdf; /* 1/sr */
} mu_sphere_point;

/* `radiance` holds the mean over each cell, row by row from the top, finite and >= 0. Every cell above 0 gets
 * a density above 0. If all are 0 the table is empty and its pdf is 0. */
_Bool mu_sphere_table_make(mu_sphere_table *table, uint32_t width, uint32_t height, const float *radiance,
                           mu_error *error);
void mu_sphere_table_free(mu_sphere_table *table);

/* [any] */
void mu_sphere_table_sample(const mu_sphere_table *table, const float u[2], mu_sphere_point *out);
/* [any] The density of the cell at (u, v), each in [0, 1]. */
float mu_sphere_table_pdf(const mu_sphere_table *table, float u, float v);
/* [any] (u, v) in [0, 1] of a unit direction. */
void mu_sphere_table_locate(mu_vec3 direction, float *u, float *v);

/* The cell that holds u in [0, 1), given rising bounds from 0 to 1, between the cells `first` and `last`;
 * *within gets the place in it, in [0, 1). The cell found is never empty, for bounds[cell] <= u < bounds[cell
 * + 1]. */
static inline uint32_t mu_cdf_find(const float *bounds, uint32_t first, uint32_t last, float u,
                                   float *within) {
    while (first < last) {
        const uint32_t middle = last - (last - first) / 2;
        if (bounds[middle] <= u)
            first = middle;
        else
            last = middle - 1;
    }
    const float place = (u - bounds[first]) / (bounds[first + 1] - bounds[first]);
    *within = place < 0x1.fffffep-1f ? place : 0x1.fffffep-1f;
    return first;
}

#endif
