/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* varying.c: values at a hit. Nothing here allocates, locks or reads a file. */
#include "core/render/varying.h"

#include <math.h>
#include <string.h>

#include "core/render/covariance.h"

static void pointwise(const mu_varying *v, const float uv[2], const float *attributes, float *slots) {
    for (size_t i = 0; i < v->count; i++) {
        const mu_source *source = v->sources + i;
        for (int k = 0; k < source->count; k++) {
            float *const out = slots + source->slot + k;
            if (source->kind == MU_SOURCE_ATTRIBUTE)
                *out = (float)mu_source_of_vertices(source, k, attributes);
            else if (source->kind == MU_SOURCE_EXPRESSION)
                *out = (float)mu_expression_at(source->formula + k, (double)uv[0], (double)uv[1]).value;
        }
    }
}

static void look_up(const mu_varying *v, const float footprint[6], float most, double *out) {
    const mu_mipmap_limit limit = {7, (double)most};
    const mu_placement *p = &v->placement;
    double uv[2], axes[4];
    for (int i = 0; i < 2; i++) uv[i] = (double)footprint[i] * p->scale[i] + p->offset[i];
    for (int i = 0; i < 4; i++) axes[i] = (double)footprint[2 + i] * p->scale[i % 2];
    mu_mipmap_at(&v->mipmap, uv, p->filtered ? axes : NULL, v->map ? &limit : NULL, out);
}

/* m = a m, where a is what stands before the pictures. */
static void put_before(const float a[4], double m[4]) {
    for (int column = 0; column < 2; column++) {
        const double x = m[column], y = m[2 + column];
        m[column] = (double)a[0] * x + (double)a[1] * y;
        m[2 + column] = (double)a[2] * x + (double)a[3] * y;
    }
}

void mu_varying_at(const mu_varying *v, const musurf_material *material, const float footprint[6], float most,
                   const float *attributes, float *slots, float m[4]) {
    double found[MU_MIPMAP_CHANNELS], whole[4];
    if (v->pointwise) pointwise(v, footprint, attributes, slots);
    if (v->pictured) look_up(v, footprint, most, found);
    if (v->map && v->pictured) {
        mu_covariance_map(found + 4, found, whole);
        for (int i = 0; i < 4; i++)
            if (!isfinite(whole[i])) memcpy(whole, found, sizeof whole); /* so long that S forgot how wide */
        for (size_t i = 0; i < v->count && v->pointwise; i++)
            if (!mu_source_is_picture(v->sources + i)) put_before(slots + v->sources[i].slot, whole);
        for (int i = 0; i < 4; i++) m[i] = (float)whole[i];
    } else if (v->map) {
        v->map->compose(material, slots, m);
    } else if (v->pictured) {
        int at = 0;
        for (size_t i = 0; i < v->count; i++)
            for (int k = 0; k < v->sources[i].count && mu_source_is_picture(v->sources + i); k++)
                slots[v->sources[i].slot + (uint32_t)k] = (float)found[at++];
    }
}
