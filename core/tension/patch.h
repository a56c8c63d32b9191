/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * patch.h: the triangles around a place: those that meet there, or these and their neighbours.
 *
 * Triangles without M, and those whose normal at rest turns by more than 60 degrees from a given one, are none of them:
 * they would be seen too slanted in its plane.
 */
#ifndef MU_TENSION_PATCH_H
#define MU_TENSION_PATCH_H

#include "core/tension/tension.h"

#define MU_NO_POINT UINT32_MAX
/* Triangles or points at one place beyond which pairs of them are too many to look at: poles. */
#define MU_CROWD 64

/* What is kept of a triangle: log U in the frame of its u direction, weights of its corners (0: it has no M), normal and
 * u direction at rest. */
typedef struct mu_part {
    double log[3], weight[3], n[3], t[3];
} mu_part;

/* All triangles and what meets where. Borrowed, but for the arrays made by mu_ground_make. */
typedef struct mu_ground {
    const mu_tension_input *in;
    const mu_tension *tension; /* its faces' M, and points of corners */
    const uint32_t *place;     /* per vertex: equal ones are one place */
    mu_part *part;             /* per triangle */
    uint32_t places;
    uint32_t *head, *next;    /* per place its first point; per point the next one there; MU_NO_POINT: none */
    uint32_t *first, *corner; /* per point its first corner and one past the last; corners in rising order */
    uint32_t *face_seen, *place_seen, *face;
    uint32_t now, count, room; /* the last patch: face[0 .. count) */
} mu_ground;

/* False: out of memory; freeing it is right then, too. */
_Bool mu_ground_make(mu_ground *ground);
void mu_ground_free(mu_ground *ground);

/* Collects the patch of `rings` 1 or 2. n: as above, NULL: any. own: only triangles of this point, and, of the second
 * ring, of one of the points that those have; MU_NO_POINT: any. The second ring leaves out places that are crowded. False: out of memory. */
_Bool mu_patch_collect(mu_ground *ground, uint32_t place, const double *n, uint32_t own, int rings);

/* The points of a place, or the one alone: for (p = mu_ground_begin(g, place, own); p != MU_NO_POINT; p =
 * mu_ground_next(g, own, p)). */
static inline uint32_t mu_ground_begin(const mu_ground *ground, uint32_t place, uint32_t own) {
    return own != MU_NO_POINT ? own : ground->head[place];
}
static inline uint32_t mu_ground_next(const mu_ground *ground, uint32_t own, uint32_t point) {
    return own != MU_NO_POINT ? MU_NO_POINT : ground->next[point];
}

static inline uint32_t mu_ground_place(const mu_ground *ground, uint32_t corner) {
    return ground->place[ground->in->corner[corner]];
}
static inline _Bool mu_part_faces(const mu_part *part, const double *n) {
    return part->weight[0] > 0 && (!n || part->n[0] * n[0] + part->n[1] * n[1] + part->n[2] * n[2] >= 0.5);
}

#endif
