/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * surface_mesh.h: the triangles of a surface under M as a mesh file, the vertices being baked: (M (i, j), h).
 *
 * Every cell splits as heightfield.h says. Corners run counter-clockwise seen from above, under a mirror (det M < 0)
 * too, so that normals point up. Numbers come back as the same doubles.
 *     obj  text, v and f lines
 *     ply  binary, little-endian: double x y z, int indices
 *     pov  a mesh2 of one period to be #included; of several periods, a union of that mesh2 moved by M (a nx, b ny)
 */
#ifndef MU_SURFACE_MESH_H
#define MU_SURFACE_MESH_H

#include <stdio.h>

#include "core/surface/heightfield.h"

typedef enum mu_mesh_format { MU_MESH_POV, MU_MESH_PLY, MU_MESH_OBJ } mu_mesh_format;
/* "pov", "ply", "obj", NULL */
const char *const *mu_mesh_formats(void);

typedef struct mu_surface_mesh {
    mu_heightfield f;
    _Bool open; /* the last row and column of vertices end it: one cell fewer either way, tiles 0 */
    double m[4];
    uint32_t tiles; /* further periods on each side: (2 tiles + 1)^2 in all */
    mu_mesh_format format;
    void (*progress)(void *context, uint64_t done,
                     uint64_t all); /* of the rows of vertices and of triangles */
    void *context;
} mu_surface_mesh;

/* Of the whole; a PLY and an OBJ hold all of them, a POV those of one period and the rest as copies. */
uint64_t mu_surface_mesh_vertices(const mu_surface_mesh *mesh);
uint64_t mu_surface_mesh_triangles(const mu_surface_mesh *mesh);
/* What goes wrong is left to the stream's error flag. PLY and OBJ: at most 2^31 - 1 vertices. */
void mu_surface_mesh_write(const mu_surface_mesh *mesh, FILE *out);

#endif
