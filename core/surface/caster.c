/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * caster.c: sixteen lanes on one walk; see caster.h.
 *
 * A lane is hidden as soon as the surface over a crossing, less the ray's rise there, exceeds the height of its point.
 * Crossings are taken in stretches of 16, those in runs of 8 stretches, those in runs of 64: before each, the highest
 * height under all lanes decides whether it can be left out.
 */
#include "core/surface/caster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LANES = 16, STRETCH = 16, RUN = 8, LEVELS = 3 };

struct mu_caster {
    uint32_t nx, ny;
    size_t stride;  /* of a row of `padded`, whose end repeats its beginning */
    double *padded; /* nx rows */
    double *plain;
    mu_pyramid pyramid;
    double low, high;
};

/* Edge ends as offsets modulo nx, ny. */
typedef struct mu_pass {
    uint32_t i0, j0, i1, j1;
    double weight, rise;
} mu_pass;

/* The rectangle of vertices that a run of crossings uses, and the ray's rise where it begins. */
typedef struct mu_run {
    int32_t i0, i1, j0, j1;
    double rise;
} mu_run;

struct mu_cast {
    const mu_caster *caster;
    mu_sight sight;
    mu_pass *passes;
    size_t count;
    mu_run *runs[LEVELS]; /* of STRETCH, STRETCH RUN, STRETCH RUN^2 crossings */
    size_t run_count[LEVELS];
};

mu_caster *mu_caster_make(const mu_heightfield *f) {
    mu_caster *c = calloc(1, sizeof *c);
    if (!c) return NULL;
    c->nx = f->nx, c->ny = f->ny;
    c->stride = (size_t)f->ny + LANES;
    c->padded = malloc(c->stride * f->nx * sizeof *c->padded);
    c->plain = malloc(mu_cells(f) * sizeof *c->plain);
    if (!c->padded || !c->plain) {
        mu_caster_free(c);
        return NULL;
    }
    memcpy(c->plain, f->h, mu_cells(f) * sizeof *c->plain);
    c->low = c->high = f->h[0];
    for (uint32_t i = 0; i < f->nx; i++)
        for (size_t j = 0; j < c->stride; j++) {
            const double h = f->h[(size_t)i * f->ny + j % f->ny];
            c->padded[i * c->stride + j] = h;
            c->low = fmin(c->low, h);
            c->high = fmax(c->high, h);
        }
    const mu_heightfield own = {c->plain, c->nx, c->ny};
    if (!mu_pyramid_make(&c->pyramid, &own)) {
        mu_caster_free(c);
        return NULL;
    }
    return c;
}

void mu_caster_free(mu_caster *c) {
    if (!c) return;
    mu_pyramid_free(&c->pyramid);
    free(c->padded);
    free(c->plain);
    free(c);
}

double mu_caster_range(const mu_caster *c) {
    return c->high - c->low;
}

static uint32_t wrapped(int32_t i, uint32_t n) {
    const int64_t rest = i % (int64_t)n;
    return (uint32_t)(rest < 0 ? rest + n : rest);
}

static int32_t lower(int32_t a, int32_t b) {
    return a < b ? a : b;
}

static int32_t upper(int32_t a, int32_t b) {
    return a > b ? a : b;
}

/* Rectangles around each stretch, then around runs of the level below. */
static _Bool make_runs(mu_cast *cast, const mu_walk *walk) {
    for (int l = 0; l < LEVELS; l++) {
        const size_t parts = l ? cast->run_count[l - 1] : walk->count, each = l ? RUN : STRETCH;
        cast->run_count[l] = (parts + each - 1) / each;
        mu_run *runs = cast->runs[l] = malloc((cast->run_count[l] + 1) * sizeof *runs);
        if (!runs) return 0;
        for (size_t k = 0; k < parts; k++) {
            mu_run part;
            if (l) {
                part = cast->runs[l - 1][k];
            } else {
                const mu_crossing *c = &walk->crossings[k];
                part = (mu_run){lower(c->left[0], c->right[0]), upper(c->left[0], c->right[0]),
                                lower(c->left[1], c->right[1]), upper(c->left[1], c->right[1]), c->rise};
            }
            mu_run *run = &runs[k / each];
            if (k % each == 0) *run = part;
            run->i0 = lower(run->i0, part.i0);
            run->i1 = upper(run->i1, part.i1);
            run->j0 = lower(run->j0, part.j0);
            run->j1 = upper(run->j1, part.j1);
        }
    }
    return 1;
}

mu_walk_result mu_cast_make(mu_cast **out, const mu_caster *caster, const mu_sight *sight) {
    *out = NULL;
    mu_walk walk;
    const mu_walk_result result =
        mu_walk_make(&walk, sight->m, sight->w, sight->u, sight->v, sight->upper, mu_caster_range(caster));
    if (result != MU_WALK_OK) return result;
    mu_cast *cast = calloc(1, sizeof *cast);
    if (cast) {
        cast->caster = caster;
        cast->sight = *sight;
        cast->count = walk.count;
        cast->passes = malloc((walk.count + 1) * sizeof *cast->passes);
    }
    if (!cast || !cast->passes || !make_runs(cast, &walk)) {
        mu_cast_free(cast);
        mu_walk_free(&walk);
        return MU_WALK_NO_MEMORY;
    }
    for (size_t k = 0; k < walk.count; k++) {
        const mu_crossing *c = &walk.crossings[k];
        cast->passes[k] = (mu_pass){wrapped(c->left[0], caster->nx),
                                    wrapped(c->left[1], caster->ny),
                                    wrapped(c->right[0], caster->nx),
                                    wrapped(c->right[1], caster->ny),
                                    c->weight,
                                    c->rise};
    }
    mu_walk_free(&walk);
    *out = cast;
    return MU_WALK_OK;
}

