/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* varying_make.c: sources of one material, checked against one another, and its pictures composed into one mipmap. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/covariance.h"
#include "core/render/formula_check.h"
#include "core/render/varying.h"

static _Bool same_placement(const mu_placement *a, const mu_placement *b) {
    return a->wrap == b->wrap && a->filtered == b->filtered && a->scale[0] == b->scale[0] &&
           a->scale[1] == b->scale[1] && a->offset[0] == b->offset[0] && a->offset[1] == b->offset[1];
}

static _Bool is_transform(const mu_source *source) {
    return !strcmp(source->param->name, "transform");
}

static _Bool check(mu_varying *v, const mu_place *place, mu_error *error) {
    const mu_source *first = NULL;
    for (size_t i = 0; i < v->count; i++) {
        const mu_source *s = v->sources + i;
        if (!mu_source_is_picture(s)) {
            const mu_place member = mu_place_member(place, s->param->name);
            v->pointwise = 1;
            if (s->kind == MU_SOURCE_EXPRESSION && !mu_formula_check(s, &member, error)) return 0;
            continue;
        }
        v->pictured = 1;
        if (first && !same_placement(&first->placement, &s->placement)) {
            const mu_place member = mu_place_member(place, s->param->name);
            return mu_place_fail(
                &member, error,
                "lies otherwise than the picture of %s: wrap, scale, offset and filter of a material's "
                "pictures have to be the same, for what is averaged is what they amount to together",
                first->param->name);
        }
        if (!first) first = s, v->placement = s->placement;
    }
    for (size_t i = 0; i < v->count && v->map && v->pictured; i++) {
        const mu_source *s = v->sources + i;
        if (mu_source_is_picture(s) || is_transform(s)) continue;
        const mu_place member = mu_place_member(place, s->param->name);
        return mu_place_fail(
            &member, error,
            "comes from vertices or a formula, and %s from a picture: beside a picture only transform may",
            first->param->name);
    }
    return 1;
}

/* The values of picture `s` at texel (x, y) of a grid of width x height: its own, or between them. */
static void values_at(const mu_source *s, int x, int y, int width, int height, float *out) {
    const mu_mipmap *p = &s->picture;
    double found[MU_MIPMAP_CHANNELS];
    if (p->level[0].width == width && p->level[0].height == height) {
        const float *at = p->texels + ((size_t)y * (size_t)width + (size_t)x) * (size_t)p->channels;
        for (int c = 0; c < p->channels; c++) found[c] = (double)at[c];
    } else {
        mu_mipmap_at(p, (const double[2]){(x + 0.5) / width, 1 - (y + 0.5) / height}, NULL, NULL, found);
    }
    if (s->kind == MU_SOURCE_DIRECTION) found[0] = atan2(found[1], found[0]);
    for (int k = 0; k < s->count; k++) out[k] = (float)found[k];
}

static _Bool put_map(const mu_varying *v, const musurf_material *material, const float *slots, float *texel) {
    float m[4];
    double whole[4], s[3];
    v->map->compose(material, slots, m);
    for (int i = 0; i < 4; i++) whole[i] = (double)m[i];
    mu_covariance_of(whole, s);
    for (int i = 0; i < 4; i++) texel[i] = m[i];
    for (int i = 0; i < 3; i++) texel[4 + i] = (float)s[i];
    texel[7] = 0;
    return isfinite(texel[4]) && isfinite(texel[5]) && isfinite(texel[6]) && texel[4] + texel[6] > 0;
}

static _Bool fill(mu_varying *v, const musurf_material *material, const mu_place *place, mu_error *error) {
    float slots[MU_SLOTS] = {0}, *texel = v->mipmap.texels;
    const int width = v->mipmap.level[0].width, height = v->mipmap.level[0].height;
    for (size_t i = 0; i < v->count; i++) /* a transform that comes before is not in the picture */
        if (!mu_source_is_picture(v->sources + i) && is_transform(v->sources + i))
            slots[v->sources[i].slot] = slots[v->sources[i].slot + 3] = 1;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++, texel += v->mipmap.channels) {
            float *raw = texel;
            for (size_t i = 0; i < v->count; i++) {
                const mu_source *s = v->sources + i;
                if (!mu_source_is_picture(s)) continue;
                values_at(s, x, y, width, height, v->map ? slots + s->slot : raw);
                raw += s->count;
            }
            if (v->map && !put_map(v, material, slots, texel))
                return mu_place_fail(
                    place, error,
                    "pixel %d of line %d (both from 0) of its pictures makes M singular, or too large or "
                    "small for a float (here [%g %g], [%g %g])",
                    x, y, (double)texel[0], (double)texel[1], (double)texel[2], (double)texel[3]);
        }
    mu_mipmap_build(&v->mipmap);
    return !v->map || mu_covariance_spread(&v->mipmap) || mu_place_fail(place, error, "not enough memory");
}

static _Bool compose(mu_varying *v, const musurf_material *material, const mu_place *place, mu_error *error) {
    int width = 0, height = 0, numbers = 0;
    for (size_t i = 0; i < v->count; i++) {
        if (!mu_source_is_picture(v->sources + i)) continue;
        const mu_mipmap *p = &v->sources[i].picture;
        if (p->level[0].width > width) width = p->level[0].width;
        if (p->level[0].height > height) height = p->level[0].height;
        numbers += v->sources[i].count;
    }
    if (!v->map && numbers > MU_MIPMAP_CHANNELS)
        return mu_place_fail(place, error, "has %d numbers from pictures; at most %d are possible", numbers,
                             MU_MIPMAP_CHANNELS);
    if (!mu_mipmap_make(&v->mipmap, width, height, v->map ? 8 : numbers, v->placement.wrap))
        return mu_place_fail(place, error, "not enough memory for %d x %d texels", width, height);
    if (!fill(v, material, place, error)) return 0;
    for (size_t i = 0; i < v->count; i++) mu_mipmap_free(&v->sources[i].picture);
    return 1;
}

mu_varying *mu_varying_make(mu_settings *settings, const musurf_material *material, const mu_place *place,
                            mu_error *error) {
    mu_varying *v = calloc(1, sizeof *v);
    if (!v) {
        mu_place_fail(place, error, "not enough memory");
        return NULL;
    }
    v->sources = settings->sources, v->count = settings->source_count;
    settings->sources = NULL, settings->source_count = 0;
    const musurf_material_type *type = settings->type;
    v->map = type->extension ? type->extension(MUSURF_MAP_ID) : NULL;
    float m[4], slots[MU_SLOTS] = {0};
    if (v->map && (v->map->size < sizeof *v->map || !v->map->compose(material, slots, m))) v->map = NULL;
    if (check(v, place, error) && (!v->pictured || compose(v, material, place, error))) return v;
    mu_varying_free(v);
    return NULL;
}

void mu_varying_free(mu_varying *varying) {
    if (!varying) return;
    for (size_t i = 0; i < varying->count; i++) mu_source_free(varying->sources + i);
    mu_mipmap_free(&varying->mipmap);
    free(varying->sources);
    free(varying);
}
