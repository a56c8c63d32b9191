/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * mesh_tangents.c: continuous tangents, so that neither triangles nor texture seams show in anisotropic
 * highlights.
 *
 * With texture coordinates: a triangle's tangent is the direction of dp/du. At a vertex the tangents of its
 * triangles, each projected into the vertex' tangent plane and normalised, are summed with the corners'
 * angles as weights, apart for either handedness (MikkTSpace does the same): a vertex where both meet, on the
 * axis of mirrored texture coordinates, is split in two. Beyond MikkTSpace, vertices at the same place with
 * the same normal and handedness take the sum of those within 60 degrees of their own: the seam where a
 * cylinder's u goes from 1 back to 0 is no seam of the field. The fourth component is the handedness: dp/dv =
 * w (n x t).
 *
 * Without texture coordinates, or where they are degenerate: the projection of the mesh's +x axis, as if
 * brushed along x; smooth except where the normal is along x, and there the projection of +y.
 */
#include "core/render/mesh_internal.h"

#include <stdlib.h>
#include <string.h>

/* Tangents sum to nothing in particular below this. */
#define MU_NO_TANGENT 1e-6

static mu_dvec3 projected(mu_dvec3 v, mu_dvec3 n) {
    return mu_dsub(v, mu_dscale(n, mu_ddot(v, n)));
}

static mu_dvec3 brushed(mu_dvec3 n) {
    const mu_dvec3 along = projected(mu_d3(1, 0, 0), n);
    return mu_dnormalise(mu_dlength(along) > 1e-3 ? along : projected(mu_d3(0, 1, 0), n));
}

/* Direction of dp/du; returns the sign of the triangle's area in texture space, 0 if it has none. */
static int triangle_tangent(const mu_mesh *mesh, uint32_t triangle, const mu_dvec3 p[3], mu_dvec3 *tangent) {
    const uint32_t *corner = mesh->indices + 3 * (size_t)triangle;
    const float *a = mesh->uvs + 2 * (size_t)corner[0], *b = mesh->uvs + 2 * (size_t)corner[1],
                *c = mesh->uvs + 2 * (size_t)corner[2];
    const double du1 = (double)b[0] - (double)a[0], dv1 = (double)b[1] - (double)a[1];
    const double du2 = (double)c[0] - (double)a[0], dv2 = (double)c[1] - (double)a[1];
    const double area = du1 * dv2 - du2 * dv1;
    if (area == 0) return 0;
    const int sign = area > 0 ? 1 : -1;
    const mu_dvec3 e1 = mu_dsub(p[1], p[0]), e2 = mu_dsub(p[2], p[0]);
    *tangent = mu_dnormalise(mu_dscale(mu_dsub(mu_dscale(e1, dv2), mu_dscale(e2, dv1)), sign));
    return mu_dlength(*tangent) > 0 ? sign : 0;
}

/* Grows an array of `width` floats per vertex by `extra` vertices. */
static _Bool grow(float **values, size_t width, size_t count, size_t extra) {
    float *larger = *values ? realloc(*values, width * (count + extra) * sizeof *larger) : NULL;
    if (larger) *values = larger;
    return larger || !*values;
}

/* Gives the triangles of negative handedness vertices of their own where they share some with positive ones.
 */
static _Bool split_mirrored(mu_mesh *mesh, signed char **signs) {
    const uint32_t old = mesh->vertex_count;
    signed char *sign = calloc((size_t)mesh->triangle_count + 1, 1);
    unsigned char *seen = calloc((size_t)old + 1, 1); /* 1: positive, 2: negative triangles meet here */
    uint32_t *twin = calloc((size_t)old + 1, sizeof *twin);
    uint32_t extra = 0;
    *signs = sign;
    if (!sign || !seen || !twin) goto fail;
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        mu_dvec3 p[3], tangent;
        mu_mesh_corners(mesh, t, p);
        sign[t] = (signed char)triangle_tangent(mesh, t, p, &tangent);
        for (size_t k = 0; k < 3 && sign[t]; ++k)
            seen[mesh->indices[3 * (size_t)t + k]] |= sign[t] > 0 ? 1 : 2;
    }
    for (uint32_t i = 0; i < old; ++i)
        if (seen[i] == 3) twin[i] = old + extra++;
    if (extra && !(grow(&mesh->positions, 3, old, extra) && grow(&mesh->normals, 3, old, extra) &&
                   grow(&mesh->uvs, 2, old, extra) && grow(&mesh->tension, 4, old, extra)))
        goto fail;
    for (uint32_t i = 0; i < old; ++i) {
        if (!twin[i]) continue;
        memcpy(mesh->positions + 3 * (size_t)twin[i], mesh->positions + 3 * (size_t)i, 3 * sizeof(float));
        memcpy(mesh->normals + 3 * (size_t)twin[i], mesh->normals + 3 * (size_t)i, 3 * sizeof(float));
        memcpy(mesh->uvs + 2 * (size_t)twin[i], mesh->uvs + 2 * (size_t)i, 2 * sizeof(float));
        if (mesh->tension)
            memcpy(mesh->tension + 4 * (size_t)twin[i], mesh->tension + 4 * (size_t)i, 4 * sizeof(float));
    }
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; ++i)
        if (sign[i / 3] < 0 && twin[mesh->indices[i]]) mesh->indices[i] = twin[mesh->indices[i]];
    mesh->vertex_count = old + extra;
    free(seen);
    free(twin);
    return 1;
