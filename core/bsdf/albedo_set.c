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

/* GGX of the same masking: what blurring makes of any distribution. */
static mu_definition blurred(const mu_definition *single) {
    mu_definition ggx = *single;
    ggx.ndf = MU_GGX, ggx.alpha = 1;
    return ggx;
}

static int grid_steps(const mu_definition *d) {
    const int heavy = d->ndf == MU_GGX || d->ndf == MU_DISCRETE_GGX ||
                      ((d->ndf == MU_GTR || d->ndf == MU_STD) && d->gamma <= 2);
    return heavy ? ALBEDO_HEAVY_STEPS : ALBEDO_STEPS;
}

/* Of a grid of its own, and of GGX's. */
static size_t grid_tables(const mu_definition *d) {
    if (!d->compensation_varies) return 0;
    const int ggx = albedo_grid_tables(ALBEDO_HEAVY_STEPS);
    return (size_t)(d->ndf == MU_GGX ? ggx : ggx + albedo_grid_tables(grid_steps(d)));
}
/* Values; tables of grids; the surfaces that they are made from. */
static size_t values_bytes(const mu_definition *d) {
    return padded(sizeof(mu_albedo_set) + (floats(d) + grid_tables(d) * ALBEDO_GRID_MEAN) * sizeof(float));
}
static size_t grids_bytes(const mu_definition *d) {
    return padded(grid_tables(d) * sizeof(mu_albedo));
}

size_t mu_albedo_set_bytes(const mu_definition *d) {
    const mu_definition single = reduced(d), ggx = blurred(&single);
    const size_t one = MU(mu_surface_bytes)(&single), other = MU(mu_surface_bytes)(&ggx);
    return values_bytes(d) + grids_bytes(d) + padded(one > other ? one : other);
}

/* Of what blurring raises (mu_blur); a histogram's is not known here, so that some of its tables are alike. */
static float least_roughness(const surface *s, const mu_definition *d) {
    const double core = d->ndf == MU_TABULATED ? 0
                        : d->ndf == MU_GTR     ? fmin(1, (double)s->alpha / s->unit)
                                               : 1;
    return (float)core * map_least(&s->map);
}

static size_t make_blurs(albedo_source *source, mu_albedo_set *out, size_t used, size_t most) {
    out->first_blur = fmaxf(least_roughness(source->surface, source->definition), blurs_from);
    source->error = fmin(2.5 * source->error, 0.5), source->halvings = BLUR_HALVINGS;
    for (float blur = out->first_blur; out->levels <= ALBEDO_BLURS && blur < blurs_to * 1.4f; blur *= 2) {
        source->blur = blur * 1.000001f;
        used += mu_albedo_make(source, &out->level[out->levels++], out->values + used, most - used);
    }
    return used;
}

static size_t make_grid(const albedo_source *source, int steps, mu_albedo *table, float *values,
                        albedo_grid *out, float *unsure) {
    const size_t most = (size_t)albedo_grid_tables(steps) * ALBEDO_GRID_MEAN;
    float more;
    *out = (albedo_grid){table, steps};
    const size_t used = mu_albedo_grid_make(source, steps, table, values, most, &more);
    *unsure = fmaxf(*unsure, more);
    return used;
}

/* Of the distribution, and of GGX, from another surface in the same place, unless that is the same. */
static size_t make_grids(albedo_source *source, mu_albedo_set *out, mu_albedo *table, void *memory,
                         size_t used) {
    const int is_ggx = source->definition->ndf == MU_GGX, steps = grid_steps(source->definition);
    const mu_definition ggx = blurred(source->definition);
    used += make_grid(source, steps, table, out->values + used, &out->grid, &out->unsure);
    out->blurred = out->grid;
    if (is_ggx) return used;
    source->surface = MU(mu_surface_make)(&ggx, memory), source->definition = &ggx;
    table += albedo_grid_tables(steps);
    return used +
           make_grid(source, ALBEDO_HEAVY_STEPS, table, out->values + used, &out->blurred, &out->unsure);
}

void mu_albedo_set_make(const mu_definition *d, mu_albedo_set *out) {
    const mu_definition single = reduced(d);
    const size_t most = floats(d);
    char *const grid = (char *)out + values_bytes(d), *const single_at = grid + grids_bytes(d);
    albedo_source source = {
        .definition = &single, .error = d->compensation_error, .halvings = ALBEDO_HALVINGS};
    source.surface = MU(mu_surface_make)(&single, single_at);
    /* what a lattice is off by does not fall as cells do: refining would chase it (albedo_quadrature.c) */
    if (source.surface->kernel->traits & HAS_JUMPS) source.halvings = 2;
    size_t used = mu_albedo_make(&source, &out->level[0], out->values, most);
    out->levels = 1;
    out->unsure = 0, out->grid = out->blurred = (albedo_grid){NULL, 0};
    used = d->compensation_varies ? make_grids(&source, out, (void *)grid, single_at, used)
                                  : make_blurs(&source, out, used, most);
    float own = 0;
    for (int k = 0; k < (d->transmission ? 2 : 1); k++) own = fmaxf(own, out->level[0].side[k].unsure);
    if (own > (float)d->compensation_error) out->unsure = fmaxf(out->unsure, own);
    out->bytes = sizeof *out + used * sizeof(float) + grids_bytes(d);
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

/* The axes of V^T V, from the half of its angle that does not cancel. */
static void turn_to_axes(const float v[4], float turn[2]) {
    const float p = v[0] * v[0] + v[2] * v[2] - v[1] * v[1] - v[3] * v[3],
                q = 2 * (v[0] * v[1] + v[2] * v[3]);
    const float r = hypotf(p, q), large = sqrtf((r + fabsf(p)) / 2);
    const float cosine = r > 0 ? p >= 0 ? large : fabsf(q) / (2 * large) : 1;
    const float sine = r > 0 ? copysignf(p >= 0 ? fabsf(q) / (2 * large) : large, q) : 0;
    const float length = r > 0 ? sqrtf(r) : 1;
    turn[0] = cosine / length, turn[1] = -sine / length;
}

void mu_albedo_set_choose_at(const mu_albedo_set *set, int blurred_too, const float v[4], mu_lobe *out) {
    const float plus = hypotf(v[0] + v[3], v[1] - v[2]), minus = hypotf(v[0] - v[3], v[1] + v[2]);
    const float a = (plus + minus) / 2, n[4] = {v[0] / a, v[1] / a, v[2] / a, v[3] / a};
    turn_to_axes(n, out->turn);
    mu_albedo_grid_choose(blurred_too ? &set->blurred : &set->grid, a, a * fabsf(n[0] * n[3] - n[1] * n[2]),
                          out);
    average(out, 0);
}

#endif
