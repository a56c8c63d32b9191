/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* blend.c: the values at which a material is compiled, and which of them stands at a hit. */
#include "core/render/blend.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/material_settings.h"

enum { RASTER = 64 };

static double number_of(const mu_source *source, const float *texel) {
    return source->kind == MU_SOURCE_DIRECTION ? atan2((double)texel[1], (double)texel[0]) : (double)*texel;
}

static _Bool range_of(const mu_source *s, double *least, double *most) {
    const mu_mipmap *p = &s->picture;
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
static void place_knots(mu_blend *blend, double least, double most) {
    const _Bool factors = least > 0 && most > 2 * least;
    blend->count = most > least ? MU_KNOTS : 1;
    for (int i = 0; i < blend->count; i++) {
        const double t = i / (MU_KNOTS - 1.0);
        blend->knot[i] = factors ? least * pow(most / least, t) : least + t * (most - least);
    }
    if (blend->count > 1) blend->knot[blend->count - 1] = most;
}

static _Bool fill_levels(mu_blend *blend) {
    const mu_mipmap *p = &blend->source.picture;
    if (!mu_mipmap_make(&blend->mipmap, p->level[0].width, p->level[0].height, 1,
                        blend->source.placement.wrap))
        return 0;
    for (size_t i = 0; i < (size_t)p->level[0].width * (size_t)p->level[0].height; i++)
        blend->mipmap.texels[i] = (float)number_of(&blend->source, p->texels + i * (size_t)p->channels);
    mu_mipmap_build(&blend->mipmap);
    return 1;
}

mu_blend *mu_blend_make(mu_source *source, const mu_place *place, mu_error *error) {
    double least = 0, most = 0;
    const char *const name = source->param->name;
    mu_blend *blend = calloc(1, sizeof *blend);
    if (!blend) {
        mu_place_fail(place, error, "not enough memory");
        return NULL;
    }
    blend->source = *source;
    memset(source, 0, sizeof *source);
    _Bool good = 1;
    if (blend->source.kind == MU_SOURCE_ATTRIBUTE)
        good = mu_settings_fail(
            place, name, error,
            "comes from vertices, but is compiled: a picture or a formula tells its range beforehand");
    else if (!range_of(&blend->source, &least, &most))
        good = mu_settings_fail(place, name, error, "is not finite all over the unit square");
    else if (mu_source_is_picture(&blend->source) && !fill_levels(blend))
        good = mu_settings_fail(place, name, error, "not enough memory");
    if (good) {
        place_knots(blend, least, most);
        return blend;
    }
    mu_blend_free(blend, NULL);
    return NULL;
}

void mu_blend_free(mu_blend *blend, const musurf_material_type *type) {
    if (!blend) return;
    for (int i = 0; i < blend->count; i++)
        if (blend->compiled[i]) type->release(blend->compiled[i]);
    mu_source_free(&blend->source);
    mu_mipmap_free(&blend->mipmap);
    free(blend);
}

static double value_at(const mu_blend *blend, const float footprint[6]) {
    const mu_placement *p = &blend->source.placement;
    double uv[2], axes[4], value;
    if (blend->source.kind == MU_SOURCE_EXPRESSION)
        return mu_expression_at(blend->source.formula, (double)footprint[0], (double)footprint[1]).value;
    for (int i = 0; i < 2; i++) uv[i] = (double)footprint[i] * p->scale[i] + p->offset[i];
    for (int i = 0; i < 4; i++) axes[i] = (double)footprint[2 + i] * p->scale[i % 2];
    mu_mipmap_at(&blend->mipmap, uv, p->filtered ? axes : NULL, NULL, &value);
    return value;
}

/* In [0, 1): two floats, mixed as MurmurHash3 ends. */
static double chance_of(const float uv[2]) {
    uint32_t bits[2];
    memcpy(bits, uv, sizeof bits);
    uint64_t x = (uint64_t)bits[0] << 32 | bits[1];
    x = (x ^ x >> 33) * 0xff51afd7ed558ccdu;
    x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53u;
    return (double)((x ^ x >> 33) >> 11) * 0x1p-53;
}

const musurf_material *mu_blend_at(const mu_blend *blend, const float footprint[6]) {
    const double value = value_at(blend, footprint);
    int i = 0;
    if (!(value > blend->knot[0]) || blend->count == 1) return blend->compiled[0];
    while (i < blend->count - 2 && value >= blend->knot[i + 1]) i++;
    const double share = (value - blend->knot[i]) / (blend->knot[i + 1] - blend->knot[i]);
    return blend->compiled[i + (chance_of(footprint) < share)];
}
