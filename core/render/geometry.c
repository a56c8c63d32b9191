/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * geometry.c: a scene's objects handed to Embree, and rays traced through it. World space.
 *
 * A mesh that one object uses is put into the top-level scene with its vertices already in world space: one
 * level of boxes, no transformation of rays. A mesh that several objects share gets one acceleration
 * structure and an instance for each of them.
 */
#include "core/render/geometry_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void note(void *context, enum RTCError code, const char *text) {
    mu_error *error = context;
    if (code == RTC_ERROR_OUT_OF_MEMORY)
        mu_fail(error, "geometry: not enough memory for the scene's acceleration structure");
    else
        mu_fail(error, "geometry: Embree reports: %s", text ? text : "an unknown error");
}

static void attach(mu_geometry *geometry, RTCGeometry embree, mu_part part) {
    rtcSetGeometryBuildQuality(embree, RTC_BUILD_QUALITY_MEDIUM);
    rtcCommitGeometry(embree);
    rtcAttachGeometryByID(geometry->top, embree, geometry->part_count);
    rtcReleaseGeometry(embree);
    geometry->parts[geometry->part_count++] = part;
}

static void add_rectangles(mu_geometry *geometry) {
    const uint32_t count = geometry->rectangle_count;
    RTCGeometry embree = rtcNewGeometry(geometry->device, RTC_GEOMETRY_TYPE_QUAD);
    float *vertices = rtcSetNewGeometryBuffer(embree, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                              3 * sizeof(float), (size_t)count * 4);
    uint32_t *indices = rtcSetNewGeometryBuffer(embree, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT4,
                                                4 * sizeof(uint32_t), count);
    for (uint32_t i = 0; vertices && indices && i < count; ++i) {
        const mu_object *object = &geometry->scene->objects[geometry->rectangles[i]];
        const mu_map *map = &geometry->maps[geometry->rectangles[i]];
        for (uint32_t k = 0; k < 4; ++k) { /* counter-clockwise, so that Embree's u and v run along x and y */
            const double x = (k == 1 || k == 2) ? 0.5 : -0.5, y = k >= 2 ? 0.5 : -0.5;
            const mu_vec3 p = mu_single(
                mu_map_point(map, mu_d3(x * (double)object->size[0], y * (double)object->size[1], 0)));
            memcpy(vertices + 12 * (size_t)i + 3 * k, &p, sizeof p);
            indices[4 * (size_t)i + k] = 4 * i + k;
        }
    }
    attach(geometry, embree, (mu_part){MU_PART_RECTANGLES, 0});
}

