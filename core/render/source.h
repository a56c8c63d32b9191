/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * source.h: where a parameter of a material takes its values from, if not from the scene file: an object in place of a
 * number, a color, a vector or a matrix.
 *
 *     {"texture": "m.exr"}            a picture over the texture square; with "channels": which of its;
 *                                     "colour_space": "raw" (as stored) or "srgb" (decoded); "range": what 0 and 1 of the
 *                                     picture mean; and its placement
 *     {"direction_map": "d.exr"}      of an angle: pictures of vectors, whose direction it is; "range" of a whole-number
 *                                     file would be [-1, 1]; (0, 0) is no direction and gives 0
 *     {"attribute": "age"}            numbers of the mesh's vertices; of a matrix ["m00", "m01", "m10", "m11"]; with
 *                                     "between": [least, most], what lies beyond takes the nearer of these
 *     {"expression": "0.1 + 0.2*u"}   formulas of (u, v) (expression.h), one for each number
 *
 * Placement: a picture lies at (u, v) * "scale" + "offset" of its own square, beyond which "wrap" (repeat, clamp, mirror)
 * goes on; "filter" says what is averaged over a pixel: "covariance" (varying.h) or "none".
 */
#ifndef MU_SOURCE_H
#define MU_SOURCE_H

#include "core/render/document.h"
#include "core/render/expression.h"
#include "core/render/mipmap.h"
#include "plugin/musurf_plugin.h"

enum { MU_SOURCE_NUMBERS = 4, MU_ATTRIBUTE_NAME = 64, MU_BLENDED = 2 };

typedef struct mu_placement {
    mu_wrap wrap;
    double scale[2], offset[2];
    _Bool filtered;
} mu_placement;

typedef struct mu_source {
    enum { MU_SOURCE_TEXTURE, MU_SOURCE_DIRECTION, MU_SOURCE_ATTRIBUTE, MU_SOURCE_EXPRESSION } kind;
    const musurf_param *param;
    uint32_t slot; /* of its first float, and how many there are */
    int count;
    mu_mipmap picture; /* MU_SOURCE_TEXTURE, _DIRECTION: its finest level alone */
    mu_placement placement;
    char name[MU_SOURCE_NUMBERS][MU_ATTRIBUTE_NAME]; /* MU_SOURCE_ATTRIBUTE */
    uint32_t attribute[MU_SOURCE_NUMBERS];           /* of the scene's list */
    double between[2];                               /* MU_SOURCE_ATTRIBUTE; without: all that is finite */
    mu_expression *formula;                          /* MU_SOURCE_EXPRESSION: `count` */
} mu_source;

/* Can the parameter have a source: does the plugin take it at each hit, or may it be blended (blend.h)? */
_Bool mu_source_serves(const musurf_param *param);
_Bool mu_source_blends(const musurf_param *param);
/* Is this an object that names a source? */
_Bool mu_source_is(const json_t *value);
_Bool mu_source_read(mu_source *source, const musurf_param *param, const mu_place *place, mu_error *error);
/* Of the object at `place`: wrap, filter, scale and offset, where they are not what they are by default. */
_Bool mu_source_placement(mu_placement *out, const mu_place *place, mu_error *error);
void mu_source_free(mu_source *source);
/* Is it a picture of equal texels? Then it is a constant. */
_Bool mu_source_is_constant(const mu_source *source, double *values);
/* What else may stand for the parameter's value; takes `number`, the schema of one number of it. */
json_t *mu_source_schema(const musurf_param *param, json_t *number);

/* [any] Number k from the scene's list of attributes at a hit; NULL: all of them 0. */
static inline double mu_source_of_vertices(const mu_source *source, int k, const float *attributes) {
    const double value = attributes ? (double)attributes[source->attribute[k]] : 0;
    return value < source->between[0] ? source->between[0] : value > source->between[1] ? source->between[1] : value;
}

static inline _Bool mu_source_is_picture(const mu_source *source) {
    return source->kind == MU_SOURCE_TEXTURE || source->kind == MU_SOURCE_DIRECTION;
}

#endif
