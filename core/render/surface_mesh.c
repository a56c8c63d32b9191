/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_mesh.c: row by row, nothing is held. */
#include "core/render/surface_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Vertices that are written: from `first`, `side` of them, along i and along j. */
typedef struct mu_extent {
    int64_t first[2], side[2];
} mu_extent;

const char *const *mu_mesh_formats(void) {
    static const char *const names[] = {"pov", "ply", "obj", NULL};
    return names;
}

static mu_extent extent(const mu_surface_mesh *mesh, int64_t tiles) {
    const int64_t nx = mesh->f.nx, ny = mesh->f.ny, end = !mesh->open;
    return (mu_extent){{-tiles * nx, -tiles * ny}, {(2 * tiles + 1) * nx + end, (2 * tiles + 1) * ny + end}};
}

uint64_t mu_surface_mesh_vertices(const mu_surface_mesh *mesh) {
    const mu_extent e = extent(mesh, mesh->tiles);
    return (uint64_t)e.side[0] * (uint64_t)e.side[1];
}

uint64_t mu_surface_mesh_triangles(const mu_surface_mesh *mesh) {
    const mu_extent e = extent(mesh, mesh->tiles);
    return 2 * (uint64_t)(e.side[0] - 1) * (uint64_t)(e.side[1] - 1);
}

/* The fewest of 15 and 17 digits that come back as the same double; whole numbers, the most frequent, as such. */
static char *put_number(char *at, double x) {
    if (fabs(x) < 1e9 && x == floor(x)) return at + sprintf(at, "%d", (int)x);
    char *const end = at + sprintf(at, "%.15g", x);
    return strtod(at, NULL) == x ? end : at + sprintf(at, "%.17g", x);
}

static void put_text(FILE *out, const char *before, const double p[3], char between, const char *after) {
    char line[128], *at = stpcpy(line, before);
    for (int k = 0; k < 3; k++) {
        at = put_number(at, p[k]);
        if (k < 2) *at++ = between;
    }
    at = stpcpy(at, after);
    fwrite(line, 1, (size_t)(at - line), out);
}

static void put_vertex(const mu_surface_mesh *mesh, const double p[3], _Bool last, FILE *out) {
    if (mesh->format == MU_MESH_OBJ)
        put_text(out, "v ", p, ' ', "\n");
    else if (mesh->format == MU_MESH_POV)
        put_text(out, "<", p, ',', last ? ">\n" : ">,\n");
    else
        for (int k = 0; k < 3; k++) {
            uint64_t bits;
            unsigned char bytes[8];
            memcpy(&bits, &p[k], sizeof bits);
            for (int b = 0; b < 8; b++) bytes[b] = (unsigned char)(bits >> (8 * b));
            fwrite(bytes, 1, sizeof bytes, out);
        }
}

static void put_triangle(const mu_surface_mesh *mesh, const uint64_t corners[3], _Bool last, FILE *out) {
    const unsigned long long a = corners[0], b = corners[1], c = corners[2];
    if (mesh->format == MU_MESH_OBJ) {
        fprintf(out, "f %llu %llu %llu\n", a + 1, b + 1, c + 1);
    } else if (mesh->format == MU_MESH_POV) {
        fprintf(out, "<%llu,%llu,%llu>%s", a, b, c, last ? "\n" : ",\n");
    } else {
        unsigned char bytes[13] = {3};
        for (int k = 0; k < 3; k++)
            for (int s = 0; s < 4; s++) bytes[1 + 4 * k + s] = (unsigned char)(corners[k] >> (8 * s));
        fwrite(bytes, 1, sizeof bytes, out);
    }
}

