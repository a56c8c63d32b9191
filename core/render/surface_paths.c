/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_paths.c: paths of light from the points that a view sees, followed on all threads, added up in one order. */
#include <stdlib.h>

#include "core/render/surface_rows.h"
#include "core/render/surface_statistics.h"

enum { ROWS = 64 }; /* followed before they are added up */

/* What remains of a path once F is known. */
typedef struct mu_followed {
    double weight,
        left[3]; /* (v.m) A / ((v.n) A_macro), in facets; products of F; weight 0: nothing is seen */
    double normal[3], out[3];
    uint8_t end, count;
} mu_followed;

typedef struct mu_following {
    const mu_gathering *g;
    const mu_mirrors *mirrors;
    const mu_seen *seen;
    int upper;
    double point[2];
    uint32_t first;
    mu_followed *paths; /* ROWS x n */
} mu_following;

static void follow_row(void *context, uint32_t row) {
    const mu_following *t = context;
    const mu_gathering *g = t->g;
    const uint32_t ny = t->mirrors->f.ny, i = t->first + row;
    for (uint32_t j = 0; j < ny; j++) {
        mu_followed *p = &t->paths[(size_t)row * ny + j];
        mu_mirror_path path;
        double r[3];
        p->weight = 0;
        if (!t->seen->visible[(size_t)i * ny + j]) continue;
        const mu_spot spot = {i, j, t->upper, t->point[0], t->point[1]};
        const double weight =
            mu_facet_mirror(&t->mirrors->f, g->m, t->seen->unit, i, j, t->upper, p->normal, r);
        mu_mirror_follow(t->mirrors, &spot, t->seen->unit, g->bounces, &path);
        p->weight =
            weight * 2 *
            (double)mu_cells(&t->mirrors->f); /* of one facet: its own macro area, not the surface's */
        p->end = (uint8_t)path.end, p->count = (uint8_t)path.count;
        for (int k = 0; k < 3; k++) p->out[k] = path.out[k];
        for (int c = 0; c < mu_gathering_channels(g); c++) {
            p->left[c] = 1;
            for (uint32_t k = 0; k < path.count; k++)
                p->left[c] *= mu_reflectance_at(&g->reflectance, c, path.cosine[k]);
        }
    }
}

static void add(mu_gathering *g, mu_seen *s, size_t unit, const mu_followed *p) {
    static const int cell[] = {[MU_PATH_ESCAPED] = MU_END_ESCAPED,
                               [MU_PATH_OVER_LIMIT] = MU_END_OVER_LIMIT,
                               [MU_PATH_LOST] = MU_END_LOST};
    const double share = p->weight / ((double)g->side * g->side);
    const size_t bins = mu_directions_count(&g->bins) + 1;
    for (int c = 0; c < mu_gathering_channels(g); c++) {
        const double light = share * p->left[c];
        mu_ratios_add(&s->ends[c], unit, MU_END_ABSORBED, share * (1 - p->left[c]));
        mu_ratios_add(&s->ends[c], unit, (size_t)cell[p->end], light);
        if (p->end != MU_PATH_ESCAPED) continue;
        mu_ratios_add(&s->ends[c], unit, MU_ENDS + p->count - 1u, light);
        mu_ratios_add(&s->directions[c], unit, (p->count - 1u) * bins + mu_directions_bin(&g->bins, p->out),
                      light);
        for (uint32_t k = 0; k < g->lamp_count; k++) {
            const double shown = light * mu_lamp_radiance(&g->lamps[k], p->out);
            if (!(shown > 0)) continue;
            if (p->count == 1) mu_ratios_add(&s->lamps[c], unit, 2 * (size_t)k, shown);
            mu_ratios_add(&s->lamps[c], unit, 2 * (size_t)k + 1, shown);
        }
    }
    if (!s->groups || p->end != MU_PATH_ESCAPED || p->count != 1) return;
    mu_group *group = &s->groups[mu_directions_bin(&g->finer, p->normal)];
    for (int k = 0; k < 3; k++) group->normal[k] += share * p->normal[k];
    group->weight += share;
}

_Bool mu_gathering_paths(mu_gathering *g, uint32_t file, const mu_mirrors *mirrors, mu_seen *seen, int upper,
                         const double point[2], mu_error *error) {
    const uint32_t nx = mirrors->f.nx, ny = mirrors->f.ny;
    mu_following t = {g, mirrors, seen, upper, {point[0], point[1]}, 0, NULL};
    t.paths = malloc((size_t)ROWS * ny * sizeof *t.paths);
    if (!t.paths) return mu_fail(error, "not enough memory to follow paths");
    for (t.first = 0; t.first < nx; t.first += ROWS) {
        const uint32_t rows = nx - t.first < ROWS ? nx - t.first : ROWS;
        mu_rows(rows, g->threads, follow_row, &t);
        for (uint32_t row = 0; row < rows; row++)
            for (uint32_t j = 0; j < ny; j++) {
                const mu_followed *p = &t.paths[(size_t)row * ny + j];
                if (p->weight > 0) add(g, seen, mu_gathering_unit(g, file, &mirrors->f, t.first + row, j), p);
            }
    }
    free(t.paths);
    return 1;
}
