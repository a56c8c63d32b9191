/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_random.h: independent uniforms for the statistical checks; no two streams share a number.
 *
 * Counter-based (philox.h): the numbers of a test depend on (seed, stream) alone, never on which thread ran
 * it. Deliberately neither stratified nor shared with the renderer: chi^2 assumes independence.
 */
#ifndef MU_CHECK_RANDOM_H
#define MU_CHECK_RANDOM_H

#include <stdint.h>

typedef struct mu_stream {
    uint32_t key[2], counter[4], block[4];
    uint32_t used; /* words of `block` handed out */
} mu_stream;

mu_stream mu_stream_make(uint64_t seed, uint64_t stream);
/* In [0,1), a multiple of 2^-53. */
double mu_stream_uniform(mu_stream *random);
/* In [0,1), a multiple of 2^-24: every value is a float. */
float mu_stream_float(mu_stream *random);
double mu_stream_between(mu_stream *random, double low, double high);
uint32_t mu_stream_below(mu_stream *random, uint32_t count);

#endif
