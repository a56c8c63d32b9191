/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * mesh_deformed.c: a mesh to render, made of polygons in their file's order, which may be in a pose and have a tension:
 * corners at one point of the tension, or at one place of space and texture, and with one normal are a vertex.
 */
#include <stdlib.h>
#include <string.h>

#include "core/render/deformation.h"
#include "core/render/mesh_internal.h"
#include "core/tension/index.h"

/* What a mesh is made of. Borrowed. */
typedef struct mu_cut_polygons {
    const mu_polygons *shown;
    const double *uv; /* 2 per corner, or NULL */
    uint32_t triangles;
    const uint32_t *corner;    /* 3 per triangle */
    const uint32_t *point;     /* per corner */
    const mu_tension *tension; /* or NULL */
} mu_cut_polygons;

static _Bool allocate(mu_mesh *mesh, const mu_cut_polygons *p) {
    const size_t corners = (size_t)p->shown->corners + 1;
    mesh->positions = calloc(3 * corners + 4, sizeof(float)); /* Embree reads four at a time */
    mesh->normals = calloc(3 * corners + 4, sizeof(float));
    mesh->uvs = p->uv ? calloc(2 * corners + 4, sizeof(float)) : NULL;
    mesh->tension = p->tension ? calloc(4 * corners + 4, sizeof(float)) : NULL;
    mesh->indices = calloc(3 * (size_t)p->triangles + 4, sizeof(uint32_t));
    return mesh->positions && mesh->normals && !p->uv == !mesh->uvs && !p->tension == !mesh->tension &&
           mesh->indices;
}

static void add_vertex(mu_mesh *mesh, const mu_cut_polygons *p, uint32_t corner, const float *normal) {
    const size_t at = mesh->vertex_count++;
    const double *position = p->shown->position + 3 * (size_t)p->shown->vertex[corner];
    const mu_vec3 n = mu_single(mu_dnormalise(mu_dfloat(normal)));
    for (size_t k = 0; k < 3; k++) mesh->positions[3 * at + k] = (float)position[k];
    for (size_t k = 0; k < 2 && p->uv; k++) mesh->uvs[2 * at + k] = (float)p->uv[2 * (size_t)corner + k];
    for (size_t k = 0; k < 4 && p->tension; k++)
        mesh->tension[4 * at + k] = (float)p->tension->point[p->point[corner]].m[k];
    memcpy(mesh->normals + 3 * at, &n, 3 * sizeof(float));
}

static _Bool fill(mu_mesh *mesh, const mu_cut_polygons *p, uint32_t *vertex) {
    static const float none[3] = {0, 0, 0};
    mu_index index;
    const _Bool good = mu_index_make(&index, 2, p->shown->corners);
    for (uint32_t i = 0; good && i < p->shown->corners; i++) {
        const float *n = p->shown->normal ? p->shown->normal + 3 * (size_t)i : none;
        uint32_t bits[3];
        memcpy(bits, n, sizeof bits);
        const uint64_t key[2] = {(uint64_t)p->point[i] << 32 | bits[0], (uint64_t)bits[1] << 32 | bits[2]};
        vertex[i] = mu_index_of(&index, key);
        if (vertex[i] == mesh->vertex_count) add_vertex(mesh, p, i, n);
    }
    mu_index_free(&index);
    return good;
}

static _Bool make(mu_mesh *mesh, const mu_cut_polygons *p, mu_mesh_notes *notes, mu_error *error) {
    uint32_t *vertex = malloc(((size_t)p->shown->corners + 1) * sizeof *vertex);
    const _Bool good = vertex && allocate(mesh, p) && fill(mesh, p, vertex);
    for (size_t t = 0; good && t < p->triangles; t++) {
        uint32_t *corner = mesh->indices + 3 * (size_t)mesh->triangle_count;
        for (size_t k = 0; k < 3; k++) corner[k] = vertex[p->corner[3 * t + k]];
        if (mu_mesh_is_flat(mesh, corner))
            ++notes->dropped;
        else
            ++mesh->triangle_count;
    }
    free(vertex);
    if (!good) return mu_fail(error, "%s: not enough memory for %u triangles", mesh->file, p->triangles);
    if (!mesh->triangle_count)
        return mu_fail(error, "%s: the mesh is empty: all its %u triangles have no area", mesh->file,
                       notes->dropped);
    return mu_mesh_fill_normals(mesh, error);
}

