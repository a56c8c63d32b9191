/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_own.c: the exact caster as a tracer, and the list of tracers. */
#include "core/render/surface_tracer.h"

const char *const *mu_tracer_names(void) {
    static const char *const names[] = {"own", "embree", "povray", NULL};
    return names;
}

const mu_tracer *mu_tracer_get(int index) {
    static const mu_tracer *const tracers[] = {&mu_tracer_own, &mu_tracer_embree, &mu_tracer_povray};
    return tracers[index];
}

_Bool mu_tracer_walk_fail(mu_walk_result result, const mu_sight *sight, mu_error *error) {
    if (result == MU_WALK_NO_MEMORY) return mu_fail(error, "not enough memory to follow the rays");
    return mu_fail(error,
                   "the view %g,%g,%g is so near the horizon that its rays pass over more than %d edges",
                   sight->w[0], sight->w[1], sight->w[2], MU_WALK_MOST);
}

static void *open_own(const mu_heightfield *f, const double m[4], const mu_plan *plan, mu_error *error) {
    (void)m, (void)plan;
    mu_caster *caster = mu_caster_make(f);
    if (!caster) mu_fail(error, "not enough memory for a surface of %u x %u", f->nx, f->ny);
    return caster;
}

static void close_own(void *surface) {
    mu_caster_free(surface);
}

static void *look(void *surface, const mu_sight *sight, mu_error *error) {
    mu_cast *cast = NULL;
    const mu_walk_result result = mu_cast_make(&cast, surface, sight);
    if (result != MU_WALK_OK) mu_tracer_walk_fail(result, sight, error);
    return cast;
}

static void look_away(void *cast) {
    mu_cast_free(cast);
}

static void row(const void *cast, uint32_t i, uint8_t *visible) {
    mu_cast_row(cast, i, visible);
}

const mu_tracer mu_tracer_own = {"own", NULL, open_own, close_own, look, look_away, row};
