/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * surface_embree.c: Embree as a tracer: one period as a mesh of baked vertices in float, and instances of it as far as
 * the rays of a view go before they are above everything.
 *
 * A ray may not meet its own triangle, which lies below it; a filter leaves that one out instead of an offset. Float
 * vertices, far from the origin, are the reason for the few points that differ from the exact caster's.
 */
#include <embree3/rtcore.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/surface_tracer.h"

enum { MOST_TILES = 4096 };

typedef struct surface {
    mu_heightfield f;
    double m[4], range;
    RTCDevice device;
    RTCScene period;
} surface;

typedef struct view {
    const surface *surface;
    mu_sight sight;
    RTCScene tiles; /* instance 0 is the rays' own period */
} view;

/* Goes along with each ray: its own triangle. */
typedef struct own_context {
    struct RTCIntersectContext embree; /* first */
    unsigned primitive;
} own_context;

static void skip_own(const struct RTCFilterFunctionNArguments *args) {
    const own_context *context = (const own_context *)args->context;
    const unsigned *hit = (const unsigned *)args->hit; /* N = 1: Ng, u, v, then primID, geomID, instID */
    if (hit[5] == context->primitive && hit[7] == 0) args->valid[0] = 0;
}

static _Bool bake(surface *s, RTCGeometry mesh) {
    const uint32_t nx = s->f.nx, ny = s->f.ny;
    const size_t side = (size_t)ny + 1;
    float *v = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                       ((size_t)nx + 1) * side);
    uint32_t *t = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                          3 * sizeof(uint32_t), 2 * mu_cells(&s->f));
    if (!v || !t) return 0;
    for (uint32_t i = 0; i <= nx; i++)
        for (uint32_t j = 0; j <= ny; j++) {
            *v++ = (float)(s->m[0] * i + s->m[1] * j);
            *v++ = (float)(s->m[2] * i + s->m[3] * j);
            *v++ = (float)mu_height(&s->f, i, j);
        }
    for (uint32_t i = 0; i < nx; i++)
        for (uint32_t j = 0; j < ny; j++) {
            const uint32_t p00 = (uint32_t)(i * side + j), p10 = (uint32_t)(p00 + side);
            const uint32_t corners[6] = {p00, p10, p00 + 1, p10 + 1, p00 + 1, p10};
            memcpy(t, corners, sizeof corners);
            t += 6;
        }
    return 1;
}

static void close_embree(void *data) {
    surface *s = data;
    if (!s) return;
    if (s->period) rtcReleaseScene(s->period);
    if (s->device) rtcReleaseDevice(s->device);
    free(s);
}

static void *open_embree(const mu_heightfield *f, const double m[4], const mu_plan *plan, mu_error *error) {
    char settings[32];
    snprintf(settings, sizeof settings, "threads=%u", plan->threads);
    surface *s = calloc(1, sizeof *s);
    if (s) {
        double low = f->h[0], high = f->h[0];
        for (size_t k = 0; k < mu_cells(f); k++) low = fmin(low, f->h[k]), high = fmax(high, f->h[k]);
        *s = (surface){.f = *f, .range = high - low, .device = rtcNewDevice(settings)};
        memcpy(s->m, m, sizeof s->m);
    }
    if (s && s->device) {
        RTCGeometry mesh = rtcNewGeometry(s->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        if (bake(s, mesh)) {
            rtcSetGeometryOccludedFilterFunction(mesh, skip_own);
            rtcCommitGeometry(mesh);
            s->period = rtcNewScene(s->device);
            rtcSetSceneFlags(s->period, RTC_SCENE_FLAG_ROBUST);
            rtcAttachGeometry(s->period, mesh);
            rtcCommitScene(s->period);
        }
        rtcReleaseGeometry(mesh);
    }
    if (s && s->device && s->period && rtcGetDeviceError(s->device) == RTC_ERROR_NONE) return s;
    mu_fail(error, "Embree has not enough memory for a surface of %u x %u", f->nx, f->ny);
    close_embree(s);
    return NULL;
}

static int32_t tile(int32_t i, uint32_t n) {
    const int32_t width = (int32_t)n;
    return i >= 0 ? i / width : -((width - 1 - i) / width);
}

/* The periods that rays from anywhere in the first one pass over: tiles[0...3] are the least and largest in i, in j. */
static _Bool reach(const surface *s, const mu_sight *sight, int32_t tiles[4], mu_error *error) {
    mu_stepper step;
    size_t count = 0;
    int32_t i0 = 0, i1 = 1, j0 = 0, j1 = 1;
    if (mu_stepper_begin(&step, sight->m, sight->w, sight->u, sight->v, sight->upper))
        for (; step.edge.rise <= s->range; mu_stepper_next(&step)) {
            const int32_t i = step.edge.left[0], j = step.edge.left[1];
            i0 = i < i0 ? i : i0, i1 = i + 1 > i1 ? i + 1 : i1;
            j0 = j < j0 ? j : j0, j1 = j + 1 > j1 ? j + 1 : j1;
            if (++count > MU_WALK_MOST) return mu_tracer_walk_fail(MU_WALK_TOO_LONG, sight, error);
        }
    tiles[0] = tile(i0 - 1, s->f.nx), tiles[1] = tile(i1 + (int32_t)s->f.nx, s->f.nx);
    tiles[2] = tile(j0 - 1, s->f.ny), tiles[3] = tile(j1 + (int32_t)s->f.ny, s->f.ny);
    const int64_t all = ((int64_t)tiles[1] - tiles[0] + 1) * ((int64_t)tiles[3] - tiles[2] + 1);
    return all <= MOST_TILES ||
           mu_fail(error, "the view %g,%g,%g reaches over %lld periods; Embree is given %d at most",
                   sight->w[0], sight->w[1], sight->w[2], (long long)all, MOST_TILES);
}

static void attach(const surface *s, RTCScene tiles, int32_t a, int32_t b, unsigned id) {
    const double x = (double)a * s->f.nx, y = (double)b * s->f.ny;
    const float shift[12] = {
        1, 0, 0, 0, 1, 0, 0, 0, 1, (float)(s->m[0] * x + s->m[1] * y), (float)(s->m[2] * x + s->m[3] * y), 0};
    RTCGeometry instance = rtcNewGeometry(s->device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, s->period);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, shift);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(tiles, instance, id);
    rtcReleaseGeometry(instance);
}

