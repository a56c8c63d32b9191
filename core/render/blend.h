/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * blend.h: numbers that the plugin wants constant, such as gamma, or the alpha of a distribution whose shape it changes, from
 * sources (source.h) all the same: the material is compiled at a few values of each, and in between is what their mixture is,
 * f = (1 - t) f_i + t f_i+1. A mixture of materials is one: it is reciprocal and makes no energy.
 *
 * At a hit one of the two neighbours is taken, with its share as probability, so that a pixel's samples have the mixture as
 * their mean. Which one is a hash of the place: the same for every thread. Over a pixel the number itself is averaged.
 * Two numbers: the compiled values are a grid, and each is drawn by itself.
 */
#ifndef MU_BLEND_H
#define MU_BLEND_H

#include "core/render/material_settings.h"

/* Values of a number: when it is the only one, and when there are two. */
enum { MU_KNOTS = 17, MU_KNOTS_OF_TWO = 9, MU_COMPILED = MU_KNOTS_OF_TWO * MU_KNOTS_OF_TWO };

typedef struct mu_blend_axis {
    mu_source source;
    mu_mipmap mipmap; /* of a picture */
    int count;
    double knot[MU_KNOTS]; /* rising, from the least to the most that the source gives; of a formula on the unit square, and
                            * what lies beyond takes the nearest */
} mu_blend_axis;

typedef struct mu_blend {
    mu_blend_axis axis[MU_BLENDED];
    int axes, count;                        /* of the grid: the product of those of the axes, the first running fastest */
    musurf_material *compiled[MU_COMPILED]; /* NULL: not yet */
} mu_blend;

/* Takes the sources. NULL on failure. */
mu_blend *mu_blend_make(mu_settings *settings, const mu_place *place, mu_error *error);
void mu_blend_free(mu_blend *blend, const musurf_material_type *type);
/* Of one for which nothing is compiled: its sources go back. */
void mu_blend_undo(mu_blend *blend, mu_settings *settings);

/* The value of an axis at grid point `number`. */
double mu_blend_value(const mu_blend *blend, int axis, int number);

/* [any] The material at these texture coordinates and half-axes (varying.h); `attributes`: of the scene's list. */
const musurf_material *mu_blend_at(const mu_blend *blend, const float footprint[6], const float *attributes);

#endif
