/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * mesh_normals.c: vertex normals for meshes that have none.
 *
 * The normal at a place is the sum of the unit normals of the triangles that meet there, each weighted by its
 * angle at that corner (Thurmer and Wuthrich, "Computing Vertex Normals from Polygonal Facets", 1998): the
 * result does not depend on how a face is cut into triangles. Outside is where corners run counter-clockwise.
 */
#include "core/render/mesh_internal.h"

#include <stdlib.h>

void mu_mesh_corners(const mu_mesh *mesh, uint32_t triangle, mu_dvec3 p[3]) {
    for (int k = 0; k < 3; ++k)
        p[k] = mu_dfloat(mesh->positions + 3 * (size_t)mesh->indices[3 * (size_t)triangle + (size_t)k]);
}

double mu_corner_angle(const mu_dvec3 p[3], int k) {
    const mu_dvec3 a = mu_dsub(p[(k + 1) % 3], p[k]), b = mu_dsub(p[(k + 2) % 3], p[k]);
    return atan2(mu_dlength(mu_dcross(a, b)), mu_ddot(a, b));
}

static _Bool is_zero(const float *v) {
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

static void accumulate(const mu_mesh *mesh, mu_dvec3 *sums) {
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        mu_dvec3 p[3];
        mu_mesh_corners(mesh, t, p);
        const mu_dvec3 n = mu_dnormalise(mu_dcross(mu_dsub(p[1], p[0]), mu_dsub(p[2], p[0])));
        for (int k = 0; k < 3; ++k) {
            mu_dvec3 *sum = &sums[mesh->indices[3 * (size_t)t + (size_t)k]];
            *sum = mu_dadd(*sum, mu_dscale(n, mu_corner_angle(p, k)));
        }
    }
}

_Bool mu_mesh_fill_normals(mu_mesh *mesh, mu_error *error) {
    _Bool missing = 0;
    for (size_t i = 0; i < mesh->vertex_count && !missing; ++i) missing = is_zero(mesh->normals + 3 * i);
    if (!missing) return 1;
    mu_dvec3 *sums = calloc((size_t)mesh->vertex_count + 1, sizeof *sums);
    uint32_t *order = mu_mesh_order(mesh, 0);
    if (!sums || !order) {
        free(sums);
        free(order);
        return mu_fail(error, "%s: not enough memory for normals", mesh->file);
    }
    accumulate(mesh, sums);
    for (uint32_t first = 0, last; first < mesh->vertex_count; first = last) {
        mu_dvec3 sum = {0, 0, 0};
        last = mu_mesh_run(mesh, 0, order, first);
        for (uint32_t i = first; i < last; ++i) sum = mu_dadd(sum, sums[order[i]]);
        for (uint32_t i = first; i < last; ++i) {
            float *n = mesh->normals + 3 * (size_t)order[i];
            if (!is_zero(n)) continue;
            /* Triangles that fold onto each other cancel: then this vertex' own ones decide, then +z. */
            mu_dvec3 unit = mu_dlength(sum) > 1e-6 ? sum : sums[order[i]];
            unit = mu_dlength(unit) > 1e-6 ? mu_dnormalise(unit) : mu_d3(0, 0, 1);
            n[0] = (float)unit.x;
            n[1] = (float)unit.y;
            n[2] = (float)unit.z;
        }
    }
    free(sums);
    free(order);
    return 1;
}
