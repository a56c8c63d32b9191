/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * direct.h: one light sample that is chosen among candidates, so that one shadow ray is worth several.
 *
 * n² candidates are one point u of the light's unit square, moved by (i, j) / n with the ends joined. Each has the
 * contribution t it would make unoccluded, multiple importance sampling included. One is kept with probability p = t / sum
 * and stands for the mean of all: an unbiased estimate (resampled importance sampling, Talbot et al. 2005), whose noise is
 * that of n² samples but for what shadow rays find.
 *
 * The choice moves as little as it can: u itself lies in a random one of the n² places, so it is kept with probability
 * min(1, n² p), and what is missing goes to those of p > 1 / n² (a maximal coupling; not in the paper). Where the light looks
 * alike from end to end, it is u that the shadow ray asks for, and the samples of a pixel stay stratified in penumbras.
 */
#ifndef MU_DIRECT_H
#define MU_DIRECT_H

#include "core/render/light.h"
#include "core/render/shading.h"

enum { MU_LIGHT_CELLS = 4 }; /* n at most */

typedef struct mu_direct {
    mu_vec3 direction;
    float distance;
    float arriving[3]; /* f |cos| times radiance */
    float weight;      /* of the whole: arriving times this is the estimate, if nothing stands between */
} mu_direct;

/* own^2 / (own^2 + other^2), without overflow. */
float mu_power_heuristic(float own, float other);

/* The candidate kept. u: three uniforms of mu_lights_sample and one to choose by. `combined`: weighed against BSDF sampling,
 * light by the power heuristic of n² light samples and one of the BSDF. `delta_only`: nothing else is taken. False: nothing. */
_Bool mu_direct_choose(const mu_lights *lights, const mu_shading *shading, uint32_t n, const float u[4],
                       _Bool combined, _Bool delta_only, mu_direct *out);

#endif