void mu_cast_free(mu_cast *cast) {
    if (!cast) return;
    for (int l = 0; l < LEVELS; l++) free(cast->runs[l]);
    free(cast->passes);
    free(cast);
}

typedef struct mu_lanes {
    double z[LANES]; /* heights of the points; infinite for lanes that are done */
    double lowest;   /* of z */
    uint32_t i, j;
} mu_lanes;

static const double *lane_heights(const mu_caster *c, uint32_t i, uint32_t j) {
    const uint32_t row = i < c->nx ? i : i - c->nx, column = j < c->ny ? j : j - c->ny;
    return c->padded + row * c->stride + column;
}

/* Crossings of one stretch; hidden lanes get z = infinity, which nothing hides again. */
static void follow(const mu_cast *cast, size_t first, mu_lanes *lanes) {
    const size_t end = first + STRETCH < cast->count ? first + STRETCH : cast->count;
    double horizon[LANES];
    for (int t = 0; t < LANES; t++) horizon[t] = -INFINITY;
    for (size_t k = first; k < end; k++) {
        const mu_pass *p = &cast->passes[k];
        const double *a = lane_heights(cast->caster, lanes->i + p->i0, lanes->j + p->j0);
        const double *b = lane_heights(cast->caster, lanes->i + p->i1, lanes->j + p->j1);
        const double wb = p->weight, wa = 1 - wb, rise = p->rise;
        for (int t = 0; t < LANES; t++) {
            const double above = wa * a[t] + wb * b[t] - rise;
            horizon[t] = above > horizon[t] ? above : horizon[t];
        }
    }
    double lowest = INFINITY;
    for (int t = 0; t < LANES; t++) {
        if (horizon[t] > lanes->z[t]) lanes->z[t] = INFINITY;
        lowest = fmin(lowest, lanes->z[t]);
    }
    lanes->lowest = lowest;
}

/* Whether the surface under the run stays below all lanes that are left. */
static _Bool clear(const mu_cast *cast, const mu_run *run, const mu_lanes *lanes) {
    const int64_t i = lanes->i, j = lanes->j;
    return mu_pyramid_most(&cast->caster->pyramid, i + run->i0, i + run->i1, j + run->j0,
                           j + run->j1 + LANES - 1) <= lanes->lowest + run->rise;
}

static void follow_all(const mu_cast *cast, mu_lanes *lanes) {
    for (size_t far = 0; far < cast->run_count[2]; far++) {
        if (lanes->lowest + cast->runs[2][far].rise > cast->caster->high) return;
        if (far && clear(cast, &cast->runs[2][far], lanes)) continue; /* the first is never clear */
        for (size_t run = far * RUN; run < (far + 1) * RUN && run < cast->run_count[1]; run++) {
            if (lanes->lowest + cast->runs[1][run].rise > cast->caster->high) return;
            if (clear(cast, &cast->runs[1][run], lanes)) continue;
            for (size_t part = run * RUN; part < (run + 1) * RUN && part < cast->run_count[0]; part++)
                if (!clear(cast, &cast->runs[0][part], lanes)) follow(cast, part * STRETCH, lanes);
        }
    }
}

void mu_cast_row(const mu_cast *cast, uint32_t i, uint8_t *visible) {
    const mu_caster *c = cast->caster;
    const mu_sight *s = &cast->sight;
    const mu_heightfield f = {c->plain, c->nx, c->ny};
    for (uint32_t j = 0; j < c->ny; j += LANES) {
        mu_lanes lanes = {.i = i, .j = j, .lowest = INFINITY};
        for (uint32_t t = 0; t < LANES; t++) {
            double slope[2];
            lanes.z[t] = INFINITY;
            if (j + t >= c->ny) continue;
            mu_facet_slope(&f, i, j + t, s->upper, slope);
            if (mu_facet_facing(s->m, slope, s->w) > 0)
                lanes.z[t] = mu_facet_height(&f, i, j + t, s->upper, s->u, s->v);
            lanes.lowest = fmin(lanes.lowest, lanes.z[t]);
        }
        if (lanes.lowest < INFINITY) follow_all(cast, &lanes);
        for (uint32_t t = 0; t < LANES && j + t < c->ny; t++) visible[j + t] = lanes.z[t] < INFINITY;
    }
}

_Bool mu_caster_sees(const mu_caster *c, const mu_sight *sight, uint32_t i, uint32_t j) {
    const mu_heightfield f = {c->plain, c->nx, c->ny};
    const double z = mu_facet_height(&f, i, j, sight->upper, sight->u, sight->v);
    mu_stepper s;
    if (!mu_stepper_begin(&s, sight->m, sight->w, sight->u, sight->v, sight->upper)) return 1;
    size_t steps = 0;
    for (mu_stepper_next(&s); z + s.edge.rise <= c->high; mu_stepper_next(&s)) {
        if (++steps > MU_WALK_MOST) return 0; /* all but horizontal, and not above all yet */
        const mu_crossing *e = &s.edge;
        const double a = c->plain[(size_t)wrapped(e->left[0] + (int32_t)i, c->nx) * c->ny +
                                  wrapped(e->left[1] + (int32_t)j, c->ny)];
        const double b = c->plain[(size_t)wrapped(e->right[0] + (int32_t)i, c->nx) * c->ny +
                                  wrapped(e->right[1] + (int32_t)j, c->ny)];
        if ((1 - e->weight) * a + e->weight * b - e->rise > z) return 0;
    }
    return 1;
}
