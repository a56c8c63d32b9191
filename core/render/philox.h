/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * philox.h: random numbers that are a pure function of (seed, index).
 *
 * Philox4x32-10: Salmon, Moraes, Dror, Shaw, "Parallel Random Numbers: As Easy as 1, 2, 3", SC 2011.
 */
#ifndef MU_PHILOX_H
#define MU_PHILOX_H

#include <stdint.h>

void mu_philox(const uint32_t counter[4], const uint32_t key[2], uint32_t out[4]);

/* Three independent uniforms in [0,1) with 53 bits. u[k] is made of the words 2k and 2k+1 of the blocks 0 and
 * 1 at counter (index low, index high, block, 0) under key (seed low, seed high): 2^-53 floor((w[2k] 2^32 +
 * w[2k+1]) / 2^11). */
void mu_philox_uniforms(uint64_t seed, uint64_t index, double u[3]);

#endif
