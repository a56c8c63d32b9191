/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * direction.h: where a texture's u direction is at a point of a chart, as cosine and sine in the frame of its site.
 *
 * dp/du of the fitted texture, turned no farther from the mean of the triangles' u directions than these are themselves:
 * what is said of log U in site.h. Only triangles of the chart count, so that at its border the fit is one of one side.
 * Charts that agree there to within 60 degrees, and in their handedness, share the mean: where u goes on smoothly
 * across a seam, as on a cylinder on which u = 1 is u = 0, M does not see the seam.
 */
#ifndef MU_TENSION_DIRECTION_H
#define MU_TENSION_DIRECTION_H

#include "core/tension/site.h"

/* alone: the point is the only one at its place, and the site's slope of v is its own. False: out of memory. */
_Bool mu_direction_find(mu_ground *ground, uint32_t point, uint32_t centre, int chart, _Bool alone,
                        const mu_site *site, double direction[2]);
/* The texture that says where u is: 6 numbers per triangle, or NULL: neither does. */
const double *mu_direction_uvs(const mu_tension_input *input, int chart);

#endif
