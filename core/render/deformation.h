/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* deformation.h: two files of one mesh, at rest and deformed, and the tension between them (core/tension). */
#ifndef MU_DEFORMATION_H
#define MU_DEFORMATION_H

#include "core/render/polygons.h"
#include "core/tension/tension.h"

typedef struct mu_deformation {
    mu_polygons rest, deformed; /* the same faces of the same vertices */
    uint32_t triangles;
    uint32_t
        *corner; /* 3 per triangle: numbers of corners of the meshes; triangles of a face are neighbours */
    double
        *face; /* 4 per face of the file: M; of more than three corners, the mean by area of its triangles */
    uint32_t *point; /* per corner: of the tension; corners of a face agree between its triangles */
    mu_tension *tension;
} mu_deformation;

/* Both files as polygons.h reads them; fails, with the first difference, if their faces are not the same. pose: of
 * the deformed one, or NULL; rest: NULL for the bind shape of the deformed one's file. */
_Bool mu_deformation_read(mu_deformation *deformation, const char *rest, const char *deformed,
                          const mu_pose *pose, mu_error *error);
void mu_deformation_free(mu_deformation *deformation);

/* A line about what was found besides healthy triangles; false, and nothing in it, if all was well. */
_Bool mu_deformation_describe(const mu_deformation *deformation, char *out, size_t size);

#endif