static void *look(void *data, const mu_sight *sight, mu_error *error) {
    const surface *s = data;
    int32_t range[4] = {0};
    if (!reach(s, sight, range, error)) return NULL;
    view *v = calloc(1, sizeof *v);
    if (v) *v = (view){s, *sight, rtcNewScene(s->device)};
    if (v && v->tiles) {
        unsigned id = 0;
        rtcSetSceneFlags(v->tiles, RTC_SCENE_FLAG_ROBUST);
        attach(s, v->tiles, 0, 0, id++);
        for (int32_t a = range[0]; a <= range[1]; a++)
            for (int32_t b = range[2]; b <= range[3]; b++)
                if (a || b) attach(s, v->tiles, a, b, id++);
        rtcCommitScene(v->tiles);
        if (rtcGetDeviceError(s->device) == RTC_ERROR_NONE) return v;
        rtcReleaseScene(v->tiles);
    }
    free(v);
    mu_fail(error, "Embree has not enough memory for the periods of a view");
    return NULL;
}

static void look_away(void *data) {
    view *v = data;
    if (!v) return;
    rtcReleaseScene(v->tiles);
    free(v);
}

static void row(const void *data, uint32_t i, uint8_t *visible) {
    const view *v = data;
    const mu_heightfield *f = &v->surface->f;
    const mu_sight *at = &v->sight;
    const double length = sqrt(at->w[0] * at->w[0] + at->w[1] * at->w[1] + at->w[2] * at->w[2]);
    own_context context;
    rtcInitIntersectContext(&context.embree);
    for (uint32_t j = 0; j < f->ny; j++) {
        double slope[2];
        mu_facet_slope(f, i, j, at->upper, slope);
        visible[j] = 0;
        if (!(mu_facet_facing(at->m, slope, at->w) > 0)) continue;
        const double x = i + at->u, y = j + at->v;
        struct RTCRay ray = {.org_x = (float)(at->m[0] * x + at->m[1] * y),
                             .org_y = (float)(at->m[2] * x + at->m[3] * y),
                             .org_z = (float)mu_facet_height(f, i, j, at->upper, at->u, at->v),
                             .dir_x = (float)(at->w[0] / length),
                             .dir_y = (float)(at->w[1] / length),
                             .dir_z = (float)(at->w[2] / length),
                             .tfar = INFINITY,
                             .mask = ~0u};
        context.primitive = 2 * (i * f->ny + j) + (unsigned)at->upper;
        rtcOccluded1(v->tiles, &context.embree, &ray);
        if (!(ray.tfar < 0)) visible[j] = 1;
    }
}

static _Bool version(char *out, size_t size, mu_error *error) {
    (void)error;
    snprintf(out, size, "Embree " RTC_VERSION_STRING);
    return 1;
}

const mu_tracer mu_tracer_embree = {"embree", version, open_embree, close_embree, look, look_away, row};
