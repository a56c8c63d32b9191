/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* light.h: light arriving at a point: sampled, evaluated, and its density for multiple importance sampling.
 */
#ifndef MU_LIGHT_H
#define MU_LIGHT_H

#include "core/render/scene.h"

typedef struct mu_lights mu_lights;

typedef struct mu_light_sample {
    mu_vec3 direction; /* unit, toward the light */
    float distance;    /* infinite for lights at infinity */
    float radiance[3]; /* of directional and point lights: irradiance facing them, and pdf 1, delta */
    float pdf;         /* per steradian, including the choice of the light; 0: nothing to sample */
    _Bool delta;
} mu_light_sample;

/* Loads the environment image (through the module that holds OpenImageIO, only if there is one) and builds
 * its sampling tables. NULL on failure. */
mu_lights *mu_lights_build(const mu_scene *scene, mu_error *error);
void mu_lights_free(mu_lights *lights);

/* [any] How many lights mu_lights_sample chooses among: with 0 it has nothing to sample, with 1 it ignores
 * u[2]. */
uint32_t mu_lights_choices(const mu_lights *lights);
/* [any] Whether a ray may find light at all: not if all lights are directional or points. */
_Bool mu_lights_met(const mu_lights *lights);
/* What was built: the sampling table of the environment or studio, and the environment's pixels. */
size_t mu_lights_table_bytes(const mu_lights *lights);
size_t mu_lights_image_bytes(const mu_lights *lights);
/* Rows of an image that would show the light around: the environment's own; 0 where it is the same everywhere. */
uint32_t mu_lights_rows(const mu_lights *lights);
/* [any] One light sample as seen from p. u: three uniforms; u[2] chooses the light. */
void mu_lights_sample(const mu_lights *lights, mu_vec3 p, const float u[3], mu_light_sample *out);
/* [any] Radiance arriving from infinity along `direction` (unit, away from the scene), and the pdf with which
 * mu_lights_sample would have chosen it. */
void mu_lights_escaped(const mu_lights *lights, mu_vec3 direction, float radiance[3], float *pdf);
/* [any] Radiance of rectangle light `light`, hit at distance along `direction` from p; the same pdf. */
void mu_lights_hit(const mu_lights *lights, uint32_t light, mu_vec3 p, mu_vec3 direction, float distance,
                   float radiance[3], float *pdf);

#endif
