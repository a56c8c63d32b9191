/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* integrator.c: one sample of one pixel: camera ray, then path. */
#include <string.h>

#include "core/render/path.h"

size_t mu_integrator_scratch(const mu_scene *scene) {
    size_t bytes = 64;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const size_t own = scene->materials[i].material.plan.closure_bytes;
        if (own > bytes) bytes = own;
    }
    return (bytes + 63) / 64 * 64;
}

void mu_path_pixel(const mu_tracer *tracer, const mu_path_options *options, uint64_t seed, uint32_t x,
                   uint32_t y, uint32_t sample, void *scratch, mu_radiance *out) {
    memset(out, 0, sizeof *out);
    mu_random random = mu_random_start(seed, x, y, sample);
    random.independent = options->independent;
    float u[2];
    mu_random_pair(&random, u);
    const mu_ray ray = mu_camera_ray(&tracer->scene->camera, &tracer->scene->film, x, y, u);
    mu_path_trace(tracer, options, ray, &random, scratch, out);
}

void mu_integrator_path(const mu_tracer *tracer, uint64_t seed, uint32_t x, uint32_t y, uint32_t sample,
                        void *scratch, mu_radiance *out) {
    mu_path_pixel(tracer, &(mu_path_options){0}, seed, x, y, sample, scratch, out);
}
