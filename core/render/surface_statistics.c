/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_statistics.c: has every point looked at from all views at once and adds up in one fixed order. */
#include "core/render/surface_statistics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/surface_rows.h"

static _Bool make_view(mu_gathering *g, mu_seen *s) {
    const size_t bins = mu_directions_count(&g->bins) + 1;
    const double length = sqrt(s->w[0] * s->w[0] + s->w[1] * s->w[1] + s->w[2] * s->w[2]);
    for (int k = 0; k < 3; k++) s->unit[k] = s->w[k] / length;
    _Bool good = mu_ratios_make(&s->facing, g->units, bins, NULL);
    good = mu_ratios_make(&s->masking, g->units, bins, NULL) && good;
    good = mu_ratios_make(&s->projected, g->units, 1, NULL) && good;
    good = mu_ratios_make(&s->identity, g->units, 1, g->macro) && good;
    good = mu_ratios_make(&s->normals, g->units, bins, g->macro) && good;
    if (g->transmission) good = mu_through_make(g, s) && good;
    for (int c = 0; c < mu_gathering_channels(g); c++) {
        good = mu_ratios_make(&s->ends[c], g->units, MU_ENDS + g->bounces, s->identity.top) && good;
        good = mu_ratios_make(&s->directions[c], g->units, g->bounces * bins, s->identity.top) && good;
        good = mu_ratios_make(&s->lamps[c], g->units, 2 * (size_t)g->lamp_count, s->identity.top) && good;
    }
    if (g->lamp_count) s->groups = calloc(mu_directions_count(&g->finer) + 1, sizeof *s->groups);
    return good && (s->groups || !g->lamp_count);
}

_Bool mu_gathering_begin(mu_gathering *g, mu_error *error) {
    const size_t bins = mu_directions_count(&g->bins) + 1;
    g->units = g->file_count > 1 ? g->file_count : MU_STATISTICS_BLOCKS;
    g->pair_count = g->view_count * (g->view_count - 1) / 2;
    const uint32_t rings = MU_GROUPS_FINER * g->bins.rings, sectors = MU_GROUPS_FINER * g->bins.sectors;
    g->finer =
        (mu_directions){rings < MU_GROUP_RINGS ? rings : MU_GROUP_RINGS,
                        sectors < 4 * MU_GROUP_RINGS ? sectors : 4 * MU_GROUP_RINGS, g->bins.theta_most};
    g->macro = calloc(g->units, sizeof *g->macro);
    g->facets = calloc(bins, sizeof *g->facets);
    g->pairs = calloc(g->pair_count + 1, sizeof *g->pairs);
    _Bool good = g->macro && g->facets && g->pairs;
    if (good) {
        const size_t cells = (size_t)g->slope_cells * g->slope_cells + MU_SLOPE_MORE;
        good = mu_ratios_make(&g->slopes, g->units, cells, g->macro);
        good = mu_ratios_make(&g->normals, g->units, bins, g->macro) && good;
        for (uint32_t k = 0; k < g->view_count; k++) good = make_view(g, &g->views[k]) && good;
        for (uint32_t a = 0, k = 0; a < g->view_count; a++)
            for (uint32_t b = a + 1; b < g->view_count; b++, k++) {
                g->pairs[k].a = a, g->pairs[k].b = b;
                good = mu_ratios_make(&g->pairs[k].facing, g->units, bins, NULL) && good;
                good = mu_ratios_make(&g->pairs[k].masking, g->units, bins, NULL) && good;
                good = mu_ratios_make(&g->pairs[k].share, g->units, 1, NULL) && good;
            }
    }
    return good || mu_fail(error, "not enough memory for %u x %u bins of %u views", g->bins.rings,
                           g->bins.sectors, g->view_count);
}

void mu_gathering_free(mu_gathering *g) {
    for (uint32_t k = 0; k < g->view_count; k++) {
        mu_seen *s = &g->views[k];
        mu_ratios_free(&s->facing), mu_ratios_free(&s->masking), mu_ratios_free(&s->projected);
        mu_ratios_free(&s->identity), mu_ratios_free(&s->normals);
        for (int c = 0; c < 3; c++)
            mu_ratios_free(&s->ends[c]), mu_ratios_free(&s->directions[c]), mu_ratios_free(&s->lamps[c]);
        mu_through_free(&s->through);
        free(s->groups), free(s->visible);
    }
    for (uint32_t k = 0; g->pairs && k < g->pair_count; k++) {
        mu_seen_pair *p = &g->pairs[k];
        mu_ratios_free(&p->facing), mu_ratios_free(&p->masking), mu_ratios_free(&p->share);
    }
    mu_ratios_free(&g->slopes), mu_ratios_free(&g->normals);
    free(g->macro), free(g->facets), free(g->pairs);
}

typedef struct mu_glance {
    const mu_tracer *tracer;
    const void *look;
    uint32_t ny;
    uint8_t *visible;
} mu_glance;

static void look_at_row(void *context, uint32_t i) {
    const mu_glance *l = context;
    l->tracer->row(l->look, i, l->visible + (size_t)i * l->ny);
}

