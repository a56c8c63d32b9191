/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * points.c: place after place. Where all triangles face the sum of their normals, a place is one site, whatever the
 * texture's seams through it; else, on sharp edges and on sheets back to back, each point has a site of its own.
 */
#include "core/tension/points.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/tension/direction.h"
#include "core/tension/face.h"
#include "core/tension/stretch.h"

typedef struct mu_place_points {
    mu_ground *ground;
    mu_chart_point *points;
    mu_tension *out;
    uint32_t place, first; /* its first point */
} mu_place_points;

/* Whether triangles give the point an M; their weights, and the normal they have together. */
static void gather(const mu_place_points *p, uint32_t point, double normal[3]) {
    const mu_ground *g = p->ground;
    mu_chart_point *own = &p->points[point];
    memset(normal, 0, 3 * sizeof *normal);
    own->weight = 0;
    for (uint32_t i = g->first[point]; i < g->first[point + 1]; i++) {
        const mu_part *part = &g->part[g->corner[i] / 3];
        const double weight = part->weight[g->corner[i] % 3];
        own->weight += weight;
        for (int k = 0; k < 3; k++) normal[k] += weight * part->n[k];
    }
    own->has_m = own->weight > 0;
}

/* The turn between the u directions of the two textures, the mean of the point's triangles. */
static void find_turn(const mu_place_points *p, uint32_t point, mu_stretch_log *log) {
    const mu_ground *g = p->ground;
    log->turn_x = 1, log->turn_y = 0;
    if (!p->out->counts.uv_changed) return;
    log->turn_x = 0;
    for (uint32_t i = g->first[point]; i < g->first[point + 1]; i++) {
        const uint32_t corner = g->corner[i];
        const double *m = p->out->face + 4 * (size_t)(corner / 3),
                     weight = g->part[corner / 3].weight[corner % 3], length = hypot(m[0], m[2]);
        if (!(weight > 0)) continue;
        log->turn_x += weight * m[0] / length, log->turn_y += weight * m[2] / length;
    }
}

static void finish_point(const mu_place_points *p, uint32_t point, const mu_site *site) {
    const mu_chart_point *own = &p->points[point];
    mu_tension_point *out = &p->out->point[point];
    double seen[3];
    mu_site_turn(site->log, own->direction, seen);
    mu_stretch_log log = {seen[0], seen[1], seen[2], 1, 0};
    find_turn(p, point, &log);
    if (site->same)
        memcpy(out->m, site->same, sizeof out->m);
    else
        mu_stretch_matrix(&log, out->m);
}

/* Charts that agree share the mean of their directions. */
static void share_directions(const mu_place_points *p) {
    for (uint32_t i = p->first; i != MU_NO_POINT; i = p->ground->next[i]) {
        mu_chart_point *a = &p->points[i];
        double sum[2] = {0, 0};
        for (uint32_t j = p->first; j != MU_NO_POINT && a->has_m; j = p->ground->next[j]) {
            const mu_chart_point *b = &p->points[j];
            const double cosine = a->direction[0] * b->direction[0] + a->direction[1] * b->direction[1];
            if (!b->has_m || a->chart != b->chart || !(cosine > 0.5)) continue;
            for (int k = 0; k < 2; k++) sum[k] += b->weight * b->direction[k];
        }
        const double size = hypot(sum[0], sum[1]);
        for (int k = 0; k < 2; k++) a->shared[k] = sum[k] / size;
    }
    for (uint32_t i = p->first; i != MU_NO_POINT; i = p->ground->next[i])
        if (p->points[i].has_m)
            memcpy(p->points[i].direction, p->points[i].shared, sizeof p->points[i].shared);
}

/* All points of the place see one site. */
static _Bool finish_together(const mu_place_points *p, _Bool crowded, mu_site *site) {
    const mu_chart_point *first = &p->points[p->first];
    const _Bool alone = p->ground->next[p->first] == MU_NO_POINT;
    if (!mu_site_make(p->ground, p->place, MU_NO_POINT, first->corner,
                      alone ? mu_direction_uvs(p->ground->in, first->chart) : NULL, site))
        return 0;
    for (uint32_t i = p->first; i != MU_NO_POINT; i = p->ground->next[i]) {
        mu_chart_point *point = &p->points[i];
        if (point->has_m &&
            !mu_direction_find(p->ground, i, point->corner, point->chart, alone, site, point->direction))
            return 0;
    }
    if (!alone) site->same = NULL;
    if (!alone && !crowded) share_directions(p);
    for (uint32_t i = p->first; i != MU_NO_POINT; i = p->ground->next[i])
        if (p->points[i].has_m) finish_point(p, i, site);
    return 1;
}

/* In a crowd only its own triangles count, for the time that others would take. */
static _Bool finish_alone(const mu_place_points *p, uint32_t i, _Bool crowded, const double normal[3]) {
    mu_chart_point *point = &p->points[i];
    mu_site site;
    site.flat = !crowded && mu_site_plane(p->ground, p->place, normal, i, 0, &site.plane);
    if (!mu_site_make(p->ground, p->place, i, point->corner, NULL, &site) ||
        !mu_direction_find(p->ground, i, point->corner, point->chart, 0, &site, point->direction))
        return 0;
    finish_point(p, i, &site);
    return 1;
}

static _Bool finish_place(const mu_place_points *p, const double normal[3]) {
    mu_site site;
    double own[3];
    _Bool any = 0;
    uint32_t count = 0;
    for (uint32_t i = p->first; i != MU_NO_POINT; i = p->ground->next[i], count++) {
        gather(p, i, own);
        any |= p->points[i].has_m;
    }
    const _Bool crowded = count > MU_CROWD;
    if (!any) return 1;
    site.flat = mu_site_plane(p->ground, p->place, normal, MU_NO_POINT, 1, &site.plane);
    if (site.flat) return finish_together(p, crowded, &site);
    for (uint32_t i = p->first; i != MU_NO_POINT; i = p->ground->next[i]) {
        if (!p->points[i].has_m) continue;
        gather(p, i, own);
        if (!finish_alone(p, i, crowded, own)) return 0;
    }
    return 1;
}

_Bool mu_points_finish(mu_ground *ground, const double *normals, mu_chart_point *points, mu_tension *out) {
    mu_place_points p = {.ground = ground, .points = points, .out = out};
    _Bool good = 1;
    for (p.place = 0; good && p.place < ground->places; p.place++) {
        p.first = ground->head[p.place];
        if (p.first != MU_NO_POINT) good = finish_place(&p, normals + 6 * (size_t)p.place);
    }
    return good;
}
