/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * splitmix.h: the hash behind every random number that is a function of something else: SplitMix64's finaliser (Steele, Lea &
 * Flood 2014, "Fast splittable pseudorandom number generators", OOPSLA), a bijection of 64 bits whose outputs for
 * neighbouring inputs are unrelated.
 */
#ifndef MU_SPLITMIX_H
#define MU_SPLITMIX_H

#include <stdint.h>

/* 2^64 over the golden ratio, odd: the step between the inputs of one sequence. */
#define MU_GOLDEN UINT64_C(0x9e3779b97f4a7c15)

static inline uint64_t mu_mix(uint64_t x) {
    x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
    return x ^ (x >> 31);
}

#endif
