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

/* Only single rays are ever traced (rtcIntersect1, rtcOccluded1), so N is 1 and RTCRayHitN is an RTCRayHit.
 */
static void intersect(const struct RTCIntersectFunctionNArguments *args) {
    struct RTCRayHit *ray = (struct RTCRayHit *)args->rayhit;
    const struct mu_geometry *geometry = args->geometryUserPtr;
    if (!args->valid[0]) return;
    const double t = meet(geometry, geometry->spheres[args->primID], &ray->ray);
    if (t < 0) return;
    ray->ray.tfar = (float)t;
    ray->hit.u = ray->hit.v = 0;
    ray->hit.primID = args->primID;
    ray->hit.geomID = args->geomID;
    ray->hit.instID[0] = args->context->instID[0];
}

static void occluded(const struct RTCOccludedFunctionNArguments *args) {
    struct RTCRay *ray = (struct RTCRay *)args->ray;
    const struct mu_geometry *geometry = args->geometryUserPtr;
    if (args->valid[0] && meet(geometry, geometry->spheres[args->primID], ray) >= 0) ray->tfar = -INFINITY;
}

void mu_spheres_attach(RTCGeometry embree, struct mu_geometry *geometry) {
    rtcSetGeometryUserPrimitiveCount(embree, geometry->sphere_count);
    rtcSetGeometryUserData(embree, geometry);
    rtcSetGeometryBoundsFunction(embree, bounds, NULL);
    rtcSetGeometryIntersectFunction(embree, intersect);
    rtcSetGeometryOccludedFunction(embree, occluded);
}
