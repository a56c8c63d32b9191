/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * polygons_cut.c: a face becomes triangles by clipping ears (Meisters, "Polygons have ears", 1975), in the plane of its
 * area vector (Newell's). An ear is a convex corner whose triangle holds no other corner.
 */
#include <stdlib.h>
#include <string.h>

#include "core/render/affine.h"
#include "core/render/polygons.h"

typedef struct mu_outline {
    const mu_polygons *mesh;
    mu_dvec3 normal; /* of any length */
    uint32_t *corner;
    uint32_t left;
} mu_outline;

static mu_dvec3 place(const mu_outline *o, uint32_t i) {
    const double *p = o->mesh->position + 3 * (size_t)o->mesh->vertex[o->corner[i]];
    return mu_d3(p[0], p[1], p[2]);
}

/* Positive where a, b, c turn counter-clockwise. */
static double turn(const mu_outline *o, mu_dvec3 a, mu_dvec3 b, mu_dvec3 c) {
    return mu_ddot(o->normal, mu_dcross(mu_dsub(b, a), mu_dsub(c, a)));
}

static _Bool is_empty(const mu_outline *o, uint32_t before, uint32_t at, uint32_t after) {
    const mu_dvec3 a = place(o, before), b = place(o, at), c = place(o, after);
    for (uint32_t i = 0; i < o->left; i++) {
        if (i == before || i == at || i == after) continue;
        const mu_dvec3 p = place(o, i);
        if (turn(o, a, b, p) >= 0 && turn(o, b, c, p) >= 0 && turn(o, c, a, p) >= 0) return 0;
    }
    return 1;
}

/* The first ear from corner 1 on, so that convex faces become fans around corner 0. */
static uint32_t find_ear(const mu_outline *o) {
    for (uint32_t k = 0; k < o->left; k++) {
        const uint32_t at = (k + 1) % o->left, before = k, after = (k + 2) % o->left;
        if (turn(o, place(o, before), place(o, at), place(o, after)) > 0 && is_empty(o, before, at, after))
            return at;
    }
    return 1;
}

void mu_polygons_cut(const mu_polygons *polygons, uint32_t face, uint32_t *scratch, uint32_t *triangles) {
    mu_outline o = {.mesh = polygons, .corner = scratch, .normal = {0, 0, 0}};
    const uint32_t first = polygons->first[face];
    o.left = polygons->first[face + 1] - first;
    for (uint32_t i = 0; i < o.left; i++) scratch[i] = first + i;
    for (uint32_t i = 1; i + 1 < o.left; i++)
        o.normal = mu_dadd(o.normal, mu_dcross(mu_dsub(place(&o, i), place(&o, 0)),
                                               mu_dsub(place(&o, i + 1), place(&o, 0))));
    for (; o.left > 3; o.left--) {
        const uint32_t ear = find_ear(&o);
        *triangles++ = scratch[ear ? ear - 1 : o.left - 1];
        *triangles++ = scratch[ear];
        *triangles++ = scratch[(ear + 1) % o.left];
        memmove(scratch + ear, scratch + ear + 1, (o.left - ear - 1) * sizeof *scratch);
    }
    memcpy(triangles, scratch, 3 * sizeof *scratch);
}

uint32_t *mu_polygons_cut_all(const mu_polygons *polygons, uint32_t *triangles) {
    uint32_t scratch[MU_POLYGON_MOST];
    *triangles = polygons->corners - 2 * polygons->faces;
    uint32_t *const corners = malloc((3 * (size_t)*triangles + 1) * sizeof *corners), *at = corners;
    for (uint32_t f = 0; corners && f < polygons->faces; f++) {
        mu_polygons_cut(polygons, f, scratch, at);
        at += 3 * (size_t)(polygons->first[f + 1] - polygons->first[f] - 2);
    }
    return corners;
}