fail:
    free(seen);
    free(twin);
    return 0;
}

static void accumulate(const mu_mesh *mesh, const signed char *sign, mu_dvec3 *sums, signed char *hand) {
    for (uint32_t t = 0; t < mesh->triangle_count; ++t) {
        mu_dvec3 p[3], tangent;
        if (!sign[t]) continue;
        mu_mesh_corners(mesh, t, p);
        triangle_tangent(mesh, t, p, &tangent);
        for (int k = 0; k < 3; ++k) {
            const uint32_t i = mesh->indices[3 * (size_t)t + (size_t)k];
            const mu_dvec3 flat = mu_dnormalise(projected(tangent, mu_dfloat(mesh->normals + 3 * (size_t)i)));
            sums[i] = mu_dadd(sums[i], mu_dscale(flat, mu_corner_angle(p, k)));
            hand[i] = sign[t];
        }
    }
}

/* Vertices at one place beyond which pairs of them are too many to look at: poles, at which u goes anywhere. */
#define MU_CROWD 64

/* Within the run order[first..last), each takes the sum over those that are within 60 degrees of its own. */
static void share(const uint32_t *order, uint32_t first, uint32_t last, const mu_dvec3 *sums,
                  const signed char *hand, mu_dvec3 *shared) {
    for (uint32_t i = first; i < last; ++i) {
        const mu_dvec3 own = sums[order[i]];
        shared[order[i]] = last - first > MU_CROWD ? own : mu_d3(0, 0, 0);
        if (last - first > MU_CROWD) continue;
        for (uint32_t j = first; j < last; ++j) {
            const mu_dvec3 other = sums[order[j]];
            if (hand[order[j]] == hand[order[i]] &&
                mu_ddot(own, other) > 0.5 * mu_dlength(own) * mu_dlength(other))
                shared[order[i]] = mu_dadd(shared[order[i]], other);
        }
    }
}

static void store(mu_mesh *mesh, size_t i, mu_dvec3 tangent, int hand) {
    const mu_dvec3 n = mu_dfloat(mesh->normals + 3 * i);
    const mu_dvec3 flat = projected(tangent, n);
    const mu_dvec3 unit = mu_dlength(flat) > MU_NO_TANGENT ? mu_dnormalise(flat) : brushed(n);
    float *out = mesh->tangents + 4 * i;
    out[0] = (float)unit.x;
    out[1] = (float)unit.y;
    out[2] = (float)unit.z;
    out[3] = hand < 0 ? -1.0f : 1.0f;
}

static _Bool from_uvs(mu_mesh *mesh) {
    signed char *sign = NULL, *hand = NULL;
    mu_dvec3 *sums = NULL, *shared = NULL;
    uint32_t *order = NULL;
    _Bool ok = split_mirrored(mesh, &sign);
    if (ok) {
        hand = calloc((size_t)mesh->vertex_count + 1, 1);
        sums = calloc((size_t)mesh->vertex_count + 1, sizeof *sums);
        shared = calloc((size_t)mesh->vertex_count + 1, sizeof *shared);
        order = mu_mesh_order(mesh, 1);
        mesh->tangents = calloc(4 * (size_t)mesh->vertex_count + 4, sizeof(float));
        ok = hand && sums && shared && order && mesh->tangents;
    }
    if (ok) {
        accumulate(mesh, sign, sums, hand);
        for (uint32_t first = 0, last; first < mesh->vertex_count; first = last) {
            last = mu_mesh_run(mesh, 1, order, first);
            share(order, first, last, sums, hand, shared);
        }
        for (size_t i = 0; i < mesh->vertex_count; ++i) store(mesh, i, shared[i], hand[i]);
    }
    free(sign);
    free(hand);
    free(sums);
    free(shared);
    free(order);
    return ok;
}

_Bool mu_mesh_make_tangents(mu_mesh *mesh, mu_error *error) {
    if (mesh->tangents) return 1;
    if (mesh->uvs) {
        if (from_uvs(mesh)) return 1;
        return mu_fail(error, "%s: not enough memory for tangents", mesh->file);
    }
    mesh->tangents = calloc(4 * (size_t)mesh->vertex_count + 4, sizeof(float));
    if (!mesh->tangents) return mu_fail(error, "%s: not enough memory for tangents", mesh->file);
    for (size_t i = 0; i < mesh->vertex_count; ++i) store(mesh, i, mu_d3(0, 0, 0), 1);
    return 1;
}
