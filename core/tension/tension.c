/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * tension.c: M of all triangles, the places and points where they meet, and what is left once all points have their M.
 *
 * A triangle counts as inverted if its normal agrees with the normals around it at rest, and opposes them deformed; those
 * are sums over the triangles at its three corners, weighted by angle. Its own M is measured on its own side either way.
 */
#include "core/tension/tension.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/tension/face.h"
#include "core/tension/index.h"
#include "core/tension/points.h"
#include "core/tension/stretch.h"

/* Below this, the cosine to the normals around says nothing: sheets with two sides back to back. */
#define MU_SIDE 1e-3

typedef struct mu_build {
    const mu_tension_input *in;
    mu_tension *out;
    uint32_t *place;  /* per vertex */
    uint32_t *latest; /* per place: the point that a corner was last found to be */
    double *normals;  /* per place: rest, deformed */
    mu_part *part;
    mu_chart_point *points;
    mu_index places, indexed;
    uint32_t room; /* of points */
} mu_build;

static _Bool number_places(mu_build *b) {
    const mu_tension_input *in = b->in;
    if (!mu_index_make(&b->places, 6, in->vertices)) return 0;
    for (uint32_t i = 0; i < in->vertices; i++) {
        uint64_t key[6];
        for (size_t k = 0; k < 3; k++) {
            key[k] = mu_index_word(in->rest[3 * (size_t)i + k]);
            key[3 + k] = mu_index_word(in->deformed[3 * (size_t)i + k]);
        }
        b->place[i] = mu_index_of(&b->places, key);
    }
    return 1;
}

static _Bool grow(mu_build *b) {
    const uint32_t room = b->room < UINT32_MAX / 2 ? 2 * b->room + 64 : UINT32_MAX;
    mu_tension_point *points = realloc(b->out->point, room * sizeof *points);
    if (points) b->out->point = points;
    mu_chart_point *more = realloc(b->points, room * sizeof *more);
    if (more) b->points = more;
    b->room = room;
    return points && more;
}

/* Whether the corner has the point's chart and texture coordinates; false also where these are not numbers. */
static _Bool is_same(const mu_build *b, uint32_t point, size_t corner, int chart) {
    const double *const uvs[2] = {b->in->rest_uv, b->in->deformed_uv};
    const size_t first = b->points[point].corner;
    for (size_t k = 0; k < 4; k++)
        if (uvs[k / 2] && uvs[k / 2][2 * first + k % 2] != uvs[k / 2][2 * corner + k % 2]) return 0;
    return b->points[point].chart == chart;
}

static _Bool point_of(mu_build *b, uint32_t triangle, size_t corner, int chart, uint32_t *number) {
    const size_t at = 3 * (size_t)triangle + corner;
    const uint32_t vertex = b->in->corner[at];
    const double *const uvs[2] = {b->in->rest_uv, b->in->deformed_uv};
    uint32_t *latest = &b->latest[b->place[vertex]];
    if (*latest != MU_NO_POINT && is_same(b, *latest, at, chart)) return *number = *latest, 1; /* most are */
    uint64_t key[5] = {(uint64_t)b->place[vertex] << 4 | (uint64_t)chart};
    for (size_t k = 0; k < 4; k++) key[1 + k] = mu_index_word(uvs[k / 2] ? uvs[k / 2][2 * at + k % 2] : 0);
    *number = mu_index_of(&b->indexed, key);
    if (*number == UINT32_MAX) return 0;
    *latest = *number;
    if (*number < b->out->points) return 1;
    if (b->out->points == b->room && !grow(b)) return 0;
    b->points[*number] = (mu_chart_point){.corner = (uint32_t)at, .chart = chart};
    b->out->point[*number] = (mu_tension_point){.vertex = vertex, .triangle = triangle, .m = {1, 0, 0, 1}};
    b->out->points++;
    return 1;
}

static void add_normals(mu_build *b, const uint32_t *corner, const mu_tension_face *face) {
    for (size_t k = 0; k < 3; k++) {
        double *n = b->normals + 6 * (size_t)b->place[corner[k]];
        for (size_t i = 0; i < 3; i++) {
            n[i] += face->rest_angle[k] * face->rest_n[i];
            n[3 + i] += face->deformed_angle[k] * face->deformed_n[i];
        }
    }
}

/* A triangle without M weighs nothing. */
static mu_part part_of(const mu_tension_face *face) {
    mu_part part = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    if (!face->usable) return part;
    const mu_stretch_log log = mu_stretch_log_of(face->m);
    part.log[0] = log.xx, part.log[1] = log.xy, part.log[2] = log.yy;
    memcpy(part.weight, face->weight, sizeof part.weight);
    memcpy(part.n, face->rest_n, sizeof part.n);
    memcpy(part.t, face->rest_t, sizeof part.t);
    return part;
}

static _Bool make_faces(mu_build *b) {
    mu_tension *out = b->out;
    for (uint32_t t = 0; t < b->in->triangles; t++) {
        const mu_tension_face face = mu_tension_face_of(b->in, t, &out->counts);
        add_normals(b, b->in->corner + 3 * (size_t)t, &face);
        b->part[t] = part_of(&face);
        for (size_t k = 0; k < 3; k++)
            if (!point_of(b, t, k, face.chart, out->corner + 3 * (size_t)t + k)) return 0;
        if (face.usable) memcpy(out->face + 4 * (size_t)t, face.m, sizeof face.m);
    }
    return 1;
}