static void head(const mu_surface_mesh *mesh, const mu_extent *e, FILE *out) {
    const unsigned long long vertices = (unsigned long long)(e->side[0] * e->side[1]);
    const double *m = mesh->m;
    if (mesh->format != MU_MESH_PLY)
        fprintf(out,
                "%s musurf " MUSURF_VERSION
                ": a surface of %u x %u heights, vertices under M = [%.17g %.17g; %.17g %.17g], z is up\n",
                mesh->format == MU_MESH_POV ? "//" : "#", mesh->f.nx, mesh->f.ny, m[0], m[1], m[2], m[3]);
    if (mesh->format == MU_MESH_POV && mesh->tiles) fprintf(out, "#declare musurf_period =\n");
    if (mesh->format == MU_MESH_POV) fprintf(out, "mesh2 {\nvertex_vectors { %llu,\n", vertices);
    if (mesh->format == MU_MESH_PLY)
        fprintf(out,
                "ply\nformat binary_little_endian 1.0\ncomment musurf " MUSURF_VERSION
                "\nelement vertex %llu\nproperty double x\nproperty double y\nproperty double z\n"
                "element face %llu\nproperty list uchar int vertex_indices\nend_header\n",
                vertices, (unsigned long long)mu_surface_mesh_triangles(mesh));
}

static void put_copies(const mu_surface_mesh *mesh, FILE *out) {
    const int64_t tiles = mesh->tiles;
    fprintf(out, "union {\n");
    for (int64_t a = -tiles; a <= tiles; a++)
        for (int64_t b = -tiles; b <= tiles; b++) {
            const double x = (double)(a * mesh->f.nx), y = (double)(b * mesh->f.ny);
            const double shift[3] = {mesh->m[0] * x + mesh->m[1] * y, mesh->m[2] * x + mesh->m[3] * y, 0};
            put_text(out, "object { musurf_period translate <", shift, ',', "> }\n");
        }
    fprintf(out, "}\n");
}

void mu_surface_mesh_write(const mu_surface_mesh *mesh, FILE *out) {
    const mu_extent e = extent(mesh, mesh->format == MU_MESH_POV ? 0 : mesh->tiles);
    const uint64_t rows = (uint64_t)e.side[0], columns = (uint64_t)e.side[1], all = 2 * rows - 1;
    const _Bool mirror = mesh->m[0] * mesh->m[3] - mesh->m[1] * mesh->m[2] < 0;
    const int64_t nx = mesh->f.nx, ny = mesh->f.ny;
    head(mesh, &e, out);
    for (uint64_t r = 0; r < rows; r++) {
        if (mesh->progress) mesh->progress(mesh->context, r, all);
        for (uint64_t s = 0; s < columns; s++) {
            const int64_t i = e.first[0] + (int64_t)r, j = e.first[1] + (int64_t)s;
            const double x = (double)i, y = (double)j;
            const double p[3] = {
                mesh->m[0] * x + mesh->m[1] * y, mesh->m[2] * x + mesh->m[3] * y,
                mu_height(&mesh->f, (uint32_t)((i - e.first[0]) % nx), (uint32_t)((j - e.first[1]) % ny))};
            put_vertex(mesh, p, r + 1 == rows && s + 1 == columns, out);
        }
    }
    if (mesh->format == MU_MESH_POV)
        fprintf(out, "}\nface_indices { %llu,\n", 2ULL * (rows - 1) * (columns - 1));
    for (uint64_t r = 0; r + 1 < rows; r++) {
        if (mesh->progress) mesh->progress(mesh->context, rows + r, all);
        for (uint64_t s = 0; s + 1 < columns; s++) {
            const uint64_t p00 = r * columns + s, p10 = p00 + columns, p01 = p00 + 1, p11 = p10 + 1;
            const uint64_t lower[3] = {p00, mirror ? p01 : p10, mirror ? p10 : p01};
            const uint64_t upper[3] = {p11, mirror ? p10 : p01, mirror ? p01 : p10};
            put_triangle(mesh, lower, 0, out);
            put_triangle(mesh, upper, r + 2 == rows && s + 2 == columns, out);
        }
    }
    if (mesh->format == MU_MESH_POV) fprintf(out, "}\n}\n");
    if (mesh->format == MU_MESH_POV && mesh->tiles) put_copies(mesh, out);
}