/* A triangle geometry with the mesh's vertices, in world space if a map is given. */
static RTCGeometry make_triangles(mu_geometry *geometry, const mu_mesh *mesh, const mu_map *map) {
    RTCGeometry embree = rtcNewGeometry(geometry->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *vertices = rtcSetNewGeometryBuffer(embree, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                              3 * sizeof(float), mesh->vertex_count);
    uint32_t *indices = rtcSetNewGeometryBuffer(embree, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                3 * sizeof(uint32_t), mesh->triangle_count);
    if (!vertices || !indices) return embree;
    memcpy(indices, mesh->indices, 3 * sizeof(uint32_t) * (size_t)mesh->triangle_count);
    for (size_t i = 0; i < mesh->vertex_count; ++i) {
        const mu_dvec3 p = mu_dfloat(mesh->positions + 3 * i);
        const mu_vec3 world = mu_single(map ? mu_map_point(map, p) : p);
        memcpy(vertices + 3 * i, &world, sizeof world);
    }
    return embree;
}

static void add_mesh(mu_geometry *geometry, uint32_t index, const uint32_t *users) {
    const mu_object *object = &geometry->scene->objects[index];
    const mu_mesh *mesh = &geometry->scene->meshes[object->mesh];
    if (users[object->mesh] == 1) {
        attach(geometry, make_triangles(geometry, mesh, &geometry->maps[index]),
               (mu_part){MU_PART_MESH, index});
        return;
    }
    RTCScene *shared = &geometry->shared[object->mesh];
    if (!*shared) {
        *shared = rtcNewScene(geometry->device);
        rtcSetSceneFlags(*shared, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry triangles = make_triangles(geometry, mesh, NULL);
        rtcCommitGeometry(triangles);
        rtcAttachGeometry(*shared, triangles);
        rtcReleaseGeometry(triangles);
        rtcCommitScene(*shared);
    }
    RTCGeometry instance = rtcNewGeometry(geometry->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, *shared);
    rtcSetGeometryTimeStepCount(instance, 1);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, &object->to_world);
    attach(geometry, instance, (mu_part){MU_PART_INSTANCE, index});
}

static _Bool allocate(mu_geometry *geometry, mu_error *error) {
    const mu_scene *scene = geometry->scene;
    const size_t objects = scene->object_count ? scene->object_count : 1;
    geometry->maps = calloc(objects, sizeof *geometry->maps);
    geometry->parts = calloc(objects, sizeof *geometry->parts);
    geometry->rectangles = calloc(objects, sizeof *geometry->rectangles);
    geometry->spheres = calloc(objects, sizeof *geometry->spheres);
    geometry->shared = calloc((size_t)scene->mesh_count + 1, sizeof(RTCScene));
    if (!geometry->maps || !geometry->parts || !geometry->rectangles || !geometry->spheres ||
        !geometry->shared)
        return mu_fail(error, "geometry: not enough memory");
    return 1;
}

static _Bool fill(mu_geometry *geometry, mu_error *error) {
    const mu_scene *scene = geometry->scene;
    uint32_t *users = calloc((size_t)scene->mesh_count + 1, sizeof *users);
    if (!users) return mu_fail(error, "geometry: not enough memory");
    for (uint32_t i = 0; i < scene->object_count; ++i) {
        const mu_object *object = &scene->objects[i];
        if (!mu_map_make(&geometry->maps[i], &object->to_world)) {
            free(users);
            return mu_fail(error, "geometry: the transform of object %u is singular", (unsigned)i);
        }
        if (object->shape == MU_RECTANGLE) geometry->rectangles[geometry->rectangle_count++] = i;
        if (object->shape == MU_SPHERE) geometry->spheres[geometry->sphere_count++] = i;
        if (object->shape == MU_MESH) ++users[object->mesh];
    }
    if (geometry->rectangle_count) add_rectangles(geometry);
    if (geometry->sphere_count) {
        RTCGeometry embree = rtcNewGeometry(geometry->device, RTC_GEOMETRY_TYPE_USER);
        mu_spheres_attach(embree, geometry);
        attach(geometry, embree, (mu_part){MU_PART_SPHERES, 0});
    }
    for (uint32_t i = 0; i < scene->object_count; ++i)
        if (scene->objects[i].shape == MU_MESH) add_mesh(geometry, i, users);
    free(users);
    return 1;
}

mu_geometry *mu_geometry_build(const mu_scene *scene, uint32_t threads, mu_error *error) {
    char config[64];
    mu_error embree = {.text = ""};
    mu_geometry *geometry = calloc(1, sizeof *geometry);
    if (!geometry) return mu_fail(error, "geometry: not enough memory"), NULL;
    geometry->scene = scene;
    snprintf(config, sizeof config, "threads=%u", (unsigned)threads); /* 0: as many as there are */
    geometry->device = rtcNewDevice(config);
    if (!geometry->device) {
        note(error, rtcGetDeviceError(NULL), "no device could be made");
        mu_geometry_free(geometry);
        return NULL;
    }
    rtcSetDeviceErrorFunction(geometry->device, note, &embree);
    geometry->packets =
        rtcGetDeviceProperty(geometry->device, RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED) != 0;
    geometry->top = rtcNewScene(geometry->device);
    rtcSetSceneFlags(geometry->top, RTC_SCENE_FLAG_ROBUST);
    if (allocate(geometry, error) && fill(geometry, error)) rtcCommitScene(geometry->top);
    rtcSetDeviceErrorFunction(geometry->device, NULL, NULL);
    if (embree.text[0]) mu_fail(error, "%s", embree.text);
    if (error->text[0]) {
        mu_geometry_free(geometry);
        return NULL;
    }
    return geometry;
}

void mu_geometry_free(mu_geometry *geometry) {
    if (!geometry) return;
    if (geometry->top) rtcReleaseScene(geometry->top);
    for (uint32_t i = 0; geometry->shared && i < geometry->scene->mesh_count; ++i)
        if (geometry->shared[i]) rtcReleaseScene(geometry->shared[i]);
    if (geometry->device) rtcReleaseDevice(geometry->device);
    free(geometry->shared);
    free(geometry->maps);
    free(geometry->parts);
    free(geometry->rectangles);
    free(geometry->spheres);
    free(geometry);
}

/* What Embree found, as a hit of the scene. */
static void fill_hit(const mu_geometry *geometry, const mu_ray *ray, const struct RTCHit *embree,
                     float distance, mu_hit *hit) {
    const _Bool instance = embree->instID[0] != RTC_INVALID_GEOMETRY_ID;
    const mu_part *part = &geometry->parts[instance ? embree->instID[0] : embree->geomID];
    mu_found found = {part->object, embree->primID, embree->u, embree->v, distance, instance};
    if (part->kind == MU_PART_RECTANGLES) found.object = geometry->rectangles[embree->primID];
    if (part->kind == MU_PART_SPHERES) found.object = geometry->spheres[embree->primID];
    mu_hit_fill(geometry, ray, &found, hit);
}

static struct RTCRay embree_ray(const mu_ray *ray) {
    return (struct RTCRay){.org_x = ray->origin.x,
                           .org_y = ray->origin.y,
                           .org_z = ray->origin.z,
                           .tnear = ray->near,
                           .dir_x = ray->direction.x,
                           .dir_y = ray->direction.y,
                           .dir_z = ray->direction.z,
                           .tfar = ray->far,
                           .mask = 0xffffffffu};
}

_Bool mu_geometry_intersect(const mu_geometry *geometry, const mu_ray *ray, mu_hit *hit) {
    struct RTCIntersectContext context;
    struct RTCRayHit query = {.ray = embree_ray(ray)};
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcInitIntersectContext(&context);
    rtcIntersect1(geometry->top, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return 0;
    fill_hit(geometry, ray, &query.hit, query.ray.tfar, hit);
    return 1;
}

_Bool mu_geometry_occluded(const mu_geometry *geometry, const mu_ray *ray) {
    struct RTCIntersectContext context;
    struct RTCRay query = embree_ray(ray);
    rtcInitIntersectContext(&context);
    rtcOccluded1(geometry->top, &context, &query);
    return query.tfar < 0;
}

static void embree_packet(const mu_ray *rays, uint32_t active, int *valid, struct RTCRay8 *packet) {
    memset(packet, 0, sizeof *packet);
    for (int i = 0; i < MU_PACKET; ++i) {
        valid[i] = active >> i & 1 ? -1 : 0;
        if (!valid[i]) continue;
        packet->org_x[i] = rays[i].origin.x;
        packet->org_y[i] = rays[i].origin.y;
        packet->org_z[i] = rays[i].origin.z;
        packet->tnear[i] = rays[i].near;
        packet->dir_x[i] = rays[i].direction.x;
        packet->dir_y[i] = rays[i].direction.y;
        packet->dir_z[i] = rays[i].direction.z;
        packet->tfar[i] = rays[i].far;
        packet->mask[i] = 0xffffffffu;
    }
}

static void start_coherent(struct RTCIntersectContext *context) {
    rtcInitIntersectContext(context);
    context->flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
}

uint32_t mu_geometry_intersect_packet(const mu_geometry *geometry, const mu_ray rays[MU_PACKET],
                                      uint32_t active, mu_hit hits[MU_PACKET]) {
    uint32_t met = 0;
    if (!geometry->packets) {
        for (int i = 0; i < MU_PACKET; ++i)
            if (active >> i & 1 && mu_geometry_intersect(geometry, &rays[i], &hits[i])) met |= 1u << i;
        return met;
    }
    struct RTCIntersectContext context;
    struct RTCRayHit8 query;
    _Alignas(32) int valid[MU_PACKET];
    embree_packet(rays, active, valid, &query.ray);
    memset(query.hit.geomID, 0xff, sizeof query.hit.geomID); /* RTC_INVALID_GEOMETRY_ID */
    memset(query.hit.instID, 0xff, sizeof query.hit.instID);
    start_coherent(&context);
    rtcIntersect8(valid, geometry->top, &context, &query);
    for (int i = 0; i < MU_PACKET; ++i) {
        if (!valid[i] || query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
        const struct RTCHit one = {.u = query.hit.u[i],
                                   .v = query.hit.v[i],
                                   .primID = query.hit.primID[i],
                                   .geomID = query.hit.geomID[i],
                                   .instID = {query.hit.instID[0][i]}};
        fill_hit(geometry, &rays[i], &one, query.ray.tfar[i], &hits[i]);
        met |= 1u << i;
    }
    return met;
}

uint32_t mu_geometry_occluded_packet(const mu_geometry *geometry, const mu_ray rays[MU_PACKET],
                                     uint32_t active) {
    uint32_t met = 0;
    if (!geometry->packets) {
        for (int i = 0; i < MU_PACKET; ++i)
            if (active >> i & 1 && mu_geometry_occluded(geometry, &rays[i])) met |= 1u << i;
        return met;
    }
    struct RTCIntersectContext context;
    struct RTCRay8 query;
    _Alignas(32) int valid[MU_PACKET];
    embree_packet(rays, active, valid, &query);
    start_coherent(&context);
    rtcOccluded8(valid, geometry->top, &context, &query);
    for (int i = 0; i < MU_PACKET; ++i)
        if (valid[i] && query.tfar[i] < 0) met |= 1u << i;
    return met;
}

void mu_geometry_bounds(const mu_geometry *geometry, mu_vec3 *min, mu_vec3 *max) {
    struct RTCBounds box;
    rtcGetSceneBounds(geometry->top, &box);
    *min = mu_v3(box.lower_x, box.lower_y, box.lower_z);
    *max = mu_v3(box.upper_x, box.upper_y, box.upper_z);
}
