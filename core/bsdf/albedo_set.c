/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* albedo_set.c: makes the tables of a surface, and chooses among them, or what integrates. */
#include "core/bsdf/albedo_set.h"
#include "core/bsdf/albedo_maker.h"
#include "core/bsdf/multiple.h"
#include "core/bsdf/singular.h"
#include <string.h>

#if MU_REAL_BITS == 24

/* log2 of the roughnesses between which blurring has tables. */
static const float blurs_from = -7.5f, blurs_to = 4.2f;
/* Floats that a table takes at most: alike in all azimuths, even along two axes, or tilted. */
enum {
    FEW = 1 << 10,
    SOME = 1 << 14,
    MANY = 1 << 16,
    BLUR_CELLS = 4,
    BLUR_HALVINGS = 7,
    UNEVEN_HALVINGS = 10
};

/* M = R(left) diag R(right), from which R(-left) takes what comes last, a turn of the world. For then float holds any M: an entry
 * of M^-1 is as large as its column, and not as another axis that lies between the world's. What is round keeps its M. */
static double turn_of(const mu_definition *d) {
    const singular s = singular_of(d->transform);
    return mu_transform_is_similarity(d->transform) ? 0 : (s.sum + s.difference) / 2;
}
static void turn_back(const mu_definition *d, double m[4]) {
    const singular s = singular_of(d->transform);
    const double right = (s.sum - s.difference) / 2, c = cos(right), sine = sin(right);
    if (mu_transform_is_similarity(d->transform)) return;
    m[0] = s.large * c, m[1] = -s.large * sine, m[2] = s.small * sine, m[3] = s.small * c;
}

/* What the tables are made of. */
static mu_definition reduced(const mu_definition *d) {
    mu_definition single = *d;
    turn_back(d, single.transform);
    single.multiple = MU_SINGLE;
    single.sampler = MU_SAMPLE_VISIBLE;
    if (!d->transmission) single.fresnel = MU_FRESNEL_NONE;
    return single;
}

/* Not surely: where it is not, tables are of all four quadrants. */
static int is_level(const mu_definition *d) {
    return d->tilt[0] == 0 && d->tilt[1] == 0 && d->ndf != MU_TABULATED && d->ndf != MU_CUSTOM;
}

/* Floats of a table; and of one that is blurred, on average. */
static size_t floats_of_one(const mu_definition *d, int is_blurred) {
    const int tilted = !is_level(d);
    const size_t side = (1u << BLUR_CELLS) + 1, sides = d->transmission ? 2 : 1;
    if (is_blurred) return (tilted ? 32u : 8u) * 2 * side * side * sides;
    return (tilted ? MANY : mu_transform_is_similarity(d->transform) ? FEW : SOME * sides) * sides;
}
/* Do tables serve an M of the point? */
static int is_graded(const mu_definition *d) {
    return d->compensation_varies && is_level(d) && !d->transmission;
}
static size_t floats(const mu_definition *d) {
    if (d->compensation_varies) return is_graded(d) ? floats_of_one(d, 0) : 0;
    return floats_of_one(d, 0) + (d->compensation_blurs ? ALBEDO_BLURS * floats_of_one(d, 1) : 0);
}

/* GGX of the same masking: what blurring makes of any distribution. */
static mu_definition blurred(const mu_definition *single) {
    mu_definition ggx = *single;
    ggx.ndf = MU_GGX, ggx.alpha = 1;
    return ggx;
}

