/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * mesh_order.c: which vertices of a mesh are one point of the surface.
 *
 * Files repeat a vertex wherever its texture coordinates jump. Normals and tangents must not jump with them,
 * so they are gathered over all vertices at exactly the same place; sorting finds those, whatever the file's
 * order.
 */
#include "core/render/mesh_internal.h"

#include <stdlib.h>

typedef struct mu_order_key {
    const mu_mesh *mesh;
    _Bool with_normals;
} mu_order_key;

/* -1, 0, 1; the values are finite, and -0 equals 0. */
static int compare3(const float *a, const float *b) {
    for (int i = 0; i < 3; ++i)
        if (a[i] != b[i]) return a[i] < b[i] ? -1 : 1;
    return 0;
}

static int compare(const mu_mesh *mesh, _Bool with_normals, uint32_t a, uint32_t b) {
    const int places = compare3(mesh->positions + 3 * (size_t)a, mesh->positions + 3 * (size_t)b);
    if (places || !with_normals) return places;
    return compare3(mesh->normals + 3 * (size_t)a, mesh->normals + 3 * (size_t)b);
}

static int compare_indices(const void *a, const void *b, void *context) {
    const mu_order_key *key = context;
    const uint32_t i = *(const uint32_t *)a, j = *(const uint32_t *)b;
    const int order = compare(key->mesh, key->with_normals, i, j);
    return order ? order : (i > j) - (i < j);
}

uint32_t *mu_mesh_order(const mu_mesh *mesh, _Bool with_normals) {
    mu_order_key key = {mesh, with_normals};
    uint32_t *order = malloc(((size_t)mesh->vertex_count + 1) * sizeof *order);
    if (!order) return NULL;
    for (uint32_t i = 0; i < mesh->vertex_count; ++i) order[i] = i;
    qsort_r(order, mesh->vertex_count, sizeof *order, compare_indices, &key);
    return order;
}

_Bool mu_mesh_same(const mu_mesh *mesh, _Bool with_normals, uint32_t a, uint32_t b) {
    return compare(mesh, with_normals, a, b) == 0;
}

uint32_t mu_mesh_run(const mu_mesh *mesh, _Bool with_normals, const uint32_t *order, uint32_t first) {
    uint32_t last = first + 1;
    while (last < mesh->vertex_count && mu_mesh_same(mesh, with_normals, order[first], order[last])) ++last;
    return last;
}
