/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* site.c: see site.h. */
#include "core/tension/site.h"

#include <math.h>
#include <string.h>

#include "core/tension/stretch.h"

void mu_site_turn(const double log[3], const double turn[2], double out[3]) {
    const double cos2 = turn[0] * turn[0] - turn[1] * turn[1], sin2 = 2 * turn[0] * turn[1];
    const double mean = (log[0] + log[2]) / 2, d = (log[0] - log[2]) / 2, o = log[1];
    out[0] = mean + d * cos2 + o * sin2;
    out[1] = o * cos2 - d * sin2;
    out[2] = mean - d * cos2 - o * sin2;
}

void mu_site_turned(const mu_plane *plane, const mu_part *part, double turn[2]) {
    const double *n = plane->n, *t = part->t;
    const double lean = mu_shape_dot(n, t) / (1 + mu_shape_dot(n, part->n));
    double turned[3];
    for (int k = 0; k < 3; k++) turned[k] = t[k] - lean * (n[k] + part->n[k]);
    turn[0] = mu_shape_dot(turned, plane->s1), turn[1] = mu_shape_dot(turned, plane->s2);
}

/* Along the edge from a corner to the next. */
static void put_axes(const mu_ground *g, uint32_t corner, mu_plane *plane) {
    const uint32_t next = corner - corner % 3 + (corner + 1) % 3;
    const double *p = g->in->rest + 3 * (size_t)g->in->corner[corner],
                 *q = g->in->rest + 3 * (size_t)g->in->corner[next];
    double along[3], size = 0;
    for (int k = 0; k < 3; k++) along[k] = q[k] - p[k];
    const double up = mu_shape_dot(along, plane->n);
    for (int k = 0; k < 3; k++) along[k] -= up * plane->n[k], size += along[k] * along[k];
    for (int k = 0; k < 3; k++) plane->s1[k] = along[k] / sqrt(size);
    mu_shape_cross(plane->n, plane->s1, plane->s2);
}

_Bool mu_site_plane(const mu_ground *g, uint32_t place, const double normal[3], uint32_t own, _Bool whole,
                    mu_plane *plane) {
    const double length = sqrt(mu_shape_dot(normal, normal));
    _Bool found = 0;
    if (!(length > 0)) return 0;
    for (int k = 0; k < 3; k++) plane->n[k] = normal[k] / length;
    for (uint32_t p = mu_ground_begin(g, place, own); p != MU_NO_POINT; p = mu_ground_next(g, own, p))
        for (uint32_t i = g->first[p]; i < g->first[p + 1]; i++) {
            const mu_part *part = &g->part[g->corner[i] / 3];
            if (!(part->weight[0] > 0)) continue;
            const _Bool faces = mu_part_faces(part, plane->n);
            if (faces && !found) put_axes(g, g->corner[i], plane);
            if (!faces && whole) return 0;
            found |= faces;
        }
    return found;
}

/* log U of a triangle in the site's frame. */
static void part_log(const mu_site *site, const mu_part *part, double out[3]) {
    double turn[2];
    memcpy(out, part->log, sizeof part->log);
    if (!site->flat) return;
    mu_site_turned(&site->plane, part, turn);
    turn[1] = -turn[1];
    mu_site_turn(part->log, turn, out);
}

/* Without a plane the u directions stand for it, which only one chart has. */
static void find_mean(const mu_ground *g, uint32_t place, uint32_t own, mu_site *site) {
    const double *n = site->flat ? site->plane.n : NULL;
    const uint32_t which = n ? MU_NO_POINT : own;
    double sum[3] = {0, 0, 0}, weight = 0;
    for (uint32_t p = mu_ground_begin(g, place, which); p != MU_NO_POINT; p = mu_ground_next(g, which, p))
        for (uint32_t i = g->first[p]; i < g->first[p + 1]; i++) {
            const uint32_t corner = g->corner[i];
            const mu_part *part = &g->part[corner / 3];
            double log[3];
            if (!mu_part_faces(part, n)) continue;
            part_log(site, part, log);
            for (int k = 0; k < 3; k++) sum[k] += part->weight[corner % 3] * log[k];
            weight += part->weight[corner % 3];
        }
    for (int k = 0; k < 3; k++) site->log[k] = sum[k] / weight;
}

