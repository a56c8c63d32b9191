/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* direct.c: see direct.h. */
#include "core/render/direct.h"

#include <float.h>
#include <math.h>

float mu_power_heuristic(float own, float other) {
    if (!(own > 0)) return 0;
    const float ratio = other / own;
    return 1 / (1 + ratio * ratio);
}

/* u moved by share, the ends joined. */
static float moved(float u, uint32_t step, uint32_t n) {
    const float sum = u + (float)step / (float)n;
    return sum < 1 ? sum : sum - 1;
}

/* Its unoccluded contribution, summed over the channels; 0 if there is none. */
static float ask(const mu_shading *shading, const mu_light_sample *light, float share, _Bool combined,
                 mu_direct *out) {
    if (!(light->pdf > 0)) return 0;
    const mu_vec3 local = mu_to_local(&shading->frame, light->direction);
    if (!mu_shading_agrees(shading, light->direction, local.z)) return 0;
    const float wi[3] = {local.x, local.y, local.z};
    musurf_value value;
    shading->type->eval(shading->closure, wi, MUSURF_ALL_LOBES, &value);
    if (!value.lobes) return 0;
    *out = (mu_direct){.direction = light->direction, .distance = light->distance, .weight = 1 / light->pdf};
    if (!light->delta && combined) out->weight *= mu_power_heuristic(share * light->pdf, value.pdf);
    float sum = 0;
    for (int c = 0; c < 3; c++) sum += out->arriving[c] = value.f[c] * light->radiance[c];
    return sum * out->weight;
}

/* Which of them: 0, or one above the mean. */
static uint32_t choose(const float t[], uint32_t count, float mean, float u) {
    if (u * mean < t[0]) return 0;
    float excess = 0, at = (u * mean - t[0]) / (mean - t[0]);
    uint32_t chosen = 0;
    for (uint32_t j = 0; j < count; j++) excess += fmaxf(t[j] - mean, 0);
    at *= excess;
    for (uint32_t j = 0; j < count; j++) {
        if (!(t[j] > mean)) continue;
        chosen = j;
        at -= t[j] - mean;
        if (at < 0) break;
    }
    return chosen;
}

_Bool mu_direct_choose(const mu_lights *lights, const mu_shading *shading, uint32_t n, const float u[4],
                       _Bool combined, _Bool delta_only, mu_direct *out) {
    mu_direct candidates[MU_LIGHT_CELLS * MU_LIGHT_CELLS];
    float t[MU_LIGHT_CELLS * MU_LIGHT_CELLS], sum = 0;
    uint32_t count = n * n;
    const float share = (float)count;
    for (uint32_t j = 0; j < count; j++) {
        const float at[3] = {moved(u[0], j % n, n), moved(u[1], j / n, n), u[2]};
        mu_light_sample light;
        mu_lights_sample(lights, shading->hit->p, at, &light);
        if (light.delta) count = 1; /* they would all be the same */
        t[j] = delta_only && !light.delta ? 0 : ask(shading, &light, share, combined, &candidates[j]);
        if (!(t[j] >= 0 && t[j] <= FLT_MAX)) { /* the film refuses it, and counts that */
            *out = candidates[j];
            return 1;
        }
        sum += t[j];
    }
    if (!(sum > 0)) return 0;
    const uint32_t chosen = count > 1 ? choose(t, count, sum / (float)count, u[3]) : 0;
    if (!(t[chosen] > 0)) return 0;
    *out = candidates[chosen];
    if (count > 1) out->weight *= sum / (t[chosen] * (float)count);
    return 1;
}