static _Bool look(const mu_gathering *g, void *surface, mu_seen *s, const mu_heightfield *f, int upper,
                  const double point[2], mu_error *error) {
    const mu_sight sight = {.m = {g->m[0], g->m[1], g->m[2], g->m[3]},
                            .w = {s->w[0], s->w[1], s->w[2]},
                            .u = point[0],
                            .v = point[1],
                            .upper = upper};
    mu_glance l = {g->tracer, g->tracer->look(surface, &sight, error), f->ny, s->visible};
    if (!l.look) return 0;
    mu_rows(f->nx, g->threads, look_at_row, &l);
    g->tracer->look_away((void *)(uintptr_t)l.look);
    return 1;
}

/* One point of one family, which all views have looked at. */
static void add_up(mu_gathering *g, uint32_t file, const mu_heightfield *f, int upper, const uint32_t *bins) {
    const double points = (double)g->side * g->side;
    for (uint32_t i = 0; i < f->nx; i++)
        for (uint32_t j = 0; j < f->ny; j++) {
            const size_t at = (size_t)i * f->ny + j, bin = bins[at],
                         unit = mu_gathering_unit(g, file, f, i, j);
            double slope[2], normal[3], facing[MU_STATISTICS_VIEWS];
            mu_facet_slope(f, i, j, upper, slope);
            mu_facet_normal(g->m, slope, normal);
            const double macro = points * normal[2];
            const double area =
                sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]) / macro;
            for (uint32_t k = 0; k < g->view_count; k++) {
                mu_seen *s = &g->views[k];
                facing[k] = mu_facet_facing(g->m, slope, s->w); /* as the tracer decides it */
                const double seen = s->visible[at], front = facing[k] > 0 ? 1 : 0;
                mu_ratios_add_both(&s->facing, unit, bin, area * front, area);
                mu_ratios_add_both(&s->masking, unit, bin, area * seen, area);
                if (!(facing[k] > 0)) continue;
                mu_ratios_add_both(&s->projected, unit, 0, facing[k] * seen, facing[k]);
                mu_ratios_add(&s->identity, unit, 0, facing[k] * seen / (s->w[2] * macro));
                mu_ratios_add(&s->normals, unit, bin, facing[k] * seen / (s->w[2] * macro));
            }
            for (uint32_t k = 0; k < g->pair_count; k++) {
                mu_seen_pair *p = &g->pairs[k];
                const _Bool front = facing[p->a] > 0 && facing[p->b] > 0;
                const uint8_t both = g->views[p->a].visible[at] & g->views[p->b].visible[at];
                mu_ratios_add_both(&p->facing, unit, bin, front ? area : 0, area);
                mu_ratios_add_both(&p->masking, unit, bin, both ? area : 0, area);
                if (front) mu_ratios_add_both(&p->share, unit, 0, both, 1);
            }
        }
}

static _Bool look_everywhere(mu_gathering *g, uint32_t file, const mu_heightfield *f, void *surface,
                             const uint32_t *bins, mu_error *error) {
    const mu_mirrors mirrors = mu_mirrors_make(f, g->m);
    const uint32_t side = g->side;
    const double all = 2.0 * side * side * g->view_count * g->file_count;
    double done = 2.0 * side * side * g->view_count * file;
    for (uint32_t k = 0; k < 2 * side; k++)
        for (uint32_t l = 0; l < side; l++) {
            const int upper = 2 * k + 4 * l + 3 > 4 * side; /* u + v > 1 in units of 1/(4 side) */
            const double point[2] = {(k + 0.5) / (2 * side), (l + 0.5) / side};
            for (uint32_t view = 0; view < g->view_count; view++, done++) {
                mu_seen *s = &g->views[view];
                if (g->progress) g->progress(g->context, done / all);
                if (!look(g, surface, s, f, upper, point, error)) return 0;
                if (g->bounces && !mu_gathering_paths(g, file, &mirrors, s, upper, point, error)) return 0;
                if (g->transmission && !mu_gathering_through(g, file, f, s, upper, point, error)) return 0;
            }
            add_up(g, file, f, upper, bins + (upper ? mu_cells(f) : 0));
        }
    return 1;
}

_Bool mu_gathering_add(mu_gathering *g, uint32_t file, const mu_heightfield *f, mu_error *error) {
    const size_t cells = mu_cells(f);
    uint32_t *bins = malloc(2 * cells * sizeof *bins);
    _Bool good = bins != NULL;
    for (uint32_t k = 0; k < g->view_count && good; k++) {
        uint8_t *more = realloc(g->views[k].visible, cells);
        if (more) g->views[k].visible = more;
        good = more != NULL;
    }
    if (good && g->transmission) good = (g->underside = mu_underside_caster(f)) != NULL;
    if (!good) mu_fail(error, "not enough memory for a surface of %u x %u", f->nx, f->ny);
    good = good && mu_gathering_normals(g, file, f, bins, error);
    if (good && g->view_count) {
        double views[MU_STATISTICS_VIEWS][3];
        for (uint32_t k = 0; k < g->view_count; k++) memcpy(views[k], g->views[k].w, sizeof views[k]);
        const mu_plan plan = {(const double(*)[3])views, g->view_count, g->side, g->threads};
        char version[128];
        void *const surface = g->tracer->version && !g->tracer->version(version, sizeof version, error)
                                  ? NULL
                                  : g->tracer->open(f, g->m, &plan, error);
        good = surface && look_everywhere(g, file, f, surface, bins, error);
        if (surface) g->tracer->close(surface);
    }
    mu_caster_free(g->underside);
    g->underside = NULL;
    free(bins);
    return good;
}
