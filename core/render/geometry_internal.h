/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* geometry_internal.h: what the files geometry*.c share: which object an Embree id stands for. */
#ifndef MU_GEOMETRY_INTERNAL_H
#define MU_GEOMETRY_INTERNAL_H

#include <embree3/rtcore.h>

#include "core/render/affine.h"
#include "core/render/geometry.h"

/* A geometry of Embree's top-level scene; its id there is its index here. All rectangles are one geometry, so
 * are all spheres; a mesh that one object uses stands there in world space, a shared one as an instance. */
typedef struct mu_part {
    enum { MU_PART_RECTANGLES, MU_PART_SPHERES, MU_PART_MESH, MU_PART_INSTANCE } kind;
    uint32_t object; /* MU_PART_MESH, MU_PART_INSTANCE */
} mu_part;

struct mu_geometry {
    const mu_scene *scene;
    RTCDevice device;
    RTCScene top;
    RTCScene *shared; /* per mesh of the scene; NULL unless two objects share it */
    mu_map *maps;     /* per object */
    mu_part *parts;
    uint32_t *rectangles; /* primitive id -> object */
    uint32_t *spheres;    /* primitive id -> object */
    uint32_t part_count, rectangle_count, sphere_count;
    _Bool packets; /* the processor traces eight rays at once */
};

/* What Embree says of a hit. */
typedef struct mu_found {
    uint32_t object, primitive;
    float u, v, distance;
    _Bool instance; /* the ray was transformed by Embree */
} mu_found;

/* Spheres as Embree user geometry: exact quadrics, any affine map. */
void mu_spheres_attach(RTCGeometry embree, struct mu_geometry *geometry);
/* Everything about the point where `ray` met an object. */
void mu_hit_fill(const struct mu_geometry *geometry, const mu_ray *ray, const mu_found *found, mu_hit *hit);

#endif
