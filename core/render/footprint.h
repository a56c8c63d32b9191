/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * footprint.h: the part of a surface, in texture coordinates, that a path sees at once where it arrives. For materials
 * that ask for it (MUSURF_NEEDS_FOOTPRINT); a scene without any computes none of this.
 *
 * What the camera sees is a pixel's, whatever the width of the filter, to first order exactly (Igehy 1999, "Tracing ray
 * differentials"). What a later ray sees is an approximation: the path is the axis of a cone (Amanatides 1984) that
 * starts as a pixel's, grows with the length of the path, and opens by twice the slope roughness of each lobe that was
 * sampled, as a mirror's tilt turns a ray by twice as much. The curvature of surfaces, and how refraction bends, is left
 * out; a diffuse bounce opens it so far that hardly a detail is told apart.
 */
#ifndef MU_FOOTPRINT_H
#define MU_FOOTPRINT_H

#include "core/render/geometry.h"

/* What is seen at once, where the ray arrives: a parallelogram of these two sides, in world space, across the ray. */
typedef struct mu_beam {
    mu_vec3 x, y;
    float share; /* of a side of the pixel, that one of its samples stands for: 1 / sqrt(their number) */
} mu_beam;

/* The side of the square seen where the ray starts, and by how much that grows per unit of length. */
typedef struct mu_cone {
    float width, spread;
} mu_cone;

/* A pixel, seen at p. */
mu_beam mu_beam_of_pixel(const mu_camera *camera, const mu_film_settings *film, mu_vec3 p);
/* The cone of the same pixel. */
mu_cone mu_cone_of_pixel(const mu_camera *camera, const mu_film_settings *film);
/* A square across the ray. */
mu_beam mu_beam_of_cone(float width, mu_vec3 direction);

/* The beam projected along the ray onto the tangent plane, in texture coordinates: u, v of the hit and of the two
 * half-axes. Not finite where there are none, or seen from the side. */
void mu_footprint_at(const mu_hit *hit, mu_vec3 direction, const mu_beam *beam, float out[6]);

#endif
