/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* tension_files.h: what `musurf tension` writes of a deformation. Failures are left to the stream's error flag. */
#ifndef MU_TENSION_FILES_H
#define MU_TENSION_FILES_H

#include <stdio.h>

#include "core/render/deformation.h"

/*
 * A vertex on a seam of the texture is of several charts and has one M in each. In all of these, a vertex' M is that of
 * its first chart, in the order of the faces; further charts follow apart.
 */

/* One JSON object: "frame" unless MU_NO_FRAME, "summary", and with `all` "faces", "vertices", "seams". */
void mu_tension_write_json(const mu_deformation *d, long long frame, _Bool all, FILE *out);

/* The deformed mesh: its vertices in their order, then those of further charts; properties x y z, s t if there are
 * texture coordinates, m00 m01 m10 m11; the faces. Binary, little-endian, double. False: out of memory. */
_Bool mu_tension_write_ply(const mu_deformation *d, FILE *out);

/* SVG of the deformed mesh's texture: its triangles, and in them the ellipses that circles have become. False, with the
 * reason, if no face has texture coordinates. */
_Bool mu_tension_can_draw(const mu_deformation *d, mu_error *error);
void mu_tension_draw(const mu_deformation *d, FILE *out);

/* M of the vertex' first chart: 1 if no face has it. */
const double *mu_tension_vertex(const mu_tension *tension, uint32_t vertex);
/* Whether the point is a further chart of its place. */
_Bool mu_tension_is_further(const mu_tension *tension, uint32_t point);

#endif