static int side(const mu_build *b, const uint32_t *corner, const double n[3], size_t which) {
    double sum[3] = {0, 0, 0}, along = 0, length = 0;
    for (size_t k = 0; k < 3; k++)
        for (size_t i = 0; i < 3; i++) sum[i] += b->normals[6 * (size_t)b->place[corner[k]] + which + i];
    for (size_t i = 0; i < 3; i++) along += n[i] * sum[i], length += sum[i] * sum[i];
    return fabs(along) > MU_SIDE * sqrt(length) ? (along > 0) - (along < 0) : 0;
}

/* The mean of the points that have an M. */
static void mean_of_corners(const mu_build *b, const uint32_t *point, double m[4]) {
    mu_stretch_log sum = {0, 0, 0, 0, 0};
    const double *first = NULL;
    _Bool differ = 0;
    double count = 0;
    m[0] = m[3] = 1, m[1] = m[2] = 0;
    for (size_t k = 0; k < 3; k++) {
        if (!b->points[point[k]].has_m) continue;
        const double *own = b->out->point[point[k]].m;
        const mu_stretch_log log = mu_stretch_log_of(own);
        sum.xx += log.xx, sum.xy += log.xy, sum.yy += log.yy, sum.turn_x += log.turn_x,
            sum.turn_y += log.turn_y;
        differ |= first && memcmp(first, own, 4 * sizeof *own);
        first = first ? first : own, count++;
    }
    if (!first) return;
    sum.xx /= count, sum.xy /= count, sum.yy /= count;
    if (differ)
        mu_stretch_matrix(&sum, m);
    else
        memcpy(m, first, 4 * sizeof *m);
}

/* Triangles without M of their own, and those turned over. */
static void finish_faces(mu_build *b) {
    for (uint32_t t = 0; t < b->in->triangles; t++) {
        const uint32_t *corner = b->in->corner + 3 * (size_t)t;
        mu_shape deformed;
        if (!(b->part[t].weight[0] > 0))
            mean_of_corners(b, b->out->corner + 3 * (size_t)t, b->out->face + 4 * (size_t)t);
        else if (mu_tension_shape(b->in, b->in->deformed, t, &deformed))
            b->out->counts.inverted +=
                side(b, corner, b->part[t].n, 0) > 0 && side(b, corner, deformed.n, 3) < 0;
    }
    for (uint32_t p = 0; p < b->out->points; p++) b->out->counts.points_without += !b->points[p].has_m;
}

/* The first point at each vertex' place. */
static _Bool finish_vertices(mu_build *b) {
    mu_tension *out = b->out;
    uint32_t *first = malloc(((size_t)b->places.count + 1) * sizeof *first);
    if (!first) return 0;
    memset(first, 0xff, ((size_t)b->places.count + 1) * sizeof *first);
    for (uint32_t p = out->points; p-- > 0;) first[b->place[out->point[p].vertex]] = p;
    for (uint32_t i = 0; i < b->in->vertices; i++) {
        out->vertex[i] = first[b->place[i]];
        out->counts.points_without += out->vertex[i] == UINT32_MAX;
    }
    free(first);
    return 1;
}

static _Bool make_points(mu_build *b) {
    mu_ground ground = {
        .in = b->in, .tension = b->out, .place = b->place, .part = b->part, .places = b->places.count};
    mu_index_free(&b->indexed); /* large, and not needed any more */
    const _Bool good = mu_ground_make(&ground) && mu_points_finish(&ground, b->normals, b->points, b->out);
    mu_ground_free(&ground);
    return good;
}

static _Bool build(mu_build *b) {
    mu_tension *out = b->out;
    const size_t triangles = b->in->triangles, vertices = b->in->vertices;
    out->face = calloc(4 * triangles + 1, sizeof *out->face);
    out->corner = calloc(3 * triangles + 1, sizeof *out->corner);
    out->vertex = calloc(vertices + 1, sizeof *out->vertex);
    b->place = malloc((vertices + 1) * sizeof *b->place);
    b->part = malloc((triangles + 1) * sizeof *b->part);
    if (!out->face || !out->corner || !out->vertex || !b->place || !b->part || !number_places(b)) return 0;
    b->normals = calloc(6 * (size_t)b->places.count + 1, sizeof *b->normals);
    b->latest = malloc(((size_t)b->places.count + 1) * sizeof *b->latest);
    if (b->latest) memset(b->latest, 0xff, ((size_t)b->places.count + 1) * sizeof *b->latest);
    if (!b->normals || !b->latest || triangles > UINT32_MAX / 3 ||
        !mu_index_make(&b->indexed, 5, b->places.count + b->places.count / 8))
        return 0;
    if (!make_faces(b) || !make_points(b)) return 0;
    finish_faces(b);
    return finish_vertices(b);
}

mu_tension *mu_tension_make(const mu_tension_input *input) {
    mu_build b = {.in = input, .out = calloc(1, sizeof *b.out)};
    if (!b.out) return NULL;
    if (!build(&b)) {
        mu_tension_free(b.out);
        b.out = NULL;
    }
    mu_index_free(&b.places);
    mu_index_free(&b.indexed);
    free(b.place);
    free(b.latest);
    free(b.normals);
    free(b.part);
    free(b.points);
    return b.out;
}

void mu_tension_free(mu_tension *tension) {
    if (!tension) return;
    free(tension->face);
    free(tension->corner);
    free(tension->point);
    free(tension->vertex);
    free(tension);
}
