/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * image_light.h: pictures lit by an environment that was filtered in advance: no random directions, no shadows, one event.
 *
 * Radiance at a first hit is the directional albedo of its material times the reads of a technique (core/ibl/reads.h). The
 * lobe comes from the plugin: the moments of its slopes (musurf_slopes.h) under the M of the hit. All that is needed is made
 * once, before the first sample: the filtered environment, and of each material a table of albedos over what the camera's
 * rays meet. Where the table is not near enough, or there can be none, the albedo is integrated at the hit; and everywhere if
 * there are fewer hits than the table would have nodes.
 */
#ifndef MU_IMAGE_LIGHT_H
#define MU_IMAGE_LIGHT_H

#include "core/render/integrator.h"
#include "core/render/render.h"

typedef struct mu_image_light mu_image_light;

/* Whether a scene with a technique is one that it lights: not with a light that is nowhere around, or a material whose lobe
 * is not known, refracts or is blended. A scene without one always is. */
_Bool mu_image_light_takes(const mu_scene *scene, mu_error *error);
/* For a tracer whose scene has a technique, and so many pictures of it; watch, which may be NULL, is told of materials as they
 * are done. NULL on failure: what is not taken, or memory. */
mu_image_light *mu_image_light_make(const mu_tracer *tracer, uint32_t pictures, uint32_t threads,
                                    const mu_render_watch *watch, mu_error *error);
/* Another technique, of a light that was made: nothing is made anew. Not while others use it. */
void mu_image_light_choose(mu_image_light *image_light, const mu_integrator_settings *settings);
/* Other lights around the scene: filtered, tables stay. Not while others use it. After a failure it is only to be freed. */
_Bool mu_image_light_relight(mu_image_light *image_light, const mu_lights *lights, uint32_t threads, mu_error *error);
void mu_image_light_free(mu_image_light *image_light);

/* [any] As mu_integrator_row, of tracer->image_light. */
void mu_image_light_row(const mu_tracer *tracer, uint64_t seed, uint32_t x, uint32_t y, uint32_t count,
                        uint32_t sample, void *scratch, mu_radiance *out);

#endif