/* Under an M of the point: is what blurring makes of it another surface, that needs grids and averages of its own? */
static int has_other(const mu_definition *d) {
    return d->compensation_varies && d->compensation_blurs && is_level(d) && d->ndf != MU_GGX;
}
/* Of a grid of its own, and of GGX's. */
static size_t grid_tables(const mu_definition *d) {
    return is_graded(d) ? (size_t)ALBEDO_GRID_TABLES * (has_other(d) ? 2 : 1) : 0;
}
/* Values; patches; tables of grids; the surfaces that they are made from. */
static size_t all_floats(const mu_definition *d) {
    return floats(d) + grid_tables(d) * ALBEDO_GRID_MEAN +
           grid_tables(d) / ALBEDO_GRID_TABLES * ALBEDO_GRID_AVERAGES +
           (d->compensation_varies ? (has_other(d) ? 2 : 1) * (size_t)ALBEDO_MEANS_FLOATS : 0);
}
static size_t values_bytes(const mu_definition *d) {
    return padded(sizeof(mu_albedo_set) + all_floats(d) * sizeof(float));
}
static size_t patches_bytes(const mu_definition *d) {
    return padded(all_floats(d) / ALBEDO_PATCH_FLOATS * sizeof(albedo_patch));
}
static size_t grids_bytes(const mu_definition *d) {
    return padded(grid_tables(d) * sizeof(mu_albedo));
}

static size_t open_bytes(const mu_definition *d) {
    return padded(sizeof(albedo_open) + (d->ndf == MU_TABULATED ? ALBEDO_SLOPES * sizeof(albedo_slope) : 0));
}
static size_t other_bytes(const mu_definition *d) {
    const mu_definition single = reduced(d), ggx = blurred(&single);
    return has_other(d) ? padded(sizeof(albedo_open)) + padded(MU(mu_surface_bytes)(&ggx)) : 0;
}

size_t mu_albedo_set_bytes(const mu_definition *d) {
    const mu_definition single = reduced(d);
    return values_bytes(d) + patches_bytes(d) + grids_bytes(d) + open_bytes(d) + other_bytes(d) +
           padded(MU(mu_surface_bytes)(&single));
}

/* The least roughness to which blurring raises a surface (mu_blur): asked of it, for only it knows what stands for a histogram. */
static float least_roughness(const surface *s) {
    float low = -30, high = 30;
    for (int k = 0; k < 24; k++) {
        const float middle = (low + high) / 2;
        closure c;
        MU(mu_bind)(s, (const float[]){0, 0, 1}, NULL, &c);
        const map before = c.map;
        MU(mu_blur)(&c, exp2f(middle));
        if (memcmp(&before, &c.map, sizeof before) == 0)
            low = middle;
        else
            high = middle;
    }
    return exp2f(high);
}

/* s M^-1 of what blurring makes of a surface. */
static void blurred_view(const surface *s, float blur, double v[4]) {
    closure c;
    MU(mu_bind)(s, (const float[]){0, 0, 1}, NULL, &c);
    MU(mu_blur)(&c, blur);
    for (int k = 0; k < 4; k++) v[k] = (double)(c.map.view[k] / c.map.view_z);
}

/* What is lost at a place in the frame that blurring makes; of what keeps to frames of its own, toward a direction. */
typedef struct blur_probes {
    const albedo_source *source;
    int tilted, sides;
} blur_probes;

/* Its direction; the side is that of its sign. */
static void blur_direction(const blur_probes *p, float x, int probe, float w[3]) {
    const int k = probe / p->sides, many = ALBEDO_PROBES / p->sides;
    const double height = (k + 0.5) / many, phi = 2 * PI * fmod(k * 0.6180339887498949, 1);
    double at[3] = {cos(phi), sin(phi), p->tilted ? height / sqrt(1 - height * height) : 1 / height - 1};
    if (!p->tilted) {
        double v[4];
        mu_albedo_frame f;
        blurred_view(p->source->surface, exp2f(x) * 1.000001f, v);
        mu_albedo_lay(v, &f);
        const double q[2] = {at[0], at[1]};
        for (int i = 0; i < 2; i++) at[i] = (double)f.from[2 * i] * q[0] + (double)f.from[2 * i + 1] * q[1];
    }
    const double length = sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]),
                 sign = probe % p->sides ? -1 : 1;
    for (int i = 0; i < 3; i++) w[i] = (float)(sign * at[i] / length);
}

