/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * geometry_sphere.c: spheres under any affine map, as Embree user geometry.
 *
 * The ray is mapped into the sphere's own space and the quadratic solved there in double precision, in the
 * form that does not cancel: the discriminant from the ray's distance to the centre, the second root from the
 * first. So a sphere 1e4 radii away, or one squeezed to an ellipsoid, is as round as any.
 */
#include "core/render/geometry_internal.h"

static void bounds(const struct RTCBoundsFunctionArguments *args) {
    const struct mu_geometry *geometry = args->geometryUserPtr;
    const uint32_t index = geometry->spheres[args->primID];
    const mu_map *map = &geometry->maps[index];
    const double radius = (double)geometry->scene->objects[index].radius;
    float lower[3], upper[3];
    for (int i = 0; i < 3; ++i) {
        const double *row = map->linear[i];
        const double reach = radius * sqrt(row[0] * row[0] + row[1] * row[1] + row[2] * row[2]);
        lower[i] = nextafterf((float)(map->translation[i] - reach), -INFINITY);
        upper[i] = nextafterf((float)(map->translation[i] + reach), INFINITY);
    }
    *args->bounds_o = (struct RTCBounds){lower[0], lower[1], lower[2], 0, upper[0], upper[1], upper[2], 0};
}

/* The first distance in (near, far) where the ray meets the sphere, or a negative number. */
static double meet(const struct mu_geometry *geometry, uint32_t index, const struct RTCRay *ray) {
    const mu_map *map = &geometry->maps[index];
    const double radius = (double)geometry->scene->objects[index].radius;
    const mu_dvec3 from =
        mu_d3((double)ray->org_x - map->translation[0], (double)ray->org_y - map->translation[1],
              (double)ray->org_z - map->translation[2]);
    const mu_dvec3 o = mu_matrix_times(map->inverse, from);
    const mu_dvec3 d =
        mu_matrix_times(map->inverse, mu_d3((double)ray->dir_x, (double)ray->dir_y, (double)ray->dir_z));
    const double a = mu_ddot(d, d), b = mu_ddot(o, d);
    const mu_dvec3 nearest = mu_dsub(o, mu_dscale(d, b / a));
    const double inside = radius * radius - mu_ddot(nearest, nearest);
    if (!(inside >= 0)) return -1;
    const double q = -(b + copysign(sqrt(a * inside), b));
    if (q == 0) return -1;
    const double length = mu_dlength(o);
    const double root0 = q / a, root1 = (length - radius) * (length + radius) / q;
    const double first = fmin(root0, root1), second = fmax(root0, root1);
    const double near = (double)ray->tnear, far = (double)ray->tfar;
    if (first > near) return first < far ? first : -1;
    return second > near && second < far ? second : -1;
}

/* Embree hands over N rays as arrays of N numbers, field after field; its accessors for that are C++ only.
 * Fields of RTCRayHitN, in the order of RTCRay and RTCHit. */
enum {
    ORG_X,
    ORG_Y,
    ORG_Z,
    TNEAR,
    DIR_X,
    DIR_Y,
    DIR_Z,
    TFAR = 8,
    HIT_U = 15,
    HIT_V,
    PRIM_ID,
    GEOM_ID,
    INST_ID
};

static struct RTCRay lane(const float *rays, unsigned n, unsigned i) {
    return (struct RTCRay){.org_x = rays[ORG_X * n + i],
                           .org_y = rays[ORG_Y * n + i],
                           .org_z = rays[ORG_Z * n + i],
                           .tnear = rays[TNEAR * n + i],
                           .dir_x = rays[DIR_X * n + i],
                           .dir_y = rays[DIR_Y * n + i],
                           .dir_z = rays[DIR_Z * n + i],
                           .tfar = rays[TFAR * n + i]};
}

static void intersect(const struct RTCIntersectFunctionNArguments *args) {
    const struct mu_geometry *geometry = args->geometryUserPtr;
    const unsigned n = args->N;
    float *number = (float *)args->rayhit;
    unsigned *id = (unsigned *)args->rayhit;
    for (unsigned i = 0; i < n; ++i) {
        if (!args->valid[i]) continue;
        const struct RTCRay ray = lane(number, n, i);
        const double t = meet(geometry, geometry->spheres[args->primID], &ray);
        if (t < 0) continue;
        number[TFAR * n + i] = (float)t;
        number[HIT_U * n + i] = number[HIT_V * n + i] = 0;
        id[PRIM_ID * n + i] = args->primID;
        id[GEOM_ID * n + i] = args->geomID;
        id[INST_ID * n + i] = args->context->instID[0];
    }
}

static void occluded(const struct RTCOccludedFunctionNArguments *args) {
    const struct mu_geometry *geometry = args->geometryUserPtr;
    const unsigned n = args->N;
    float *number = (float *)args->ray;
    for (unsigned i = 0; i < n; ++i) {
        if (!args->valid[i]) continue;
        const struct RTCRay ray = lane(number, n, i);
        if (meet(geometry, geometry->spheres[args->primID], &ray) >= 0) number[TFAR * n + i] = -INFINITY;
    }
}

void mu_spheres_attach(RTCGeometry embree, struct mu_geometry *geometry) {
    rtcSetGeometryUserPrimitiveCount(embree, geometry->sphere_count);
    rtcSetGeometryUserData(embree, geometry);
    rtcSetGeometryBoundsFunction(embree, bounds, NULL);
    rtcSetGeometryIntersectFunction(embree, intersect);
    rtcSetGeometryOccludedFunction(embree, occluded);
}