static _Bool all_finite(const double *uv, uint32_t corners) {
    for (size_t i = 0; i < 2 * (size_t)corners; i++)
        if (!isfinite(uv[i])) return 0;
    return 1;
}

static _Bool make_deformed(mu_mesh *mesh, const mu_deformation *d, mu_mesh_notes *notes, mu_error *error) {
    const double *uv = d->deformed.uv ? d->deformed.uv : d->rest.uv;
    if (!uv)
        return mu_fail(error, "%s: tension needs texture coordinates, which the mesh has not", mesh->file);
    if (!all_finite(uv, d->deformed.corners))
        return mu_fail(error, "%s: tension needs texture coordinates, which some of its faces have not",
                       mesh->file);
    const mu_cut_polygons cut = {&d->deformed, uv, d->triangles, d->corner, d->point, d->tension};
    return make(mesh, &cut, notes, error);
}

/* Numbers of the places in space and texture, per corner; NULL without memory. */
static uint32_t *number_places(const mu_polygons *p, const double *uv) {
    uint32_t *place = malloc(((size_t)p->corners + 1) * sizeof *place);
    mu_index index;
    if (place && mu_index_make(&index, 5, p->corners)) {
        for (size_t i = 0; i < p->corners; i++) {
            uint64_t key[5];
            for (size_t k = 0; k < 5; k++)
                key[k] = mu_index_word(k < 3 ? p->position[3 * (size_t)p->vertex[i] + k]
                                       : uv  ? uv[2 * i + k - 3]
                                             : 0);
            place[i] = mu_index_of(&index, key);
        }
        mu_index_free(&index);
        return place;
    }
    if (place) mu_index_free(&index);
    free(place);
    return NULL;
}

static _Bool make_posed(mu_mesh *mesh, const mu_polygons *p, mu_mesh_notes *notes, mu_error *error) {
    const double *uv = p->uv && all_finite(p->uv, p->corners) ? p->uv : NULL;
    uint32_t triangles = 0, *corner = mu_polygons_cut_all(p, &triangles), *place = number_places(p, uv);
    const mu_cut_polygons cut = {p, uv, triangles, corner, place, NULL};
    notes->uvs_lost = p->uv && !uv;
    const _Bool good = corner && place ? make(mesh, &cut, notes, error)
                                       : mu_fail(error, "%s: not enough memory for its faces", mesh->file);
    free(corner);
    free(place);
    return good;
}

_Bool mu_mesh_read_deformed(mu_mesh *mesh, const mu_mesh_source *source, mu_mesh_notes *notes, char *found,
                            size_t size, mu_error *error) {
    mu_deformation d;
    mu_polygons posed;
    memset(mesh, 0, sizeof *mesh);
    memset(notes, 0, sizeof *notes);
    mesh->file = strdup(source->file);
    _Bool good = mesh->file || mu_fail(error, "%s: not enough memory", source->file);
    if (good && !source->tension) {
        good = mu_polygons_read(&posed, source->file, source->pose, error) &&
               make_posed(mesh, &posed, notes, error);
        mu_polygons_free(&posed);
    } else if (good) {
        good = mu_deformation_read(&d, source->rest, source->file, source->pose, error);
        if (good) {
            good = make_deformed(mesh, &d, notes, error);
            if (good) mu_deformation_describe(&d, found, size);
            mu_deformation_free(&d);
        }
    }
    if (!good) mu_mesh_free(mesh);
    return good;
}
