/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * metals.c: optical constants of metals for RGB rendering, as measured; nothing fitted, nothing interpolated.
 *
 * Red, green and blue are the tabulated wavelengths nearest to the dominant wavelengths of the sRGB primaries
 * (611, 549, 464 nm). Ag, Au, Cu: P. B. Johnson and R. W. Christy, Phys. Rev. B 6, 4370 (1972); Cr: the same,
 * Phys. Rev. B 9, 5056 (1974): 616.8, 548.6 and 471.4 nm. Al: A. D. Rakic, Appl. Opt. 34, 4755 (1995): 619.9,
 * 563.6 and 476.9 nm.
 */
#include "core/bsdf/real.h"
#include <string.h>

#if MU_REAL_BITS == 53

static const struct {
    const char *symbol;
    double n[3], k[3];
} metals[] = {
    {"Ag", {0.06, 0.06, 0.05}, {4.152, 3.586, 2.869}},
    {"Al", {1.3660, 1.0728, 0.72780}, {7.4052, 6.7839, 5.7781}},
    {"Au", {0.21, 0.43, 1.31}, {3.272, 2.455, 1.849}},
    {"Cr", {3.17, 3.18, 2.51}, {3.30, 3.33, 3.24}},
    {"Cu", {0.30, 1.02, 1.25}, {3.205, 2.577, 2.483}},
};

const char *const mu_metal_names[] = {"Ag", "Al", "Au", "Cr", "Cu", NULL};

int mu_metal(const char *symbol, double n[3], double k[3]) {
    for (size_t i = 0; i < sizeof metals / sizeof metals[0]; i++) {
        if (strcmp(symbol, metals[i].symbol) != 0) continue;
        memcpy(n, metals[i].n, sizeof metals[i].n);
        memcpy(k, metals[i].k, sizeof metals[i].k);
        return 1;
    }
    return 0;
}

#endif
