/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* render_scene.c: where the integrator meets the passes. */
#include "core/render/render_scene.h"

#include "core/render/features.h"
#include "core/render/image_light.h"

static void sample(const void *tracer, uint64_t seed, uint32_t x, uint32_t y, uint32_t count, uint32_t index,
                   void *scratch, mu_radiance *out) {
    mu_integrator_row(tracer, seed, x, y, count, index, scratch, out);
}

mu_render_end mu_render_scene(mu_film *film, const mu_scene *scene, const mu_geometry *geometry,
                              const mu_lights *lights, const mu_render_plan *limits,
                              const mu_render_watch *watch, mu_error *error) {
    mu_tracer tracer = {.scene = scene,
                        .geometry = geometry,
                        .lights = lights,
                        .footprints = (mu_features_of(scene) & (MU_FEATURE_FOOTPRINTS | MU_FEATURE_TEXTURES)) != 0,
                        .samples = limits->samples < MU_MOST_SAMPLES ? limits->samples : scene->integrator.samples};
    mu_image_light *image_light = NULL;
    if (scene->integrator.by_image && !(image_light = mu_image_light_make(&tracer, 1, limits->threads, watch, error)))
        return MU_RENDER_FAILED;
    tracer.image_light = image_light;
    mu_render_plan plan = *limits;
    plan.sample = sample;
    plan.context = &tracer;
    plan.scratch = mu_integrator_scratch(scene);
    plan.seed = scene->integrator.seed;
    const mu_render_end end = mu_render(film, &plan, watch, error);
    mu_image_light_free(image_light);
    return end;
}
