/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* uniform.h: independent uniform numbers for tests: SplitMix64 (Steele, Lea and Flood 2014), from a fixed
 * seed. */
#ifndef MU_TEST_UNIFORM_H
#define MU_TEST_UNIFORM_H

#include <stdint.h>

typedef struct uniform {
    uint64_t state;
} uniform;

static inline uint64_t uniform_bits(uniform *u) {
    uint64_t x = u->state += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}
/* [0, 1) */
static inline double uniform_double(uniform *u) {
    return (double)(uniform_bits(u) >> 11) * 0x1p-53;
}
static inline float uniform_float(uniform *u) {
    return (float)(uniform_bits(u) >> 40) * 0x1p-24f;
}

#endif
