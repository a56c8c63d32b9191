/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* mesh.h: triangle meshes from files (OBJ, PLY, glTF, FBX through assimp), with the tangents anisotropy needs. */
#ifndef MU_MESH_H
#define MU_MESH_H

#include "core/render/pose.h"
#include "core/render/scene.h"

/* What was left out of a file that could be read. */
typedef struct mu_mesh_notes {
    uint32_t dropped; /* triangles without area */
    _Bool uvs_lost;   /* some of its parts have texture coordinates, some not: none are taken */
} mu_mesh_notes;

/* Fails on files that cannot be read, empty meshes and non-finite vertices. Missing normals are computed (smooth,
 * angle-weighted). */
_Bool mu_mesh_read(mu_mesh *mesh, const char *file, mu_mesh_notes *notes, mu_error *error);
/* A mesh in a pose, or deformed from one at rest, or both. */
typedef struct mu_mesh_source {
    const char *file;
    const mu_pose *pose; /* NULL: as the file has it */
    _Bool tension;
    const char *rest; /* for tension: the file of the mesh at rest; NULL: the bind shape of `file` */
} mu_mesh_source;

/* The same of such a mesh (deformation.h). With tension: at its vertices, and texture coordinates, which it needs, those
 * of the mesh at rest if it has none; `found`: a line about unhealthy triangles. */
_Bool mu_mesh_read_deformed(mu_mesh *mesh, const mu_mesh_source *source, mu_mesh_notes *notes, char *found,
                            size_t size, mu_error *error);
/* Continuous per-vertex tangents: along dp/du where there are UVs, else a smooth field over the surface. */
_Bool mu_mesh_make_tangents(mu_mesh *mesh, mu_error *error);
/* A property of the vertices of the mesh's file, which is a PLY, at those of the mesh; free() it. NULL on failure. Vertices
 * at one place of space and texture must agree in it. */
float *mu_mesh_attribute(const mu_mesh *mesh, const char *name, mu_error *error);
void mu_mesh_free(mu_mesh *mesh);

#endif