static float probe_blur(const void *context, float x, int probe) {
    const blur_probes *const p = context;
    albedo_source source = *p->source;
    float w[3];
    closure c;
    blur_direction(p, x, probe, w);
    source.blur = exp2f(x) * 1.000001f;
    if (!mu_albedo_bind(&source, w, &c)) return 1;
    return mu_albedo_lost(&source, &c);
}

/* Is what two tables say midway between them off by more than that? */
static int is_gap(const blur_probes *p, const mu_albedo_set *set, float x, float wanted) {
    double v[4];
    mu_lobe lobe;
    const float blur = exp2f(x) * 1.000001f;
    int gap = 0;
    blurred_view(p->source->surface, blur, v);
    mu_albedo_set_choose_blurred(set, blur, v, &lobe);
    for (int probe = 0; probe < ALBEDO_PROBES / p->sides * p->sides && !gap; probe++) {
        float w[3], density;
        int open;
        blur_direction(p, x, probe, w);
        const float turn = w[2] < 0 ? -1.0f : 1.0f, up[3] = {turn * w[0], turn * w[1], turn * w[2]},
                    told = lobe_told(&lobe, turn < 0, up, &density, &open);
        gap = !open && fabsf(told - probe_blur(p, x, probe)) > wanted;
    }
    return gap;
}

static void make_blurs(albedo_source *source, mu_albedo_set *out, albedo_room *room) {
    const int sides = source->surface->transmission ? 2 : 1, tilted = out->level[0].quadrants > 1;
    const float least = log2f(fmaxf(least_roughness(source->surface), 1e-30f));
    const blur_probes context = {source, tilted, sides};
    const albedo_probes probes = {probe_blur, &context, ALBEDO_PROBES / sides * sides};
    const size_t before = source->effort->facets, may_take = source->facets;
    const float wanted = 0.7f * (float)source->error;
    source->halvings = BLUR_HALVINGS, source->trusting = 1, source->error *= 0.6;
    const int count = mu_albedo_place_nodes(
        &probes, fminf(fmaxf(least, blurs_from), blurs_to), blurs_to, (float)source->error / 2,
        tilted && sides == 2 ? ALBEDO_BLURS / 2 : ALBEDO_BLURS, out->log_blur);
    for (int k = 0; k < count; k++) {
        const size_t taken = source->effort->facets - before;
        source->blur = exp2f(out->log_blur[k]) * 1.000001f;
        source->facets = (may_take > taken ? may_take - taken : 0) / (size_t)(1 + (count - 1 - k) / 4);
        mu_albedo_make(source, &out->level[out->levels++], room, 2 * floats_of_one(source->definition, 1));
    }
    for (int k = 0; k < 2 * out->levels - 3; k++) {
        double v[4];
        mu_lobe lobe;
        const float blur = exp2f((out->log_blur[k / 2] + out->log_blur[(k + 1) / 2]) / 2) * 1.000001f;
        blurred_view(source->surface, blur, v);
        mu_albedo_set_choose_blurred(out, blur, v, &lobe);
        for (int side = 0; side < sides; side++)
            out->log_average[side][k] = (float)log(lobe_average(&lobe, side));
    }
    for (int k = 0; k < out->levels - 2 && source->opens; k++)
        out->gap[k] =
            (unsigned char)is_gap(&context, out, (out->log_blur[k] + out->log_blur[k + 1]) / 2, wanted);
}

/* What integrates: all that the tables were made of, but for what they are made with. */
static void keep(albedo_open *open, const albedo_source *source, double turn) {
    open->source = *source;
    open->turn[0] = (float)cos(turn), open->turn[1] = (float)sin(turn);
    open->source.definition = NULL, open->source.effort = NULL, open->source.allowed = source->error / 2;
}

