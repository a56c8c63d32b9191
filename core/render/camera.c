/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * camera.c: from a pixel to a ray. The filter is importance-sampled, so every sample weighs 1: a box draws
 * evenly from its square; a Gaussian of sigma = radius / 3, cut off at the circle of that radius, has a
 * closed inverse in polar coordinates.
 */
#include "core/render/path.h"

mu_ray mu_camera_ray(const mu_camera *camera, const mu_film_settings *film, uint32_t x, uint32_t y,
                     const float u[2]) {
    float dx = (2 * u[0] - 1) * film->filter_radius, dy = (2 * u[1] - 1) * film->filter_radius;
    if (film->filter == MU_FILTER_GAUSSIAN) {
        /* P(radius < r) = (1 - exp(-r^2 / 2 sigma^2)) / (1 - exp(-9/2)) */
        const float whole = 0.98889100f; /* 1 - exp(-9/2) */
        const float r = film->filter_radius * (1.f / 3) * sqrtf(-2 * log1pf(-u[0] * whole));
        dx = r * cosf(6.28318531f * u[1]);
        dy = r * sinf(6.28318531f * u[1]);
    }
    const float pixel = 2 * camera->half_height / (float)film->height;
    const float across = ((float)x + 0.5f + dx - 0.5f * (float)film->width) * pixel;
    const float upwards = (0.5f * (float)film->height - (float)y - 0.5f - dy) * pixel;
    const mu_vec3 aside = mu_add(mu_scale(camera->right, across), mu_scale(camera->up, upwards));
    mu_ray ray = {.origin = camera->position, .direction = camera->forward, .near = 0, .far = INFINITY};
    if (camera->kind == MU_ORTHOGRAPHIC)
        ray.origin = mu_add(ray.origin, aside);
    else
        ray.direction = mu_normalise(mu_add(ray.direction, aside));
    return ray;
}
