/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* tension_ply.c: the deformed mesh with M at its vertices, as PLY (Turk, "The PLY Polygon File Format", 1994). */
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/tension_files.h"

static void put_bytes(FILE *out, uint64_t bits, int count) {
    for (int i = 0; i < count; i++) putc((int)(bits >> (8 * i) & 0xff), out);
}

static void put_doubles(FILE *out, const double *values, int count) {
    for (int i = 0; i < count; i++) {
        uint64_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        put_bytes(out, bits, 8);
    }
}

/* `uv` is NULL where the mesh has none; a vertex or corner without some has 0, 0. */
static void put_vertex(FILE *out, const double *position, _Bool textured, const double *uv, const double *m) {
    static const double none[2] = {0, 0};
    put_doubles(out, position, 3);
    if (textured) put_doubles(out, uv && isfinite(uv[0]) ? uv : none, 2);
    put_doubles(out, m, 4);
}

static void put_header(const mu_deformation *d, uint32_t vertices, const char *count_type, FILE *out) {
    fprintf(out,
            "ply\nformat binary_little_endian 1.0\ncomment tension M = [m00 m01; m10 m11] by musurf\n"
            "element vertex %" PRIu32 "\nproperty double x\nproperty double y\nproperty double z\n%s"
            "property double m00\nproperty double m01\nproperty double m10\nproperty double m11\n"
            "element face %" PRIu32 "\nproperty list %s int vertex_indices\nend_header\n",
            vertices, d->deformed.uv ? "property double s\nproperty double t\n" : "", d->rest.faces,
            count_type);
}

_Bool mu_tension_write_ply(const mu_deformation *d, FILE *out) {
    const mu_tension *t = d->tension;
    const mu_polygons *mesh = &d->deformed;
    uint32_t *number =
        malloc(((size_t)t->points + 1) * sizeof *number); /* of the vertices of further charts */
    uint32_t *corner = malloc(((size_t)t->points + 1) * sizeof *corner); /* one of each point */
    uint32_t vertices = mesh->vertices, longest = 0;
    if (number && corner) {
        for (uint32_t p = 0; p < t->points; p++)
            if (mu_tension_is_further(t, p)) number[p] = vertices++;
        for (size_t i = 3 * (size_t)d->triangles; i-- > 0;) corner[t->corner[i]] = d->corner[i];
        for (uint32_t f = 0; f < mesh->faces; f++)
            if (mesh->first[f + 1] - mesh->first[f] > longest) longest = mesh->first[f + 1] - mesh->first[f];
        put_header(d, vertices, longest < 256 ? "uchar" : "int", out);
        for (uint32_t v = 0; v < mesh->vertices; v++) {
            const uint32_t p = t->vertex[v];
            put_vertex(out, mesh->position + 3 * (size_t)v, mesh->uv,
                       mesh->uv && p != UINT32_MAX ? mesh->uv + 2 * (size_t)corner[p] : NULL,
                       mu_tension_vertex(t, v));
        }
        for (uint32_t p = 0; p < t->points; p++)
            if (mu_tension_is_further(t, p))
                put_vertex(out, mesh->position + 3 * (size_t)t->point[p].vertex, mesh->uv,
                           mesh->uv ? mesh->uv + 2 * (size_t)corner[p] : NULL, t->point[p].m);
        for (uint32_t f = 0; f < mesh->faces; f++) {
            put_bytes(out, mesh->first[f + 1] - mesh->first[f], longest < 256 ? 1 : 4);
            for (uint32_t i = mesh->first[f]; i < mesh->first[f + 1]; i++) {
                const uint32_t p = d->point[i];
                put_bytes(out, mu_tension_is_further(t, p) ? number[p] : mesh->vertex[i], 4);
            }
        }
    }
    const _Bool good = number && corner;
    free(number);
    free(corner);
    return good;
}
