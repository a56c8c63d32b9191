/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* noise.h: normal deviates that are a pure function of (seed, index): the same surface on every machine. */
#ifndef MU_NOISE_H
#define MU_NOISE_H

#include <math.h>

#include "core/bsdf/splitmix.h"

/* Uniform in (0, 1): the middle of one of 2^52 cells. */
static inline double mu_noise_uniform(uint64_t seed, uint64_t index) {
    const uint64_t bits = mu_mix(mu_mix(seed + MU_GOLDEN) + MU_GOLDEN * (index + 1));
    return ((double)(bits >> 12) + 0.5) * 0x1p-52;
}

/* Box and Muller. */
static inline double mu_noise_normal(uint64_t seed, uint64_t index) {
    const double u = mu_noise_uniform(seed, 2 * index), v = mu_noise_uniform(seed, 2 * index + 1);
    return sqrt(-2 * log(u)) * cos(6.283185307179586477 * v);
}

#endif
