/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_through.c: light refracted once at the points that a view sees, on all threads, added up in one order. */
#include <math.h>
#include <stdlib.h>

#include "core/render/surface_rows.h"
#include "core/render/surface_statistics.h"
#include "core/surface/refract.h"

enum { ROWS = 64 }; /* refracted before they are added up */

/* weight: (v.m) A / ((v.n) A_macro), in facets, 0: nothing is seen; kept: 1 - F; end: MU_THROUGH_... of what is kept. */
typedef struct mu_passed {
    double weight, kept, normal[3], t[3];
    uint8_t end;
} mu_passed;

typedef struct mu_passing {
    const mu_gathering *g;
    const mu_heightfield *f;
    const mu_seen *seen;
    int upper;
    double point[2];
    uint32_t first;
    mu_passed *rays; /* ROWS x ny */
} mu_passing;

static void refract_row(void *context, uint32_t row) {
    const mu_passing *p = context;
    const mu_gathering *g = p->g;
    const uint32_t ny = p->f->ny, i = p->first + row;
    const double eta = g->reflectance.a[0], *w = p->seen->unit;
    for (uint32_t j = 0; j < ny; j++) {
        mu_passed *r = &p->rays[(size_t)row * ny + j];
        r->weight = 0;
        if (!p->seen->visible[(size_t)i * ny + j]) continue;
        r->weight = mu_facet_refract(p->f, g->m, w, eta, i, j, p->upper, r->normal, r->t) * 2 *
                    (double)mu_cells(p->f); /* of one facet: its own macro area, not the surface's */
        const double cosine = w[0] * r->normal[0] + w[1] * r->normal[1] + w[2] * r->normal[2];
        const mu_spot spot = {i, j, p->upper, p->point[0], p->point[1]};
        if (r->t[0] == 0 && r->t[1] == 0 && r->t[2] == 0) {
            r->kept = 0, r->end = MU_THROUGH_TOTAL;
            continue;
        }
        r->kept = 1 - mu_reflectance_at(&g->reflectance, 0, fmin(cosine, 1));
        r->end =
            mu_underside_sees(g->underside, p->f, g->m, &spot, r->t) ? MU_THROUGH_ESCAPED : MU_THROUGH_CAUGHT;
    }
}

static void add(mu_gathering *g, mu_seen *s, size_t unit, const mu_passed *r) {
    mu_through *through = &s->through;
    const double share = r->weight / ((double)g->side * g->side), light = share * r->kept,
                 radiance = light / (g->reflectance.a[0] * g->reflectance.a[0]);
    const double down[3] = {r->t[0], r->t[1], -r->t[2]};
    mu_ratios_add(&through->ends, unit, MU_THROUGH_REFLECTED, share - light);
    mu_ratios_add(&through->ends, unit, r->end, r->end == MU_THROUGH_TOTAL ? share : light);
    if (r->end != MU_THROUGH_ESCAPED) return;
    mu_ratios_add(&through->directions, unit, mu_directions_bin(&g->bins, down), radiance);
    for (uint32_t k = 0; k < g->lamp_count; k++)
        if (mu_lamp_below(&g->lamps[k]))
            mu_ratios_add(&through->lamps, unit, k, radiance * mu_lamp_radiance(&g->lamps[k], r->t));
    if (!through->groups) return;
    mu_group *group = &through->groups[mu_directions_bin(&g->finer, r->normal)];
    for (int k = 0; k < 3; k++) group->normal[k] += share * r->normal[k];
    group->weight += share;
}

_Bool mu_gathering_through(mu_gathering *g, uint32_t file, const mu_heightfield *f, mu_seen *seen, int upper,
                           const double point[2], mu_error *error) {
    mu_passing p = {g, f, seen, upper, {point[0], point[1]}, 0, NULL};
    p.rays = malloc((size_t)ROWS * f->ny * sizeof *p.rays);
    if (!p.rays) return mu_fail(error, "not enough memory to refract");
    for (p.first = 0; p.first < f->nx; p.first += ROWS) {
        const uint32_t rows = f->nx - p.first < ROWS ? f->nx - p.first : ROWS;
        mu_rows(rows, g->threads, refract_row, &p);
        for (uint32_t row = 0; row < rows; row++)
            for (uint32_t j = 0; j < f->ny; j++) {
                const mu_passed *r = &p.rays[(size_t)row * f->ny + j];
                if (r->weight > 0) add(g, seen, mu_gathering_unit(g, file, f, p.first + row, j), r);
            }
    }
    free(p.rays);
    return 1;
}

_Bool mu_through_make(const mu_gathering *g, mu_seen *s) {
    mu_through *through = &s->through;
    const size_t bins = mu_directions_count(&g->bins) + 1;
    _Bool good = mu_ratios_make(&through->ends, g->units, MU_THROUGHS, s->identity.top);
    good = mu_ratios_make(&through->directions, g->units, bins, s->identity.top) && good;
    good = mu_ratios_make(&through->lamps, g->units, g->lamp_count, s->identity.top) && good;
    if (g->lamp_count) through->groups = calloc(mu_directions_count(&g->finer) + 1, sizeof *through->groups);
    return good && (through->groups || !g->lamp_count);
}

void mu_through_free(mu_through *through) {
    mu_ratios_free(&through->ends), mu_ratios_free(&through->directions), mu_ratios_free(&through->lamps);
    free(through->groups);
}
