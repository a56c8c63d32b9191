/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * mesh_deformed.c: a mesh to render, made of its deformation: corners at one point of the tension and with one normal are
 * a vertex, which therefore has one M.
 */
#include <stdlib.h>
#include <string.h>

#include "core/render/deformation.h"
#include "core/render/mesh_internal.h"
#include "core/tension/index.h"

static _Bool allocate(mu_mesh *mesh, const mu_deformation *d) {
    const size_t corners = (size_t)d->deformed.corners + 1;
    mesh->positions = calloc(3 * corners + 4, sizeof(float)); /* Embree reads four at a time */
    mesh->normals = calloc(3 * corners + 4, sizeof(float));
    mesh->uvs = calloc(2 * corners + 4, sizeof(float));
    mesh->tension = calloc(4 * corners + 4, sizeof(float));
    mesh->indices = calloc(3 * (size_t)d->triangles + 4, sizeof(uint32_t));
    return mesh->positions && mesh->normals && mesh->uvs && mesh->tension && mesh->indices;
}

static void add_vertex(mu_mesh *mesh, const mu_deformation *d, const double *uv, uint32_t corner,
                       const float *normal) {
    const size_t at = mesh->vertex_count++;
    const double *p = d->deformed.position + 3 * (size_t)d->deformed.vertex[corner];
    const double *m = d->tension->point[d->point[corner]].m;
    const mu_vec3 n = mu_single(mu_dnormalise(mu_dfloat(normal)));
    for (size_t k = 0; k < 3; k++) mesh->positions[3 * at + k] = (float)p[k];
    for (size_t k = 0; k < 2; k++) mesh->uvs[2 * at + k] = (float)uv[2 * (size_t)corner + k];
    for (size_t k = 0; k < 4; k++) mesh->tension[4 * at + k] = (float)m[k];
    memcpy(mesh->normals + 3 * at, &n, 3 * sizeof(float));
}

static _Bool fill(mu_mesh *mesh, const mu_deformation *d, const double *uv, uint32_t *vertex) {
    static const float none[3] = {0, 0, 0};
    mu_index index;
    const _Bool good = mu_index_make(&index, 2, d->deformed.corners);
    for (uint32_t i = 0; good && i < d->deformed.corners; i++) {
        const float *n = d->deformed.normal ? d->deformed.normal + 3 * (size_t)i : none;
        uint32_t bits[3];
        memcpy(bits, n, sizeof bits);
        const uint64_t key[2] = {(uint64_t)d->point[i] << 32 | bits[0], (uint64_t)bits[1] << 32 | bits[2]};
        vertex[i] = mu_index_of(&index, key);
        if (vertex[i] == mesh->vertex_count) add_vertex(mesh, d, uv, i, n);
    }
    mu_index_free(&index);
    return good;
}

static _Bool make(mu_mesh *mesh, const mu_deformation *d, mu_mesh_notes *notes, mu_error *error) {
    const double *uv = d->deformed.uv ? d->deformed.uv : d->rest.uv;
    if (!uv)
        return mu_fail(error, "%s: tension needs texture coordinates, which the mesh has not", mesh->file);
    for (size_t i = 0; i < 2 * (size_t)d->deformed.corners; i++)
        if (!isfinite(uv[i]))
            return mu_fail(error, "%s: tension needs texture coordinates, which some of its faces have not",
                           mesh->file);
    uint32_t *vertex = malloc(((size_t)d->deformed.corners + 1) * sizeof *vertex);
    const _Bool good = vertex && allocate(mesh, d) && fill(mesh, d, uv, vertex);
    for (size_t t = 0; good && t < d->triangles; t++) {
        uint32_t *corner = mesh->indices + 3 * (size_t)mesh->triangle_count;
        for (size_t k = 0; k < 3; k++) corner[k] = vertex[d->corner[3 * t + k]];
        if (mu_mesh_is_flat(mesh, corner))
            ++notes->dropped;
        else
            ++mesh->triangle_count;
    }
    free(vertex);
    if (!good) return mu_fail(error, "%s: not enough memory for %u triangles", mesh->file, d->triangles);
    if (!mesh->triangle_count)
        return mu_fail(error, "%s: the mesh is empty: all its %u triangles have no area", mesh->file,
                       notes->dropped);
    return mu_mesh_fill_normals(mesh, error);
}

_Bool mu_mesh_read_deformed(mu_mesh *mesh, const char *rest, const char *deformed, mu_mesh_notes *notes,
                            char *found, size_t size, mu_error *error) {
    mu_deformation d;
    memset(mesh, 0, sizeof *mesh);
    memset(notes, 0, sizeof *notes);
    if (!mu_deformation_read(&d, rest, deformed, error)) return 0;
    mesh->file = strdup(deformed);
    mesh->rest = strdup(rest);
    _Bool good = mesh->file && mesh->rest;
    if (!good) mu_fail(error, "%s: not enough memory", deformed);
    good = good && make(mesh, &d, notes, error);
    if (good) mu_deformation_describe(&d, found, size);
    mu_deformation_free(&d);
    if (!good) mu_mesh_free(mesh);
    return good;
}
