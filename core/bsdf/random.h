/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * random.h: more uniforms than the caller gave, for rejection loops.
 *
 * Counter-based: the n-th number is a hash (splitmix.h) of n and of the bits of the caller's three uniforms, so a sample
 * is a pure function of u: no state, the same bits on every thread. Over any set of
 * u that matters, its numbers are uniform and independent of u itself. Float uniforms carry 24 bits each, 72
 * together: enough that two samples of one image practically never share a sequence, and where they do they
 * differ in u no more than two equal draws would.
 */
#ifndef MU_RANDOM_H
#define MU_RANDOM_H

#include <string.h>

#include "core/bsdf/real.h"
#include "core/bsdf/splitmix.h"

typedef struct random {
    uint64_t state;
} random_stream;

static inline random_stream random_start(const real u[3]) {
    uint64_t state = 0;
    for (int i = 0; i < 3; i++) {
        uint64_t bits = 0;
        memcpy(&bits, &u[i], sizeof u[i]);
        state = mu_mix(state + bits + MU_GOLDEN);
    }
    return (random_stream){state};
}

/* Uniform in [0,1). */
static inline real random_next(random_stream *stream) {
    stream->state += MU_GOLDEN;
    return R(mu_mix(stream->state) >> (64 - MU_REAL_BITS)) / R(1ull << (MU_REAL_BITS - 1)) / 2;
}

/* A standard normal deviate (Box & Muller 1958). */
static inline real random_normal(random_stream *stream) {
    const real u = 1 - random_next(stream);
    return sqrt(-2 * log(u)) * cos(R(2 * PI) * random_next(stream));
}

/* The logarithm of a gamma deviate of this shape > 0 (Marsaglia & Tsang 2000). */
static inline real random_log_gamma(random_stream *stream, real shape) {
    const real boost = shape < 1 ? log(1 - random_next(stream)) / shape : 0;
    const real d = (shape < 1 ? shape + 1 : shape) - R(1) / 3, c = 1 / sqrt(9 * d);
    for (int k = 0; k < 64; k++) { /* each accepts 0.95 and more */
        const real x = random_normal(stream), ln_v = 3 * log1p(larger(c * x, -1 + REAL_MIN));
        if (c * x > -1 && log(1 - random_next(stream)) < x * x / 2 - d * expm1(ln_v) + d * ln_v)
            return log(d) + ln_v + boost;
    }
    return log(d) + boost;
}

#endif
