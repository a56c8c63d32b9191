/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* integrator.c: what renders ask: scratch, and rows of samples, by paths or by a filtered environment. */
#include "core/render/image_light.h"
#include "core/render/path.h"

size_t mu_integrator_scratch(const mu_scene *scene) {
    size_t bytes = 64;
    for (uint32_t i = 0; i < scene->material_count; i++) {
        const size_t own = scene->materials[i].material.plan.closure_bytes;
        if (own > bytes) bytes = own;
    }
    return (bytes + 63) / 64 * 64;
}

void mu_integrator_row(const mu_tracer *tracer, uint64_t seed, uint32_t x, uint32_t y, uint32_t count,
                       uint32_t sample, void *scratch, mu_radiance *out) {
    if (tracer->image_light) {
        mu_image_light_row(tracer, seed, x, y, count, sample, scratch, out);
        return;
    }
    const mu_path_options options = {.strategy =
                                         tracer->scene->integrator.bsdf_only ? MU_BSDF_ONLY : MU_BOTH};
    mu_path_row(tracer, &options, seed, x, y, count, sample, scratch, out);
}
