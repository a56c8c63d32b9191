/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * underside.h: a heightfield from below. The point reflection (x, y, z) -> -(x, y, z) turns the underside of h into the
 * upper side of -h(-x, -y), periodic and on the same lattice. It takes the cell's diagonal from (i+1,j) to (i,j+1) to the
 * diagonal of another cell, L to U and U to L; it commutes with M, keeps normals' slopes and turns directions over. So
 * whether a point sees the sky below along t is whether its image sees the sky along -t, and one caster does for both.
 */
#ifndef MU_UNDERSIDE_H
#define MU_UNDERSIDE_H

#include "core/surface/bounce.h"
#include "core/surface/caster.h"

/* The heights of the image, nx * ny of them as f has. */
void mu_underside_heights(const mu_heightfield *f, double *out);

/* Its caster: mu_caster_make of it, NULL: out of memory. */
mu_caster *mu_underside_caster(const mu_heightfield *f);

/* The image of a point of f. */
mu_spot mu_underside_spot(const mu_heightfield *f, const mu_spot *spot);

/* Whether nothing is between the point of f, under M, and the sky below along t. t leaves the underside of the point's
 * facet. What does not go down meets a heightfield from below sooner or later: false. */
_Bool mu_underside_sees(const mu_caster *underside, const mu_heightfield *f, const double m[4],
                        const mu_spot *spot, const double t[3]);

#endif