/* Averages, and a grid if tables serve. */
static void make_for_points(albedo_source *source, const albedo_open *open, mu_albedo *table,
                            albedo_room *room, albedo_grid *grid, albedo_means *means) {
    room->used[0] += mu_albedo_means_make(source, open, room->values + room->used[0], means);
    if (table) mu_albedo_grid_make(source, table, room, grid);
}

/* Of the distribution, and of GGX, which blurring makes of what is level. */
static void make_points(const mu_definition *d, albedo_source *source, mu_albedo_set *out, albedo_open *open,
                        mu_albedo *table, void *other_at, albedo_room *room) {
    const mu_definition ggx = blurred(source->definition);
    if (!is_graded(d)) table = NULL;
    keep(open, source, 0), out->open = open;
    make_for_points(source, open, table, room, &out->grid, &out->means);
    out->blurs = is_level(d) && (d->compensation_blurs || d->ndf == MU_GGX);
    if (!has_other(d)) {
        out->blurred = out->grid, out->blurred_means = out->means, out->other = open;
        return;
    }
    albedo_open *const other = other_at;
    source->surface = MU(mu_surface_make)(&ggx, (char *)other_at + padded(sizeof *other));
    source->definition = &ggx, source->lengths[0] = source->lengths[1];
    keep(other, source, 0), out->other = other;
    make_for_points(source, other, table ? table + ALBEDO_GRID_TABLES : NULL, room, &out->blurred,
                    &out->blurred_means);
    source->definition = NULL;
}

/* Keeps what the tables were made of, if any of them is open somewhere. */
static void keep_open(const mu_definition *d, mu_albedo_set *out, albedo_open *open,
                      const albedo_source *source) {
    int opens = 0;
    for (int k = 0; k < out->levels - 2; k++) opens |= out->gap[k];
    for (int k = 0; k < out->levels; k++)
        for (int side = 0; side < (d->transmission ? 2 : 1); side++)
            opens |= out->level[k].side[side].open > 0;
    if (opens) keep(open, source, turn_of(d)), out->open = open;
}

void mu_albedo_set_make(const mu_definition *d, mu_albedo_set *out) {
    const mu_definition single = reduced(d);
    char *const patches = (char *)out + values_bytes(d), *const grid = patches + patches_bytes(d),
                *const open_at = grid + grids_bytes(d), *const other_at = open_at + open_bytes(d),
                *const single_at = other_at + other_bytes(d);
    albedo_room room = {.values = out->values,
                        .patch = (void *)patches,
                        .most = {all_floats(d), all_floats(d) / ALBEDO_PATCH_FLOATS}};
    albedo_effort effort = {0, 0};
    albedo_source source = {.definition = &single,
                            .error = d->compensation_error,
                            .allowed = fmin(d->compensation_error / 4, 2e-3),
                            .halvings = is_level(d) ? ALBEDO_HALVINGS : UNEVEN_HALVINGS,
                            .opens = !d->compensation_varies,
                            .effort = &effort,
                            .facets = ALBEDO_FACETS /
                                      (size_t)(d->compensation_blurs || d->compensation_varies ? 4 : 1)};
    source.surface = MU(mu_surface_make)(&single, single_at);
    albedo_open *const open = (void *)open_at;
    if (d->ndf == MU_TABULATED) mu_albedo_slopes(source.surface, open->slopes), source.slopes = open->slopes;
    mu_albedo_measure(&source, &open->lengths[0]), source.lengths[0] = &open->lengths[0];
    if (d->compensation_blurs) {
        source.blur = 1e6f;
        mu_albedo_measure(&source, &open->lengths[1]), source.lengths[1] = &open->lengths[1];
        source.blur = 0;
    }
    memset(out->gap, 0, sizeof out->gap);
    out->levels = !d->compensation_varies || is_graded(d), out->blurs = d->compensation_blurs;
    out->unsure = 0, out->open = out->other = NULL, out->grid = out->blurred = (albedo_grid){.table = NULL};
    out->means = out->blurred_means = (albedo_means){.value = NULL};
    if (out->levels) mu_albedo_make(&source, &out->level[0], &room, floats_of_one(d, 0));
    /* the rest of the work is for these */
    source.facets = ALBEDO_FACETS / 4 * 3 / (size_t)(has_other(d) ? 2 : 1);
    if (d->compensation_varies)
        make_points(d, &source, out, open, (void *)grid, other_at, &room);
    else if (out->blurs)
        make_blurs(&source, out, &room);
    if (!d->compensation_varies) keep_open(d, out, open, &source);
    for (int k = 0; k < out->levels; k++)
        for (int side = 0; side < (d->transmission ? 2 : 1); side++) {
            const float off = out->level[k].side[side].unsure;
            if (off > (float)d->compensation_error) out->unsure = fmaxf(out->unsure, off);
        }
    for (int k = 0; k < out->levels; k++) mu_albedo_turn(&out->level[k].frame, turn_of(d));
    out->bytes = sizeof *out + room.used[0] * sizeof(float) + room.used[1] * sizeof(albedo_patch) +
                 grids_bytes(d) + (out->open ? open_bytes(d) + other_bytes(d) : 0);
}

