/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * povray_scene.h: a surface under M as a POV-Ray scene, seen from straight above and lit from up to three directions.
 *
 * M is baked into the vertices of mesh2 objects; only translations are left to POV-Ray. What its numbers can hold decides
 * how:
 *   - Hits nearer than some 1e-3 units are no shadows to it. So all is scaled until rays are at least one unit long over the
 *     width of a cell, however M compresses it.
 *   - Vertices are floats in it, rays are doubles. So the surface is cut into patches, each of coordinates around its own
 *     middle and then translated: vertices are off by at most 2^-25 of a patch's extent.
 *   - A parallel light lights from a plane: nothing beyond it casts a shadow. So lights stand farther than everything.
 */
#ifndef MU_POVRAY_SCENE_H
#define MU_POVRAY_SCENE_H

#include <stdio.h>

#include "core/render/error.h"
#include "core/surface/heightfield.h"

enum { MU_POVRAY_LIGHTS = 3 };

typedef struct mu_povray_surface {
    mu_heightfield f;
    double m[4];
    const double (*views)[3]; /* red, green, blue */
    uint32_t count;
} mu_povray_surface;

/* False if a view would need too many periods, or numbers would be too large. Trouble in writing is left to the stream. */
_Bool mu_povray_write(const mu_povray_surface *surface, FILE *out, mu_error *error);

#endif
