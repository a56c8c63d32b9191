/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* albedo_set.c: makes the tables of a surface, and chooses among them. */
#include "core/bsdf/albedo_set.h"
#include "core/bsdf/multiple.h"

#if MU_REAL_BITS == 24

/* The roughnesses to which a surface is blurred: below the first, what is lost follows the slopes' own scale and is less than
 * a table tells; beyond the last, tables stay as they are. */
static const float blurs_from = 1 / 64.0f, blurs_to = 4;
/* Floats that a table takes at most: alike in all azimuths, even along two axes, or tilted. */
enum { FEW = 1 << 9, SOME = 1 << 13, MANY = 1 << 16, BLUR_HALVINGS = 3 };

/* What the tables are made of: in float's range, where tables do not change any more with the roughness. */
static mu_definition reduced(const mu_definition *d) {
    mu_definition single = *d;
    single.multiple = MU_SINGLE;
    single.sampler = MU_SAMPLE_VISIBLE;
    if (!d->transmission) single.fresnel = MU_FRESNEL_NONE;
    return single;
}

static size_t floats(const mu_definition *d) {
    const int tilted = d->tilt[0] != 0 || d->tilt[1] != 0 || d->ndf == MU_TABULATED || d->ndf == MU_CUSTOM;
    const size_t one = tilted ? MANY : mu_transform_is_similarity(d->transform) ? FEW : SOME;
    return one * (d->transmission ? 2 : 1) * (1 + ALBEDO_BLURS);
}

size_t mu_albedo_set_bytes(const mu_definition *d) {
    const mu_definition single = reduced(d);
    return padded(sizeof(mu_albedo_set) + floats(d) * sizeof(float)) + padded(MU(mu_surface_bytes)(&single));
}

/* Of what blurring raises (mu_blur); a histogram's is not known here, so that some of its tables are alike. */
static float least_roughness(const surface *s, const mu_definition *d) {
    const double core = d->ndf == MU_TABULATED ? 0
                        : d->ndf == MU_GTR     ? fmin(1, (double)s->alpha / s->unit)
                                               : 1;
    return (float)core * map_least(&s->map);
}

void mu_albedo_set_make(const mu_definition *d, mu_albedo_set *out) {
    const mu_definition single = reduced(d);
    const size_t most = floats(d);
    albedo_source source = {
        .definition = &single, .error = d->compensation_error, .halvings = ALBEDO_HALVINGS};
    source.surface = MU(mu_surface_make)(&single, (char *)out + padded(sizeof *out + most * sizeof(float)));
    size_t used = mu_albedo_make(&source, &out->level[0], out->values, most);
    out->levels = 1;
    out->first_blur = fmaxf(least_roughness(source.surface, d), blurs_from);
    source.error = fmin(2.5 * d->compensation_error, 0.5), source.halvings = BLUR_HALVINGS;
    for (float blur = out->first_blur; out->levels <= ALBEDO_BLURS && blur < blurs_to * 1.4f; blur *= 2) {
        source.blur = blur * 1.000001f;
        used += mu_albedo_make(&source, &out->level[out->levels++], out->values + used, most - used);
    }
    out->unsure = 0;
    for (int k = 0; k < (d->transmission ? 2 : 1); k++)
        out->unsure = fmaxf(out->unsure, out->level[0].side[k].unsure);
    out->bytes = sizeof *out + used * sizeof(float);
}

static void average(mu_lobe *out, int side) {
    float all = 0, through = 0;
    for (int k = 0; k < out->count; k++) {
        const mu_albedo_side *s = &out->level[k]->side[side];
        all += out->share[k] * s->average;
        through += out->share[k] * s->average * s->passes;
    }
    out->average[side] = all;
    out->passes[side] = through / all;
}

void mu_albedo_set_choose(const mu_albedo_set *set, float blur, mu_lobe *out) {
    out->turn[0] = 1, out->turn[1] = 0;
    out->count = 1, out->share[0] = 1, out->level[0] = &set->level[0];
    if (blur > 0 && set->levels > 1) {
        const float octaves = log2f(blur / set->first_blur), most = (float)(set->levels - 2);
        const float at = fminf(fmaxf(octaves, 0), most);
        const int low = (int)fminf(at, fmaxf(most - 1, 0));
        out->level[0] = &set->level[1 + low], out->share[0] = 1 - (at - (float)low);
        if (most > 0) out->count = 2, out->level[1] = &set->level[2 + low], out->share[1] = at - (float)low;
    }
    average(out, 0);
    if (out->level[0]->side[1].cells) average(out, 1);
}

#endif
