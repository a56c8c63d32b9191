/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * surface_tracer.h: what sees the points of a surface. Every tracer works on baked vertices: the triangles of the
 * surface under M, looked at in the space they are in.
 */
#ifndef MU_SURFACE_TRACER_H
#define MU_SURFACE_TRACER_H

#include "core/render/error.h"
#include "core/surface/caster.h"

typedef struct mu_tracer {
    const char *name;
    /* The surface under M, or NULL after an error. `threads` may be used to prepare it. */
    void *(*open)(const mu_heightfield *f, const double m[4], uint32_t threads, mu_error *error);
    void (*close)(void *surface);
    /* Ready to look at one point of every cell (the sight's M is the surface's), or NULL after an error. */
    void *(*look)(void *surface, const mu_sight *sight, mu_error *error);
    void (*look_away)(void *look);
    /* visible[j] of row i is 1 where the point's triangle faces the direction and nothing is in front of it. Rows may be
     * asked for by several threads at once. */
    void (*row)(const void *look, uint32_t i, uint8_t *visible);
} mu_tracer;

/* Names: own (caster.h, exact), embree; then NULL. */
const char *const *mu_tracer_names(void);
const mu_tracer *mu_tracer_get(int index);

extern const mu_tracer mu_tracer_own, mu_tracer_embree;

/* An error in the words of the user's option; what both tracers say of rays that never end. */
_Bool mu_tracer_walk_fail(mu_walk_result result, const mu_sight *sight, mu_error *error);

#endif
