/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * polygons.h: a mesh as its file numbers it: vertices in its own order, faces as they are, texture coordinates per corner.
 *
 * What renders (mesh.h) is joined, split and cut into triangles; two files are compared by this instead.
 */
#ifndef MU_POLYGONS_H
#define MU_POLYGONS_H

#include <stdint.h>

#include "core/render/error.h"
#include "core/render/pose.h"

typedef struct mu_polygons {
    const char *file; /* borrowed */
    uint32_t vertices, faces, corners;
    double *position; /* 3 per vertex, finite */
    uint32_t *first;  /* per face its first corner, and `corners` at the end; 3 corners or more */
    uint32_t *vertex; /* per corner */
    double *uv;       /* 2 per corner, NaN where a corner has none; NULL: nowhere any */
    float *normal;    /* 3 per corner, of any length, 0 where a corner has none; NULL: nowhere any */
} mu_polygons;

/*
 * OBJ: `v` and `f` lines in their order, in double precision, whatever groups and materials. PLY: its vertices and
 * faces. glTF and FBX: the primitives of all nodes one after the other, with their transformations, or in a pose
 * (posed.h; NULL: as they stand there, without targets and bones); an FBX has a vertex per corner. Points and lines are
 * ignored. Fails on files that cannot be read, without faces, or with a vertex that is not finite or beyond 1e9.
 */
_Bool mu_polygons_read(mu_polygons *polygons, const char *file, const mu_pose *pose, mu_error *error);
/* Whether a file of this name may hold targets, bones and animations. */
_Bool mu_polygons_can_pose(const char *file);
void mu_polygons_free(mu_polygons *polygons);

/* The part for OBJ. */
_Bool mu_polygons_read_obj(mu_polygons *polygons, const char *file, mu_error *error);

/*
 * Cuts one face into first[face + 1] - first[face] - 2 triangles, 3 corners each (numbers of corners of the mesh), by
 * clipping ears off its projection along its normal; a triangle stays as it is. Faces that cross themselves are cut
 * somehow. `scratch`: room for as many numbers as the face has corners.
 */
void mu_polygons_cut(const mu_polygons *polygons, uint32_t face, uint32_t *scratch, uint32_t *triangles);

/* All faces, one after the other; 3 corners per triangle, to be freed. NULL without memory. */
uint32_t *mu_polygons_cut_all(const mu_polygons *polygons, uint32_t *triangles);

enum { MU_POLYGON_MOST = 1024 }; /* corners of a face */

#endif
