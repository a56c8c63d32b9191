/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_random.c: Philox4x32-10 streams; see check_random.h. */
#include "core/render/check_random.h"

#include "core/render/philox.h"

mu_stream mu_stream_make(uint64_t seed, uint64_t stream) {
    return (mu_stream){.key = {(uint32_t)seed, (uint32_t)(seed >> 32)},
                       .counter = {0, 0, (uint32_t)stream, (uint32_t)(stream >> 32)},
                       .used = 4};
}

static uint32_t next_word(mu_stream *random) {
    if (random->used == 4) {
        mu_philox(random->counter, random->key, random->block);
        if (++random->counter[0] == 0) random->counter[1]++;
        random->used = 0;
    }
    return random->block[random->used++];
}

double mu_stream_uniform(mu_stream *random) {
    const uint64_t high = next_word(random), low = next_word(random);
    return (double)((high << 21) ^ (low >> 11)) * 0x1p-53;
}

float mu_stream_float(mu_stream *random) {
    return (float)(next_word(random) >> 8) * 0x1p-24f;
}

double mu_stream_between(mu_stream *random, double low, double high) {
    return low + (high - low) * mu_stream_uniform(random);
}

uint32_t mu_stream_below(mu_stream *random, uint32_t count) {
    return (uint32_t)(((uint64_t)next_word(random) * count) >> 32);
}
