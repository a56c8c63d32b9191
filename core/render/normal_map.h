/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * normal_map.h: "normal_map" of a material: a picture of normals in the frame of the texture, which the surface has for the
 * shading of light, if not in its outline.
 *
 *     {"file": "n.png"}      x along u, y along v, z outward; whole-number files mean [-1, 1], floats what they say
 *     "y": "down"            y against v, as DirectX has it; "up" by default
 *     "strength": s          of the slopes; as glTF's "scale" does. Negative: what stood out is sunk in
 *     "range", "channels" (two: z is what makes the length 1), "scale", "offset", "wrap" (repeat, clamp), "filter" (source.h)
 *
 * A normal is a slope (dz/du, dz/dv) = -(x, y) / z, in lengths on both axes, and slopes are what is kept, for they average over
 * a surface (which goes evenly between texels): their mean, and their second moments, of which the covariance comes (Olano and Baker 2010, "LEAN mapping"; Dupuy
 * et al. 2013; Cocco et al. 2024, section 4.1). Near, the mean turns the frame of shading; from afar, what the mean
 * leaves out widens the microsurface (normal_turn.h).
 */
#ifndef MU_NORMAL_MAP_H
#define MU_NORMAL_MAP_H

#include "core/render/source.h"
#include "plugin/musurf_map.h"
#include "plugin/musurf_slopes.h"

typedef struct mu_normal_map {
    mu_mipmap moments; /* of each texel: the mean slope, and the second moments xx xy yy about `middle` */
    double middle[2];
    mu_placement placement;
    double sign[2];             /* of the picture's axes along u and v */
    const musurf_slopes *slopes; /* where the lobe can be widened: what it is, */
    const musurf_map *map;       /* and how. NULL: the map only turns */
} mu_normal_map;

/* *out NULL: it leans nowhere. */
_Bool mu_normal_map_read(mu_normal_map **out, const mu_place *place, mu_error *error);
void mu_normal_map_free(mu_normal_map *map);
json_t *mu_normal_map_schema(void);

/* [any] Mean and covariance (xx xy yy) of the slopes about (u, v), over `share` of its half-axes; `point`: just
 * there, where the covariance is 0. */
void mu_normal_map_at(const mu_normal_map *map, const float footprint[6], double share, _Bool point, double mean[2],
                      double covariance[3]);

#endif