/* Tangents of the highest degree that the patch of one ring or, if needed, of two gives. */
static _Bool find_tangents(mu_ground *g, uint32_t place, uint32_t centre, const double *uvs, mu_site *site) {
    double slope[MU_QUADRIC_VALUES][2];
    mu_quadric fit;
    for (site->rings = 1; !site->degree && site->rings <= 2; site->rings += !site->degree) {
        if (!mu_patch_collect(g, place, site->plane.n, MU_NO_POINT, site->rings)) return 0;
        mu_quadric_fit(g, &site->plane, centre, uvs, &fit);
        if (mu_quadric_slopes(&fit, 2, site->rings > 1 ? MU_QUADRIC_WIDE : MU_QUADRIC_NEAR, slope))
            site->degree = 2;
    }
    if (!site->degree) {
        site->rings = 2;
        if (!mu_quadric_slopes(&fit, 1, MU_QUADRIC_WIDE, slope)) return 1;
        site->degree = 1;
    }
    double rest[2][3], deformed[2][3];
    for (int k = 0; k < 3; k++) {
        rest[0][k] = site->plane.s1[k] + slope[MU_QUADRIC_H][0] * site->plane.n[k];
        rest[1][k] = site->plane.s2[k] + slope[MU_QUADRIC_H][1] * site->plane.n[k];
        for (int c = 0; c < 2; c++) deformed[c][k] = slope[MU_QUADRIC_Q + k][c];
    }
    memcpy(site->slope, slope[MU_QUADRIC_V], sizeof site->slope);
    if (!mu_shape_make(&site->rest, rest[0], rest[1]) ||
        !mu_shape_make(&site->deformed, deformed[0], deformed[1]))
        site->degree = 0;
    return 1;
}

static double distance(const double a[3], const double b[3]) {
    const double xx = a[0] - b[0], xy = a[1] - b[1], yy = a[2] - b[2];
    return sqrt(xx * xx + 2 * xy * xy + yy * yy);
}

/* What the triangles of the last patch have in common. */
static const double *common(const mu_ground *g) {
    const double *first = g->count ? g->tension->face + 4 * (size_t)g->face[0] : NULL;
    for (uint32_t i = 1; i < g->count; i++)
        if (memcmp(first, g->tension->face + 4 * (size_t)g->face[i], 4 * sizeof *first)) return NULL;
    return first;
}

/* How far they are from the mean, or one that is far enough. */
static double farthest(const mu_ground *g, const mu_site *site, double enough) {
    double most = 0;
    for (uint32_t i = 0; i < g->count && most < enough; i++) {
        double log[3];
        part_log(site, &g->part[g->face[i]], log);
        most = fmax(most, distance(log, site->log));
    }
    return most;
}

_Bool mu_site_make(mu_ground *g, uint32_t place, uint32_t own, uint32_t centre, const double *uvs,
                   mu_site *site) {
    static const double first[2] = {1, 0};
    double m[4];
    site->degree = 0;
    find_mean(g, place, own, site);
    if (!(site->flat ? find_tangents(g, place, centre, uvs, site) : mu_patch_collect(g, place, NULL, own, 1)))
        return 0;
    site->same = common(g);
    if (site->degree < 2 || site->same) return 1;
    mu_shape_map(&site->rest, first, &site->deformed, first, m);
    const mu_stretch_log log = mu_stretch_log_of(m);
    const double fitted[3] = {log.xx, log.xy, log.yy}, off = distance(fitted, site->log);
    double most = farthest(g, site, off);
    if (most < off && site->rings == 1) { /* at a border triangles are all on one side of the place */
        if (!mu_patch_collect(g, place, site->plane.n, MU_NO_POINT, 2)) return 0;
        most = farthest(g, site, off);
    }
    for (int k = 0; k < 3; k++)
        site->log[k] += fmin(1, off > 0 ? most / off : 1) * (fitted[k] - site->log[k]);
    return 1;
}