void mu_albedo_set_choose_moved(const mu_albedo_set *set, float blur, const double v[4], mu_lobe *out) {
    const albedo_grid *const grid = blur > 0 ? &set->blurred : &set->grid;
    out->set = set, out->blur = blur, out->moved = 1, out->open = 0;
    if (grid->table && mu_albedo_grid_choose(grid, v, out)) return;
    mu_albedo_means_choose(blur > 0 ? &set->blurred_means : &set->means, blur > 0 ? set->other : set->open, v,
                           out);
}

void mu_albedo_set_choose(const mu_albedo_set *set, const double v[4], mu_lobe *out) {
    const mu_albedo *t = &set->level[0];
    if (!set->levels) {
        mu_albedo_set_choose_moved(set, 0, v, out);
        return;
    }
    out->set = set, out->blur = 0, out->open = out->moved = 0;
    out->count = 1, out->share[0] = 1, out->level[0] = t, out->frame = t->frame;
    for (int side = 0; side < 2; side++) out->average[side] = t->side[side].average;
    out->passes[0] = t->side[0].passes;
}

void mu_albedo_set_choose_blurred(const mu_albedo_set *set, float blur, const double v[4], mu_lobe *out) {
    const int last = set->levels - 2;
    int k = 0;
    if (last < 0) {
        mu_albedo_set_choose(set, v, out);
        return;
    }
    const float x = fminf(fmaxf(log2f(blur), set->log_blur[0]), set->log_blur[last]), *const n =
                                                                                          set->log_blur;
    while (k < last - 1 && x >= n[k + 1]) k++;
    const float f = last ? (x - n[k]) / (n[k + 1] - n[k]) : 0,
                g = last ? mu_albedo_share(x, n[k], n[k + 1]) : 0;
    const mu_albedo *t = &set->level[1 + k], *next = last ? t + 1 : t;
    out->set = set, out->blur = blur, out->moved = 0, out->open = g > 0 && set->gap[k];
    out->count = g > 0 ? 2 : 1;
    out->level[0] = t, out->share[0] = 1 - g, out->level[1] = next, out->share[1] = g;
    mu_albedo_lay(v, &out->frame);
    for (int side = 0; side < (t->side[1].cells ? 2 : 1); side++) {
        const float *l = &set->log_average[side][2 * k];
        out->average[side] =
            t->quadrants > 1 || !last
                ? (1 - g) * t->side[side].average + g * next->side[side].average
                : expf((1 - f) * (1 - 2 * f) * l[0] + 4 * f * (1 - f) * l[1] + f * (2 * f - 1) * l[2]);
    }
    out->passes[0] = (1 - g) * t->side[0].passes + g * next->side[0].passes;
}

#endif
