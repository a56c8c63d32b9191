/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* patch.c: corners sorted by point by counting; marks of the running number say what the patch has already. */
#include "core/tension/patch.h"

#include <stdlib.h>
#include <string.h>

_Bool mu_ground_make(mu_ground *g) {
    const size_t corners = 3 * (size_t)g->in->triangles, points = g->tension->points, places = g->places;
    g->head = malloc((places + 1) * sizeof *g->head);
    g->next = malloc((points + 1) * sizeof *g->next);
    g->first = calloc(points + 2, sizeof *g->first);
    g->corner = malloc((corners + 1) * sizeof *g->corner);
    g->face_seen = calloc((size_t)g->in->triangles + 1, sizeof *g->face_seen);
    g->place_seen = calloc(places + 1, sizeof *g->place_seen);
    if (!g->head || !g->next || !g->first || !g->corner || !g->face_seen || !g->place_seen) return 0;
    for (size_t i = 0; i < corners; i++) g->first[g->tension->corner[i] + 2]++;
    for (size_t p = 2; p < points + 2; p++) g->first[p] += g->first[p - 1];
    for (size_t i = 0; i < corners; i++) g->corner[g->first[g->tension->corner[i] + 1]++] = (uint32_t)i;
    memset(g->head, 0xff, (places + 1) * sizeof *g->head);
    for (size_t p = points; p-- > 0;) {
        uint32_t *head = &g->head[mu_ground_place(g, g->corner[g->first[p]])];
        g->next[p] = *head;
        *head = (uint32_t)p;
    }
    return 1;
}

void mu_ground_free(mu_ground *g) {
    free(g->head);
    free(g->next);
    free(g->first);
    free(g->corner);
    free(g->face_seen);
    free(g->place_seen);
    free(g->face);
}

static void next_number(mu_ground *g) {
    if (++g->now) return;
    memset(g->face_seen, 0, g->in->triangles * sizeof *g->face_seen);
    memset(g->place_seen, 0, g->places * sizeof *g->place_seen);
    g->now = 1;
}

static _Bool add(mu_ground *g, uint32_t triangle) {
    if (g->face_seen[triangle] == g->now) return 1;
    g->face_seen[triangle] = g->now;
    if (g->count == g->room) {
        const uint32_t room = 2 * g->room + 64;
        uint32_t *larger = realloc(g->face, room * sizeof *larger);
        if (!larger) return 0;
        g->face = larger, g->room = room;
    }
    g->face[g->count++] = triangle;
    return 1;
}

static _Bool add_ring(mu_ground *g, uint32_t place, const double *n, uint32_t own) {
    for (uint32_t p = mu_ground_begin(g, place, own); p != MU_NO_POINT; p = mu_ground_next(g, own, p))
        for (uint32_t i = g->first[p]; i < g->first[p + 1]; i++)
            if (mu_part_faces(&g->part[g->corner[i] / 3], n) && !add(g, g->corner[i] / 3)) return 0;
    return 1;
}

/* Whether so many triangles meet there that each of their neighbours could not look at them all. */
static _Bool is_crowded(const mu_ground *g, uint32_t place) {
    uint32_t count = 0;
    for (uint32_t p = g->head[place]; p != MU_NO_POINT && count <= MU_CROWD; p = g->next[p])
        count += g->first[p + 1] - g->first[p];
    return count > MU_CROWD;
}

_Bool mu_patch_collect(mu_ground *g, uint32_t place, const double *n, uint32_t own, int rings) {
    next_number(g);
    g->count = 0;
    if (!add_ring(g, place, n, own)) return 0;
    const uint32_t near = g->count;
    for (size_t i = 0; rings > 1 && i < 3 * (size_t)near; i++) {
        const uint32_t corner = 3 * g->face[i / 3] + (uint32_t)(i % 3), at = mu_ground_place(g, corner);
        if (at != place && !is_crowded(g, at) &&
            !add_ring(g, at, n, own == MU_NO_POINT ? own : g->tension->corner[corner]))
            return 0;
    }
    return 1;
}
