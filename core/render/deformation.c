/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* deformation.c: compares the faces of two meshes, cuts both in the same way, and asks core/tension. */
#include "core/render/deformation.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/affine.h"
#include "core/render/text.h"
#include "core/tension/stretch.h"

/* Whether face f has the same corners, from the last to the first. */
static _Bool is_reversed(const mu_polygons *a, const mu_polygons *b, uint32_t f) {
    const uint32_t first = a->first[f], end = a->first[f + 1];
    for (uint32_t i = first; i < end; i++)
        if (a->vertex[i] != b->vertex[first + (end - 1 - i)]) return 0;
    return 1;
}

static _Bool compare(const mu_polygons *a, const mu_polygons *b, mu_error *error) {
    if (a->vertices != b->vertices)
        return mu_fail(
            error, "%s has %u vertices and %s %u: both must be one mesh, with the same vertices and faces",
            b->file, b->vertices, a->file, a->vertices);
    if (a->faces != b->faces)
        return mu_fail(error,
                       "%s has %u faces and %s %u: both must be one mesh, with the same vertices and faces",
                       b->file, b->faces, a->file, a->faces);
    for (uint32_t f = 0; f < a->faces; f++) {
        const uint32_t count = a->first[f + 1] - a->first[f];
        if (count != b->first[f + 1] - b->first[f])
            return mu_fail(error, "%s: face %u has %u vertices, in %s %u: both must be one mesh", b->file, f,
                           b->first[f + 1] - b->first[f], a->file, count);
        for (uint32_t i = a->first[f]; i < a->first[f + 1]; i++)
            if (a->vertex[i] != b->vertex[i] && is_reversed(a, b, f))
                return mu_fail(
                    error,
                    "%s: face %u (from 0) runs the other way round than in %s: there is no tension of a "
                    "mesh that is mirrored",
                    b->file, f, a->file);
            else if (a->vertex[i] != b->vertex[i])
                return mu_fail(
                    error,
                    "%s: corner %u of face %u (both from 0) is vertex %u, in %s %u: both must be one mesh",
                    b->file, i - a->first[f], f, b->vertex[i], a->file, a->vertex[i]);
    }
    return 1;
}

static double *spread_uvs(const mu_deformation *d, const mu_polygons *mesh) {
    double *uvs = malloc(6 * (size_t)d->triangles * sizeof *uvs);
    for (size_t i = 0; uvs && i < 3 * (size_t)d->triangles; i++)
        memcpy(uvs + 2 * i, mesh->uv + 2 * (size_t)d->corner[i], 2 * sizeof *uvs);
    return uvs;
}

static _Bool make_tension(mu_deformation *d) {
    const size_t corners = 3 * (size_t)d->triangles;
    uint32_t *vertex = malloc(corners * sizeof *vertex);
    double *rest_uv = d->rest.uv ? spread_uvs(d, &d->rest) : NULL;
    double *deformed_uv = d->deformed.uv ? spread_uvs(d, &d->deformed) : NULL;
    if (vertex && !rest_uv == !d->rest.uv && !deformed_uv == !d->deformed.uv) {
        for (size_t i = 0; i < corners; i++) vertex[i] = d->rest.vertex[d->corner[i]];
        d->tension = mu_tension_make(&(mu_tension_input){.vertices = d->rest.vertices,
                                                         .triangles = d->triangles,
                                                         .corner = vertex,
                                                         .rest = d->rest.position,
                                                         .deformed = d->deformed.position,
                                                         .rest_uv = rest_uv,
                                                         .deformed_uv = deformed_uv});
    }
    free(vertex);
    free(rest_uv);
    free(deformed_uv);
    return d->tension != NULL;
}

static double rest_area(const mu_deformation *d, uint32_t triangle) {
    mu_dvec3 p[3];
    for (size_t k = 0; k < 3; k++) {
        const double *at = d->rest.position + 3 * (size_t)d->rest.vertex[d->corner[3 * (size_t)triangle + k]];
        p[k] = mu_d3(at[0], at[1], at[2]);
    }
    return mu_dlength(mu_dcross(mu_dsub(p[1], p[0]), mu_dsub(p[2], p[0])));
}

