/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* noise.h: normal deviates that are a pure function of (seed, index): the same surface on every machine. */
#ifndef MU_NOISE_H
#define MU_NOISE_H

#include <math.h>
#include <stdint.h>

/* The finaliser of SplitMix64: Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators", OOPSLA 2014. */
static inline uint64_t mu_noise_mix(uint64_t z) {
    z = (z ^ z >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ z >> 27) * UINT64_C(0x94d049bb133111eb);
    return z ^ z >> 31;
}

/* Uniform in (0, 1): the middle of one of 2^52 cells. */
static inline double mu_noise_uniform(uint64_t seed, uint64_t index) {
    const uint64_t golden = UINT64_C(0x9e3779b97f4a7c15);
    const uint64_t bits = mu_noise_mix(mu_noise_mix(seed + golden) + golden * (index + 1));
    return ((double)(bits >> 12) + 0.5) * 0x1p-52;
}

/* Box and Muller. */
static inline double mu_noise_normal(uint64_t seed, uint64_t index) {
    const double u = mu_noise_uniform(seed, 2 * index), v = mu_noise_uniform(seed, 2 * index + 1);
    return sqrt(-2 * log(u)) * cos(6.283185307179586477 * v);
}

#endif
