/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * random.h: the random numbers of one sample of one pixel, each a function of (seed, pixel, sample index,
 * dimension) and of nothing else, so that no order of work can change a picture.
 *
 * Pairs are the first two dimensions of Sobol's sequence, Owen-scrambled, its order shuffled anew for each
 * pixel and dimension. Source: Burley, "Practical hash-based Owen scrambling", JCGT 9(4), 2020; the hash is
 * Laine and Karras's as printed there. Any 2^k first samples of a pixel are stratified in every pair.
 * `independent` draws plain hashed numbers instead: the comparison by which the scheme earns its place
 * (tests/test_random.c).
 */
#ifndef MU_RANDOM_H
#define MU_RANDOM_H

#include "core/surface/noise.h" /* mu_mix */

typedef struct mu_random {
    uint64_t key;       /* of seed and pixel */
    uint32_t index;     /* of the sample, bits reversed */
    uint32_t dimension; /* counts the draws */
    _Bool independent;
} mu_random;

static inline uint32_t mu_reverse_bits(uint32_t x) {
    x = __builtin_bswap32(x);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    return ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
}

/* Owen scrambling of a number whose bits are reversed: each bit is flipped depending on the lower ones and
 * the seed. */
static inline uint32_t mu_scramble_reversed(uint32_t x, uint32_t seed) {
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return x;
}

/* The second dimension of Sobol's sequence, bits reversed: its matrix is Pascal's triangle modulo 2, whose
 * entry (j, k) is 1 where the binary digits of j are among those of k (Lucas), so it is a product of five
 * butterflies. */
static inline uint32_t mu_sobol_second_reversed(uint32_t index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    return index ^ ((index >> 16) & 0x0000ffffu);
}

/* [0, 1), of 24 bits: exact in float. */
static inline float mu_unit(uint32_t bits) {
    return (float)(bits >> 8) * 0x1p-24f;
}

static inline mu_random mu_random_start(uint64_t seed, uint32_t x, uint32_t y, uint32_t sample) {
    const uint64_t pixel = (uint64_t)y << 32 | x;
    const uint64_t key = mu_mix(mu_mix(seed + MU_GOLDEN) ^ mu_mix(pixel + 0x632be59bd9b4e019u));
    return (mu_random){.key = key, .index = mu_reverse_bits(sample)};
}

/* The next 64 random bits that are the same for all samples of the pixel. */
static inline uint64_t mu_random_bits(mu_random *random) {
    return mu_mix(random->key + ++random->dimension * MU_GOLDEN);
}

static inline float mu_random_one(mu_random *random) {
    const uint64_t bits = mu_random_bits(random);
    if (random->independent) return mu_unit((uint32_t)(mu_mix(bits ^ random->index) >> 32));
    const uint32_t shuffled = mu_reverse_bits(mu_scramble_reversed(random->index, (uint32_t)bits));
    return mu_unit(mu_reverse_bits(mu_scramble_reversed(shuffled, (uint32_t)(bits >> 32))));
}

static inline void mu_random_pair(mu_random *random, float u[2]) {
    if (random->independent) {
        u[0] = mu_random_one(random);
        u[1] = mu_random_one(random);
        return;
    }
    const uint64_t bits = mu_random_bits(random), more = mu_random_bits(random);
    const uint32_t shuffled = mu_reverse_bits(mu_scramble_reversed(random->index, (uint32_t)bits));
    const uint32_t second = mu_sobol_second_reversed(shuffled);
    u[0] = mu_unit(mu_reverse_bits(mu_scramble_reversed(shuffled, (uint32_t)(bits >> 32))));
    u[1] = mu_unit(mu_reverse_bits(mu_scramble_reversed(second, (uint32_t)more)));
}

#endif
