/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_measure.c: has the points looked at, row by row on all threads, and adds up in one fixed order. */
#include "core/render/surface_measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/surface_rows.h"

mu_estimate mu_blocks_ratio(const mu_blocks *b) {
    double top = 0, bottom = 0, squares = 0;
    for (int k = 0; k < MU_BLOCKS; k++) top += b->top[k], bottom += b->bottom[k];
    if (!(bottom > 0)) return (mu_estimate){(double)NAN, (double)NAN};
    for (int k = 0; k < MU_BLOCKS; k++) {
        const double rest = b->top[k] - top / bottom * b->bottom[k];
        squares += rest * rest;
    }
    return (mu_estimate){top / bottom, sqrt(squares * MU_BLOCKS / (MU_BLOCKS - 1)) / bottom};
}

typedef struct mu_looking {
    const mu_tracer *tracer;
    const void *look;
    uint32_t ny;
    uint16_t *count; /* NULL: not to be counted */
    uint8_t *row;    /* of all cells: rows are written apart, so that `seen` may be left alone */
} mu_looking;

static void look_at_row(void *context, uint32_t i) {
    const mu_looking *l = context;
    uint8_t *row = l->row + (size_t)i * l->ny;
    l->tracer->row(l->look, i, row);
    for (uint32_t j = 0; l->count && j < l->ny; j++) l->count[(size_t)i * l->ny + j] += row[j];
}

/* One point of every cell: into `seen` or, if that is NULL, only counted. */
static _Bool look(const mu_measuring *s, void *surface, const double w[3], int upper, const double point[2],
                  uint8_t *seen, uint16_t *count, uint8_t *spare, mu_error *error) {
    const mu_sight sight = {.m = {s->m[0], s->m[1], s->m[2], s->m[3]},
                            .w = {w[0], w[1], w[2]},
                            .u = point[0],
                            .v = point[1],
                            .upper = upper};
    mu_looking l = {.tracer = s->tracer, .ny = s->f.ny, .count = count, .row = seen ? seen : spare};
    void *const at = s->tracer->look(surface, &sight, error);
    if (!at) return 0;
    l.look = at;
    mu_rows(s->f.nx, s->threads, look_at_row, &l);
    s->tracer->look_away(at);
    return 1;
}

static _Bool look_everywhere(const mu_measuring *s, void *surface, mu_view *view, uint8_t *spare,
                             uint32_t *done, mu_error *error) {
    static const double one[2][2] = {{0.25, 0.5}, {0.75, 0.5}};
    const uint32_t side = s->side, each = 2 * side * side + (side % 2 ? 0 : 2), all = s->view_count * each;
    for (int upper = 0; upper < 2; upper++) {
        if (side % 2 == 0) { /* the one point is not among the many */
            if (s->progress) s->progress(s->context, (*done)++, all);
            if (!look(s, surface, view->w, upper, one[upper], view->seen[upper], NULL, spare, error))
                return 0;
        }
        for (uint32_t k = 0; k < 2 * side; k++)
            for (uint32_t l = 0; l < side; l++) {
                if ((2 * k + 4 * l + 3 > 4 * side) != upper) continue; /* u + v > 1 in units of 1/(4 side) */
                const double point[2] = {(k + 0.5) / (2 * side), (l + 0.5) / side};
                const _Bool middle = side % 2 && l == side / 2 && k == (upper ? 3 * side : side) / 2;
                if (s->progress) s->progress(s->context, (*done)++, all);
                if (!look(s, surface, view->w, upper, middle ? one[upper] : point,
                          middle ? view->seen[upper] : NULL, view->count[upper], spare, error))
                    return 0;
            }
    }
    return 1;
}

/* Cells whose rays leave the surface are not known to be seen. */
static void forget_outside(const mu_measuring *s, mu_view *view) {
    const mu_window c = view->window;
    for (uint32_t i = 0; s->open && i < s->f.nx; i++)
        for (uint32_t j = 0; j < s->f.ny; j++)
            if (i < c.i0 || i >= c.i1 || j < c.j0 || j >= c.j1)
                view->seen[0][(size_t)i * s->f.ny + j] = view->seen[1][(size_t)i * s->f.ny + j] = 0;
}

