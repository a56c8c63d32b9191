/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * tension.c: M of all triangles, and the means at the points where they meet.
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
#include "core/tension/stretch.h"

/* Below this, the cosine to the normals around says nothing: sheets with two sides back to back. */
#define MU_SIDE 1e-3

typedef struct mu_sum { /* of a point */
    mu_stretch_log log;
    double weight;
    _Bool differ; /* not all have the first one's M: else the mean is that, exactly */
} mu_sum;

typedef struct mu_build {
    const mu_tension_input *in;
    mu_tension *out;
    uint32_t *place; /* per vertex */
    double *normals; /* per place: rest, deformed */
    mu_sum *sums;    /* per point */
    mu_index places, points;
    uint32_t room; /* of points and sums */
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
    mu_sum *sums = realloc(b->sums, room * sizeof *sums);
    if (sums) b->sums = sums;
    b->room = room;
    return points && sums;
}

static _Bool point_of(mu_build *b, uint32_t triangle, size_t corner, int chart, uint32_t *number) {
    const size_t at = 3 * (size_t)triangle + corner;
    const uint32_t vertex = b->in->corner[at];
    const double *const uvs[2] = {b->in->rest_uv, b->in->deformed_uv};
    uint64_t key[5] = {(uint64_t)b->place[vertex] << 4 | (uint64_t)chart};
    for (size_t k = 0; k < 4; k++) key[1 + k] = mu_index_word(uvs[k / 2] ? uvs[k / 2][2 * at + k % 2] : 0);
    *number = mu_index_of(&b->points, key);
    if (*number < b->out->points) return 1;
    if (b->out->points == b->room && !grow(b)) return 0;
    b->sums[*number] = (mu_sum){.weight = 0};
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

/* `m` holds the first one's M meanwhile. */
static void add_to_sum(mu_sum *sum, double m[4], const double added[4], double weight) {
    const mu_stretch_log log = mu_stretch_log_of(added);
    if (!(sum->weight > 0)) memcpy(m, added, 4 * sizeof *m);
    for (int k = 0; k < 4; k++) sum->differ |= m[k] != added[k];
    sum->log.xx += weight * log.xx, sum->log.xy += weight * log.xy, sum->log.yy += weight * log.yy;
    sum->log.turn_x += weight * log.turn_x, sum->log.turn_y += weight * log.turn_y;
    sum->weight += weight;
}

static _Bool sum_up(mu_build *b) {
    mu_tension *out = b->out;
    for (uint32_t t = 0; t < b->in->triangles; t++) {
        const mu_tension_face face = mu_tension_face_of(b->in, t, &out->counts);
        uint32_t *point = out->corner + 3 * (size_t)t;
        add_normals(b, b->in->corner + 3 * (size_t)t, &face);
        for (size_t k = 0; k < 3; k++)
            if (!point_of(b, t, k, face.chart, &point[k])) return 0;
        if (!face.usable) continue;
        memcpy(out->face + 4 * (size_t)t, face.m, sizeof face.m);
        for (size_t k = 0; k < 3; k++)
            add_to_sum(&b->sums[point[k]], out->point[point[k]].m, face.m, face.weight[k]);
    }
    return 1;
}

/* The mean; false if there is nothing to take it of, which leaves M. */
static _Bool mean(const mu_sum *sum, double m[4]) {
    if (!(sum->weight > 0)) return 0;
    if (!sum->differ) return 1;
    const double w = sum->weight;
    const mu_stretch_log log = {sum->log.xx / w, sum->log.xy / w, sum->log.yy / w, sum->log.turn_x / w,
                                sum->log.turn_y / w};
    mu_stretch_matrix(&log, m);
    return 1;
}

static int side(const mu_build *b, const uint32_t *corner, const double n[3], size_t which) {
    double sum[3] = {0, 0, 0}, along = 0, length = 0;
    for (size_t k = 0; k < 3; k++)
        for (size_t i = 0; i < 3; i++) sum[i] += b->normals[6 * (size_t)b->place[corner[k]] + which + i];
    for (size_t i = 0; i < 3; i++) along += n[i] * sum[i], length += sum[i] * sum[i];
    return fabs(along) > MU_SIDE * sqrt(length) ? (along > 0) - (along < 0) : 0;
}

/* What is left once all sums are complete: triangles without M of their own, and those turned over. */
static void finish_faces(mu_build *b) {
    mu_tension_counts ignored = {0};
    for (uint32_t t = 0; t < b->in->triangles; t++) {
        const mu_tension_face face = mu_tension_face_of(b->in, t, &ignored);
        const uint32_t *corner = b->in->corner + 3 * (size_t)t, *point = b->out->corner + 3 * (size_t)t;
        double *m = b->out->face + 4 * (size_t)t;
        if (face.usable) {
            b->out->counts.inverted +=
                side(b, corner, face.rest_n, 0) > 0 && side(b, corner, face.deformed_n, 3) < 0;
            continue;
        }
        mu_sum all = {.weight = 0};
        m[0] = m[3] = 1;
        for (size_t k = 0; k < 3; k++) {
            if (!(b->sums[point[k]].weight > 0)) continue;
            add_to_sum(&all, m, b->out->point[point[k]].m, 1);
        }
        mean(&all, m);
    }
}

static void finish_points(mu_build *b) {
    mu_tension *out = b->out;
    for (uint32_t p = 0; p < out->points; p++)
        if (!mean(&b->sums[p], out->point[p].m)) out->counts.points_without++;
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

static _Bool build(mu_build *b) {
    mu_tension *out = b->out;
    const size_t triangles = b->in->triangles, vertices = b->in->vertices;
    out->face = calloc(4 * triangles + 1, sizeof *out->face);
    out->corner = calloc(3 * triangles + 1, sizeof *out->corner);
    out->vertex = calloc(vertices + 1, sizeof *out->vertex);
    b->place = malloc((vertices + 1) * sizeof *b->place);
    if (!out->face || !out->corner || !out->vertex || !b->place || !number_places(b)) return 0;
    b->normals = calloc(6 * (size_t)b->places.count + 1, sizeof *b->normals);
    if (!b->normals || triangles > UINT32_MAX / 3 || !mu_index_make(&b->points, 5, (uint32_t)(3 * triangles)))
        return 0;
    if (!sum_up(b)) return 0;
    finish_points(b);
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
    mu_index_free(&b.points);
    free(b.place);
    free(b.normals);
    free(b.sums);
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
