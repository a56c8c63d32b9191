/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * chain.c: how large the squares of a filtered environment (globe.h) are, and what each is worth.
 *
 * There are twice log2 of the sharpest one's side levels: between two of the sharpest, whose alphas are far apart, reads interpolate
 * worst. Each is as coarse as its lobe allows: a texel, (4 pi)^1/2 / side wide at the mean, is FINENESS of its alpha at most, an eighth to a
 * quarter of the lobe's width (2 alpha to either side), and there are 32 at least. What is small stays in the processor's caches, where
 * most of a read's time goes.
 *
 * A lobe of few texels needs few taps; of the others some are needed, or lamps that are a pixel small leave a pattern. Most of the time to make
 * a chain goes into the first two or three.
 */
#include "core/ibl/globe.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 24

#define FINENESS 0.8

size_t mu_ibl_chain_sides(size_t side, size_t sides[MU_IBL_LEVELS_MOST]) {
    const double whole = sqrt(4 * PI);
    size_t exponent = 0;
    while (side >> (exponent + 1)) exponent++;
    const size_t levels = (2 * exponent < MU_IBL_LEVELS_MOST ? 2 * exponent : MU_IBL_LEVELS_MOST - 1) + 1;
    for (size_t l = 0; l < levels; l++) {
        const double linear = (double)l / (double)(levels - 1);
        sides[l] = l ? MU_IBL_CHAIN_LEAST : side;
        while (l && sides[l] < side && (double)sides[l] * FINENESS * linear * linear < whole) sides[l] *= 2;
    }
    return levels;
}

size_t mu_ibl_chain_taps(size_t level) {
    return level == 1 ? 32 : level < 4 ? 256 : MU_IBL_CHAIN_TAPS;
}

#endif
