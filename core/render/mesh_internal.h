/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* mesh_internal.h: what the files mesh*.c share. */
#ifndef MU_MESH_INTERNAL_H
#define MU_MESH_INTERNAL_H

#include "core/render/affine.h"
#include "core/render/mesh.h"

/* Vertex indices sorted so that vertices at the same place (and, if asked, with the same normal) stand side
 * by side, the lowest index first; to be freed. NULL without memory. */
uint32_t *mu_mesh_order(const mu_mesh *mesh, _Bool with_normals);
_Bool mu_mesh_same(const mu_mesh *mesh, _Bool with_normals, uint32_t a, uint32_t b);
/* One past the last position of the run of same vertices that starts at order[first]. */
uint32_t mu_mesh_run(const mu_mesh *mesh, _Bool with_normals, const uint32_t *order, uint32_t first);

/* The angle of triangle corner k, in radians. p: the three corners. */
double mu_corner_angle(const mu_dvec3 p[3], int k);
void mu_mesh_corners(const mu_mesh *mesh, uint32_t triangle, mu_dvec3 p[3]);
/* Zero area to within what rounding the corners to float leaves of it. */
_Bool mu_mesh_is_flat(const mu_mesh *mesh, const uint32_t corner[3]);
/* Computes the normals that are zero: smooth over all triangles that meet at the place, weighted by angle. */
_Bool mu_mesh_fill_normals(mu_mesh *mesh, mu_error *error);

/* False, with the reason, unless the file is a whole PLY file. */
_Bool mu_ply_check(const char *file, mu_error *error);
/* The property of this name of its vertices: is there one? */
_Bool mu_ply_has(const char *file, const char *name);
/* Properties of the vertices of a whole file, by name; columns[k] of *count numbers, to be freed whatever happens, NULL for a
 * name that is NULL. */
_Bool mu_ply_vertices(const char *file, const char *const *names, int wanted, double **columns, size_t *count,
                      mu_error *error);

#endif
