/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * integrator.h: paths through neighbouring pixels.
 *
 * Every random number is a function of (seed, pixel, sample index, dimension), so the picture does not depend
 * on who computes which sample in what order; the rays of a row's first event share packets, so rows are
 * formed by place alone.
 */
#ifndef MU_INTEGRATOR_H
#define MU_INTEGRATOR_H

#include "core/render/geometry.h"
#include "core/render/light.h"

typedef struct mu_tracer { /* borrowed, read-only, shared by threads */
    const mu_scene *scene;
    const mu_geometry *geometry;
    const mu_lights *lights;
    _Bool footprints; /* some material asks for them */
    uint32_t samples; /* per pixel, as planned: what one of them stands for; 0: 1 */
    const struct mu_image_light *image_light; /* image_light.h; NULL: by paths */
} mu_tracer;

typedef struct mu_radiance {
    float rgb[3];
    float albedo[3];  /* at the first hit; 0 where the ray escapes */
    float normal[3];  /* world space, shading normal of the first hit */
    uint32_t rays;    /* traced, shadow rays included */
    uint32_t reads;   /* of an environment filtered in advance (image_light.h) */
    uint32_t refused; /* contributions left out because they were not finite or negative: always 0, or it is a
                         bug */
    _Bool hit;        /* the camera ray hit something: alpha */
} mu_radiance;

/* [any] `scratch` is this thread's, of at least mu_integrator_scratch() bytes, aligned to 64: it holds the
 * closures, so nothing is allocated while shading. */
size_t mu_integrator_scratch(const mu_scene *scene);
/* [any] Sample number `sample` of the `count` <= MU_PACKET pixels from (x, y) to the right; out[count]. */
void mu_integrator_row(const mu_tracer *tracer, uint64_t seed, uint32_t x, uint32_t y, uint32_t count,
                       uint32_t sample, void *scratch, mu_radiance *out);

#endif
