/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * blend.h: a number that the plugin wants constant, such as gamma, or the alpha of a distribution whose shape it changes,
 * from a source (source.h) all the same: the material is compiled at a few values of it, and in between is what their
 * mixture is, f = (1 - t) f_i + t f_i+1. A mixture of materials is one: it is reciprocal and makes no energy.
 *
 * At a hit one of the two neighbours is taken, with its share as probability, so that a pixel's samples have the mixture as
 * their mean. Which one is a hash of the place: the same for every thread. Over a pixel the number itself is averaged.
 */
#ifndef MU_BLEND_H
#define MU_BLEND_H

#include "core/render/source.h"

enum { MU_KNOTS = 17 };

typedef struct mu_blend {
    mu_source source;
    mu_mipmap mipmap; /* of a picture */
    int count;
    double knot
        [MU_KNOTS]; /* rising, from the least to the most that the source gives; of a formula on the unit square, and
                            * what lies beyond takes the nearest */
    musurf_material *compiled[MU_KNOTS];
} mu_blend;

/* Takes the source. NULL on failure. */
mu_blend *mu_blend_make(mu_source *source, const mu_place *place, mu_error *error);
void mu_blend_free(mu_blend *blend, const musurf_material_type *type);

/* [any] The material at these texture coordinates and half-axes (varying.h). */
const musurf_material *mu_blend_at(const mu_blend *blend, const float footprint[6]);

#endif
