/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* philox.c: Philox4x32 with ten rounds. */
#include "core/render/philox.h"

void mu_philox(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4]) {
    uint32_t c0 = counter[0], c1 = counter[1], c2 = counter[2], c3 = counter[3];
    uint32_t k0 = key[0], k1 = key[1];
    for (int round = 0; round < 10; round++) {
        const uint64_t a = UINT64_C(0xd2511f53) * c0, b = UINT64_C(0xcd9e8d57) * c2;
        c0 = (uint32_t)(b >> 32) ^ c1 ^ k0;
        c1 = (uint32_t)b;
        c2 = (uint32_t)(a >> 32) ^ c3 ^ k1;
        c3 = (uint32_t)a;
        k0 += 0x9e3779b9; /* golden ratio */
        k1 += 0xbb67ae85; /* sqrt(3) - 1 */
    }
    out[0] = c0, out[1] = c1, out[2] = c2, out[3] = c3;
}

void mu_philox_uniforms(uint64_t seed, uint64_t index, double u[3]) {
    const uint32_t key[2] = {(uint32_t)seed, (uint32_t)(seed >> 32)};
    uint32_t words[8];
    for (uint32_t block = 0; block < 2; block++) {
        const uint32_t counter[4] = {(uint32_t)index, (uint32_t)(index >> 32), block, 0};
        mu_philox(counter, key, words + 4 * block);
    }
    for (int k = 0; k < 3; k++)
        u[k] = (double)(((uint64_t)words[2 * k] << 32 | words[2 * k + 1]) >> 11) * 0x1p-53;
}
