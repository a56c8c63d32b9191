/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * light_point.c: a light without extent: intensity over squared distance, the same in all directions or within a cone, whose
 * soft edge is a cubic in the cosine, 3 t² - 2 t³, as lamps of other renderers have it. World space.
 */
#include "core/render/light_parts.h"

/* Share of the intensity that goes along `direction`, a unit vector away from the light. */
static float share(const mu_light *light, mu_vec3 direction) {
    const float inside = mu_dot(light->direction, direction) - light->cone[0];
    if (light->cone[0] <= -1) return 1;
    if (!(inside > 0)) return 0;
    if (inside >= light->cone[1]) return 1;
    const float t = inside / light->cone[1];
    return t * t * (3 - 2 * t);
}

void mu_point_light_sample(const mu_light *light, mu_vec3 p, mu_light_sample *out) {
    const mu_vec3 to = mu_sub(light->position, p);
    const float distance = mu_length(to);
    if (!(distance > 0)) return;
    out->direction = mu_scale(to, 1 / distance);
    out->distance = distance;
    const float here = share(light, mu_scale(out->direction, -1)) / distance / distance;
    for (int c = 0; c < 3; c++) out->radiance[c] = light->irradiance[c] * here;
    out->pdf = here > 0 ? 1 : 0;
    out->delta = 1;
}
