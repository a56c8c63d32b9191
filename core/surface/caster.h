/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * caster.h: which points of a periodic surface a direction sees, exactly, in double precision, on baked vertices.
 *
 * Rays from the like points of all cells cross like edges (walk.h), so sixteen cells of a row, lanes, follow one walk
 * together. Stretches of the walk over which the surface stays below all lanes are left out: a pyramid of the highest
 * height in squares of 1, 2, 4, ... vertices tells which.
 */
#ifndef MU_CASTER_H
#define MU_CASTER_H

#include "core/surface/heightfield.h"
#include "core/surface/pyramid.h"
#include "core/surface/walk.h"

typedef struct mu_caster mu_caster;

/* Copies the heights (nx, ny >= 2), which must be finite. NULL: out of memory. Read only afterwards, so that threads may share it. */
mu_caster *mu_caster_make(const mu_heightfield *f);
void mu_caster_free(mu_caster *caster);
/* Highest less lowest height. */
double mu_caster_range(const mu_caster *caster);

/* Where the points are and whence they are looked at: (i + u, j + v) of one triangle of every cell, under M, along w. */
typedef struct mu_sight {
    double m[4], w[3]; /* w[2] > 0, of any length */
    double u, v;       /* inside the triangle */
    int upper;
} mu_sight;

typedef struct mu_cast mu_cast;

/* What all rows of a sight share. */
mu_walk_result mu_cast_make(mu_cast **cast, const mu_caster *caster, const mu_sight *sight);
void mu_cast_free(mu_cast *cast);
/* visible[j] of row i: 1 where the triangle faces w and nothing stands between its point and the sky. */
void mu_cast_row(const mu_cast *cast, uint32_t i, uint8_t *visible);

/* One ray from the point (i + u, j + v) of a triangle along a direction of its own. The triangle must face w. */
_Bool mu_caster_sees(const mu_caster *caster, const mu_sight *sight, uint32_t i, uint32_t j);

#endif
