/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* blend.c: the values at which a material is compiled, and which of them stands at a hit. */
#include "core/render/blend.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { RASTER = 64 };

static double number_of(const mu_source *source, const float *texel) {
    return source->kind == MU_SOURCE_DIRECTION ? atan2((double)texel[1], (double)texel[0]) : (double)*texel;
}

static _Bool range_of(const mu_source *s, double *least, double *most) {
    const mu_mipmap *p = &s->picture;
    if (s->kind == MU_SOURCE_ATTRIBUTE) {
        *least = s->between[0], *most = s->between[1];
        return 1;
    }
    const int width = p->levels ? p->level[0].width : RASTER,
              height = p->levels ? p->level[0].height : RASTER;
    *least = INFINITY, *most = -INFINITY;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const double value =
                p->levels
                    ? number_of(s, p->texels + ((size_t)y * (size_t)width + (size_t)x) * (size_t)p->channels)
                    : mu_expression_at(s->formula, x / (RASTER - 1.0), y / (RASTER - 1.0)).value;
            *least = fmin(*least, value), *most = fmax(*most, value);
            if (!isfinite(value)) return 0;
        }
    return 1;
}

/* Rising by equal factors where that serves, else by equal steps; one is enough of what is constant. */
static void place_knots(mu_blend_axis *axis, int count, double least, double most) {
    const _Bool factors = least > 0 && most > 2 * least;
    axis->count = most > least ? count : 1;
    for (int i = 0; i < axis->count; i++) {
        const double t = i / (count - 1.0);
        axis->knot[i] = factors ? least * pow(most / least, t) : least + t * (most - least);
    }
    if (axis->count > 1) axis->knot[axis->count - 1] = most;
}

static _Bool fill_levels(mu_blend_axis *axis) {
    const mu_mipmap *p = &axis->source.picture;
    if (!mu_mipmap_make(&axis->mipmap, p->level[0].width, p->level[0].height, 1, axis->source.placement.wrap)) return 0;
    for (size_t i = 0; i < (size_t)p->level[0].width * (size_t)p->level[0].height; i++)
        axis->mipmap.texels[i] = (float)number_of(&axis->source, p->texels + i * (size_t)p->channels);
    mu_mipmap_build(&axis->mipmap);
    return 1;
}

static _Bool make_axis(mu_blend_axis *axis, int knots, const mu_place *place, mu_error *error) {
    const mu_source *source = &axis->source;
    double least = 0, most = 0;
    if (source->kind == MU_SOURCE_ATTRIBUTE && source->between[1] == DBL_MAX)
        return mu_settings_fail(place, source->param->name, error,
                                "comes from vertices, but is compiled: say its range, \"between\": [least, most]");
    if (!range_of(source, &least, &most))
        return mu_settings_fail(place, source->param->name, error, "is not finite all over the unit square");
    if (mu_source_is_picture(source) && !fill_levels(axis))
        return mu_settings_fail(place, source->param->name, error, "not enough memory");
    place_knots(axis, knots, least, most);
    return 1;
}

mu_blend *mu_blend_make(mu_settings *settings, const mu_place *place, mu_error *error) {
    mu_blend *blend = calloc(1, sizeof *blend);
    if (!blend) {
        mu_place_fail(place, error, "not enough memory");
        return NULL;
    }
    blend->axes = settings->blended_count, blend->count = 1;
    settings->blended_count = 0;
    for (int i = 0; i < blend->axes; i++) blend->axis[i].source = settings->blended[i];
    for (int i = 0; i < blend->axes; i++) {
        if (!make_axis(&blend->axis[i], blend->axes > 1 ? MU_KNOTS_OF_TWO : MU_KNOTS, place, error)) {
            mu_blend_free(blend, NULL);
            return NULL;
        }
        blend->count *= blend->axis[i].count;
    }
    return blend;
}

void mu_blend_free(mu_blend *blend, const musurf_material_type *type) {
    if (!blend) return;
    for (int i = 0; i < blend->count; i++)
        if (blend->compiled[i]) type->release(blend->compiled[i]);
    for (int i = 0; i < blend->axes; i++) {
        mu_source_free(&blend->axis[i].source);
        mu_mipmap_free(&blend->axis[i].mipmap);
    }
    free(blend);
}

void mu_blend_undo(mu_blend *blend, mu_settings *settings) {
    settings->blended_count = blend->axes;
    for (int i = 0; i < blend->axes; i++) {
        settings->blended[i] = blend->axis[i].source;
        blend->axis[i].source = (mu_source){0};
    }
    mu_blend_free(blend, NULL);
}

double mu_blend_value(const mu_blend *blend, int axis, int number) {
    for (int i = 0; i < axis; i++) number /= blend->axis[i].count;
    return blend->axis[axis].knot[number % blend->axis[axis].count];
}

static double value_at(const mu_blend_axis *axis, const float footprint[6], const float *attributes) {
    const mu_placement *p = &axis->source.placement;
    double uv[2], axes[4], value;
    if (axis->source.kind == MU_SOURCE_ATTRIBUTE) return mu_source_of_vertices(&axis->source, 0, attributes);
    if (axis->source.kind == MU_SOURCE_EXPRESSION)
        return mu_expression_at(axis->source.formula, (double)footprint[0], (double)footprint[1]).value;
    for (int i = 0; i < 2; i++) uv[i] = (double)footprint[i] * p->scale[i] + p->offset[i];
    for (int i = 0; i < 4; i++) axes[i] = (double)footprint[2 + i] * p->scale[i % 2];
    mu_mipmap_at(&axis->mipmap, uv, p->filtered ? axes : NULL, NULL, &value);
    return value;
}

/* Two numbers in [0, 1) from two floats, mixed as MurmurHash3 ends. */
static void chances_of(const float uv[2], double chance[MU_BLENDED]) {
    uint32_t bits[2];
    memcpy(bits, uv, sizeof bits);
    uint64_t x = (uint64_t)bits[0] << 32 | bits[1];
    x = (x ^ x >> 33) * 0xff51afd7ed558ccdu;
    x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53u;
    x ^= x >> 33;
    chance[0] = (double)(x >> 32) * 0x1p-32, chance[1] = (double)(x & 0xffffffffu) * 0x1p-32;
}

static int draw(const mu_blend_axis *axis, double value, double chance) {
    int i = 0;
    if (!(value > axis->knot[0]) || axis->count == 1) return 0;
    while (i < axis->count - 2 && value >= axis->knot[i + 1]) i++;
    return i + (chance < (value - axis->knot[i]) / (axis->knot[i + 1] - axis->knot[i]));
}

const musurf_material *mu_blend_at(const mu_blend *blend, const float footprint[6], const float *attributes) {
    double chance[MU_BLENDED];
    int number = 0;
    chances_of(footprint, chance);
    for (int i = blend->axes; i-- > 0;)
        number = number * blend->axis[i].count +
                 draw(&blend->axis[i], value_at(&blend->axis[i], footprint, attributes), chance[i]);
    return blend->compiled[number];
}
