/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* geometry.h: what a ray hits; Embree behind it. World space. [any thread] after build. */
#ifndef MU_GEOMETRY_H
#define MU_GEOMETRY_H

#include "core/render/scene.h"

typedef struct mu_geometry mu_geometry;

typedef struct mu_ray {
    mu_vec3 origin, direction; /* unit */
    float near, far;
} mu_ray;

typedef struct mu_hit {
    mu_vec3 p;
    mu_vec3 ng;     /* geometric normal, unit, on the side the object's frame calls outside, even if the ray
                     * came from inside: turning over what is two-sided is left to the shading */
    mu_frame frame; /* shading frame: n interpolated, t the continuous tangent made orthogonal to n */
    float uv[2];
    mu_vec3 dpdu, dpdv; /* world-space derivatives by texture coordinates; zero if there are no UVs */
    float tension[4]; /* M of the deformation in `frame`, of a mesh that has one (scene.h); else not set */
    uint32_t primitive;  /* of a mesh: its triangle, and where in it: weights of its second and third corner */
    float corner[2];
    float distance;
    float error; /* how far p may lie from the surface that rays are tested against, along ng: a bound */
    uint32_t object;
    uint32_t material; /* index; the grid's where a grid line is hit; MU_NO_INDEX on a light: it only emits */
} mu_hit;

/* NULL on failure. */
mu_geometry *mu_geometry_build(const mu_scene *scene, uint32_t threads, mu_error *error);
void mu_geometry_free(mu_geometry *geometry);
_Bool mu_geometry_intersect(const mu_geometry *geometry, const mu_ray *ray, mu_hit *hit);
_Bool mu_geometry_occluded(const mu_geometry *geometry, const mu_ray *ray);

/* Up to MU_PACKET rays that run alike, together: a row of camera rays, their shadow rays. Ray i takes part if bit i of
 * `active` is set; bit i of the answer tells that it met something, and then hits[i] is filled. The last bits of a
 * hit may depend on which rays share the packet: who wants the same picture again forms the same packets again. */
enum { MU_PACKET = 8 };
uint32_t mu_geometry_intersect_packet(const mu_geometry *geometry, const mu_ray rays[MU_PACKET],
                                      uint32_t active, mu_hit hits[MU_PACKET]);
uint32_t mu_geometry_occluded_packet(const mu_geometry *geometry, const mu_ray rays[MU_PACKET],
                                     uint32_t active);

/* The ray that leaves `hit` toward `direction` without meeting the surface it left: offset along ng by a bound on
 * the rounding error of p. */
mu_ray mu_geometry_leave(const mu_hit *hit, mu_vec3 direction, float far);
void mu_geometry_bounds(const mu_geometry *geometry, mu_vec3 *min, mu_vec3 *max);

#endif