/* The mean of `count` triangles, in the space in which vertices have theirs. */
static void face_mean(const mu_deformation *d, uint32_t triangle, uint32_t count, double m[4]) {
    const double *own = d->tension->face + 4 * (size_t)triangle;
    double sum[5] = {0}, weight = 0;
    memcpy(m, own, 4 * sizeof *m);
    for (uint32_t t = 0; count > 1 && t < count; t++) {
        const mu_stretch_log log = mu_stretch_log_of(own + 4 * (size_t)t);
        const double area = rest_area(d, triangle + t),
                     part[5] = {log.xx, log.xy, log.yy, log.turn_x, log.turn_y};
        for (int k = 0; k < 5; k++) sum[k] += area * part[k];
        weight += area;
    }
    if (!(weight > 0)) return;
    const mu_stretch_log mean = {sum[0] / weight, sum[1] / weight, sum[2] / weight, sum[3] / weight,
                                 sum[4] / weight};
    mu_stretch_matrix(&mean, m);
}

static _Bool gather(mu_deformation *d) {
    d->face = malloc(4 * (size_t)d->rest.faces * sizeof *d->face);
    d->point = malloc((size_t)d->rest.corners * sizeof *d->point);
    if (!d->face || !d->point) return 0;
    for (size_t i = 3 * (size_t)d->triangles; i-- > 0;) d->point[d->corner[i]] = d->tension->corner[i];
    for (uint32_t f = 0, t = 0; f < d->rest.faces; f++) {
        const uint32_t count = d->rest.first[f + 1] - d->rest.first[f] - 2;
        face_mean(d, t, count, d->face + 4 * (size_t)f);
        t += count;
    }
    return 1;
}

_Bool mu_deformation_read(mu_deformation *d, const char *rest, const char *deformed, const mu_pose *pose,
                          mu_error *error) {
    static const mu_pose bind = {.bind = 1};
    memset(d, 0, sizeof *d);
    _Bool good = mu_polygons_read(&d->rest, rest ? rest : deformed, rest ? NULL : &bind, error) &&
                 mu_polygons_read(&d->deformed, deformed, pose, error) &&
                 compare(&d->rest, &d->deformed, error);
    if (good) d->corner = mu_polygons_cut_all(&d->rest, &d->triangles);
    if (good && !(d->corner && make_tension(d) && gather(d)))
        good = mu_fail(error, "%s: not enough memory for the tension of %u faces", deformed, d->rest.faces);
    if (!good) mu_deformation_free(d);
    return good;
}

void mu_deformation_free(mu_deformation *d) {
    mu_polygons_free(&d->rest);
    mu_polygons_free(&d->deformed);
    free(d->corner);
    free(d->face);
    free(d->point);
    mu_tension_free(d->tension);
    memset(d, 0, sizeof *d);
}

_Bool mu_deformation_describe(const mu_deformation *d, char *out, size_t size) {
    const mu_tension_counts *c = &d->tension->counts;
    const struct {
        uint32_t count;
        const char *what;
    } found[] = {{c->rest_flat, "without area at rest (they take the M of their corners)"},
                 {c->deformed_flat, "without area deformed (they take the M of their corners)"},
                 {c->uv_none, "without texture coordinates (u is along x at rest)"},
                 {c->uv_flat, "without area in the texture (u is along x at rest)"},
                 {c->uv_once, "with texture coordinates in one file only (used for both)"},
                 {c->uv_changed, "with other texture coordinates than at rest (M contains the turn)"},
                 {c->inverted, "turned over by the deformation"}};
    out[0] = '\0';
    for (size_t k = 0; k < sizeof found / sizeof *found; k++) {
        char part[128];
        if (!found[k].count) continue;
        snprintf(part, sizeof part, "%s%" PRIu32 " %s", *out ? ", " : "", found[k].count, found[k].what);
        if (!*out) {
            char head[64];
            snprintf(head, sizeof head, "of %" PRIu32 " triangles, ", d->triangles);
            mu_append(out, size, head);
        }
        mu_append(out, size, part);
    }
    if (c->points_without) {
        char part[96];
        snprintf(part, sizeof part, "%s%" PRIu32 " vertices have no triangle with an M (theirs is 1)",
                 *out ? "; " : "", c->points_without);
        mu_append(out, size, part);
    }
    return *out != '\0';
}