static void add_up(const mu_measuring *s, mu_view *view) {
    const mu_window c = view->window;
    const uint32_t ny = s->f.ny;
    const double points = (double)s->side * s->side;
    mu_blocks facets = {0}, projected = {0};
    for (uint32_t i = c.i0; i < c.i1; i++)
        for (uint32_t j = c.j0; j < c.j1; j++)
            for (int upper = 0; upper < 2; upper++) {
                const size_t at = (size_t)i * ny + j;
                double slope[2];
                mu_facet_slope(&s->f, i, j, upper, slope);
                const double facing = mu_facet_facing(s->m, slope, view->w);
                if (!(facing > 0)) continue;
                const uint32_t block = mu_block(&c, i, j);
                facets.bottom[block]++;
                facets.top[block] += view->seen[upper][at];
                projected.bottom[block] += facing;
                projected.top[block] += facing * view->count[upper][at] / points;
                view->front_facing++;
                view->visible += view->seen[upper][at];
            }
    view->facet_mean = mu_blocks_ratio(&facets);
    view->projected = mu_blocks_ratio(&projected);
}

static _Bool allocate(mu_view *view, size_t cells) {
    for (int upper = 0; upper < 2; upper++) {
        view->seen[upper] = calloc(cells, sizeof *view->seen[upper]);
        view->count[upper] = calloc(cells, sizeof *view->count[upper]);
        if (!view->seen[upper] || !view->count[upper]) return 0;
    }
    return 1;
}

_Bool mu_measure(mu_measuring *s, mu_error *error) {
    const size_t cells = mu_cells(&s->f);
    uint32_t done = 0;
    uint8_t *spare = malloc(cells);
    _Bool good = spare || mu_fail(error, "not enough memory");
    double views[MU_MOST_VIEWS][3];
    for (uint32_t k = 0; k < s->view_count; k++) memcpy(views[k], s->views[k].w, sizeof views[k]);
    const mu_plan plan = {(const double(*)[3])views, s->view_count, s->side, s->threads};
    if (good && s->tracer->version) good = s->tracer->version(s->version, sizeof s->version, error);
    void *const surface = good ? s->tracer->open(&s->f, s->m, &plan, error) : NULL;
    good = surface != NULL;
    for (uint32_t k = 0; k < s->view_count && good; k++) {
        mu_view *view = &s->views[k];
        view->window = mu_surface_window(&s->f, s->open, s->m, view->w);
        if (view->window.i0 == view->window.i1 || view->window.j0 == view->window.j1)
            good = mu_fail(error,
                           "the view %g,%g,%g is so low that all its rays may leave the surface of %u x %u",
                           view->w[0], view->w[1], view->w[2], s->f.nx, s->f.ny);
        if (!good) break;
        good = allocate(view, cells) || mu_fail(error, "not enough memory for %u views", s->view_count);
        good = good && look_everywhere(s, surface, view, spare, &done, error);
        if (!good) break;
        forget_outside(s, view);
        add_up(s, view);
        if (s->bin_count) good = mu_measure_bins(s, view) || mu_fail(error, "not enough memory for bins");
    }
    if (surface) s->tracer->close(surface);
    free(spare);
    return good;
}

void mu_measure_free(mu_measuring *s) {
    for (uint32_t k = 0; k < s->view_count; k++) {
        free(s->views[k].bins);
        for (int upper = 0; upper < 2; upper++) {
            free(s->views[k].seen[upper]);
            free(s->views[k].count[upper]);
        }
    }
}

static uint32_t larger(uint32_t a, uint32_t b) {
    return a > b ? a : b;
}

static uint32_t smaller(uint32_t a, uint32_t b) {
    return a < b ? a : b;
}

void mu_measure_pair(const mu_measuring *s, mu_pair *pair) {
    const mu_view *a = &s->views[pair->a], *b = &s->views[pair->b];
    const mu_window c = {larger(a->window.i0, b->window.i0), smaller(a->window.i1, b->window.i1),
                         larger(a->window.j0, b->window.j0), smaller(a->window.j1, b->window.j1)};
    const uint32_t ny = s->f.ny;
    mu_blocks blocks = {0};
    pair->facing_both = pair->both_visible = 0;
    for (uint32_t i = c.i0; i < c.i1; i++)
        for (uint32_t j = c.j0; j < c.j1; j++)
            for (int upper = 0; upper < 2; upper++) {
                const size_t at = (size_t)i * ny + j;
                double slope[2];
                mu_facet_slope(&s->f, i, j, upper, slope);
                if (!(mu_facet_facing(s->m, slope, a->w) > 0 && mu_facet_facing(s->m, slope, b->w) > 0))
                    continue;
                const uint8_t both = a->seen[upper][at] & b->seen[upper][at];
                const uint32_t block = mu_block(&c, i, j);
                blocks.bottom[block]++;
                blocks.top[block] += both;
                pair->facing_both++;
                pair->both_visible += both;
            }
    pair->g2 = mu_blocks_ratio(&blocks);
}
