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

/* What a surface will be asked: from each view, side^2 points spread evenly over each triangle (surface_measure.h), and one,
 * (1/4, 1/2) or (3/4, 1/2). */
enum { MU_PLAN_VIEWS = 64 };
typedef struct mu_plan {
    const double (*views)[3];
    uint32_t count, side; /* at most MU_PLAN_VIEWS views */
    uint32_t threads;     /* may be used to prepare the surface */
} mu_plan;

/* An error with an empty text: a signal asked the program to end. */
typedef struct mu_tracer {
    const char *name;
    /* Writes what stands behind a foreign tracer and its version; false with an error if it is not there. NULL: our own. */
    _Bool (*version)(char *out, size_t size, mu_error *error);
    /* The surface under M, or NULL after an error. */
    void *(*open)(const mu_heightfield *f, const double m[4], const mu_plan *plan, mu_error *error);
    void (*close)(void *surface);
    /* Ready to look at one point of every cell (the sight's M is the surface's), or NULL after an error. */
    void *(*look)(void *surface, const mu_sight *sight, mu_error *error);
    void (*look_away)(void *look);
    /* visible[j] of row i is 1 where the point's triangle faces the direction and nothing is in front of it. Rows may be
     * asked for by several threads at once. */
    void (*row)(const void *look, uint32_t i, uint8_t *visible);
} mu_tracer;

/* Names: own (caster.h, exact), embree, povray; then NULL. */
const char *const *mu_tracer_names(void);
const mu_tracer *mu_tracer_get(int index);

extern const mu_tracer mu_tracer_own, mu_tracer_embree, mu_tracer_povray;

/* An error in the words of the user's option; what both tracers say of rays that never end. */
_Bool mu_tracer_walk_fail(mu_walk_result result, const mu_sight *sight, mu_error *error);

#endif
