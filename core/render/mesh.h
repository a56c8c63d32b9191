/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* mesh.h: triangle meshes from files (OBJ, PLY, glTF through assimp), with the tangents anisotropy needs. */
#ifndef MU_MESH_H
#define MU_MESH_H

#include "core/render/scene.h"

/* Fails on files that cannot be read, empty meshes and non-finite vertices. Degenerate triangles are dropped and
 * counted in *dropped. Missing normals are computed (smooth, angle-weighted). */
_Bool mu_mesh_read(mu_mesh *mesh, const char *file, uint32_t *dropped, mu_error *error);
/* Continuous per-vertex tangents: along dp/du where there are UVs, else a smooth field over the surface. */
_Bool mu_mesh_make_tangents(mu_mesh *mesh, mu_error *error);
void mu_mesh_free(mu_mesh *mesh);

#endif
