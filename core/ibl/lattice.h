/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * lattice.h: points that fill the unit square or cube evenly, in [0, 1).
 *
 * mu_ibl_lattice: any number of them, one after the other: additive, by powers of the root of x⁴ = x + 1 (Roberts 2018, "The
 * unreasonable effectiveness of quasirandom sequences"). mu_ibl_fibonacci: a Fibonacci number of them, known beforehand, in the
 * square, whose sides are thought to be joined: of what goes on smoothly across them sums converge faster (Niederreiter 1992).
 */
#ifndef MU_IBL_LATTICE_H
#define MU_IBL_LATTICE_H

#include <math.h>
#include <stdint.h>

/* Point i, shifted. `u` is below 1 in float, too. */
static inline void mu_ibl_lattice(const double shift[3], uint64_t i, double u[3]) {
    static const double step[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
    for (int k = 0; k < 3; k++) {
        const double place = shift[k] + (double)i * step[k];
        u[k] = fmin(place - floor(place), 0x1.fffffep-1);
    }
}

/* Two Fibonacci numbers, one after the other. */
typedef struct mu_ibl_fibonacci {
    uint32_t before, count;
} mu_ibl_fibonacci;

/* The largest ones of which `count` is no more than `most`, which is 2 at least. */
static inline mu_ibl_fibonacci mu_ibl_fibonacci_below(uint64_t most) {
    mu_ibl_fibonacci f = {1, 2};
    while ((uint64_t)f.before + f.count <= most && f.count < UINT32_C(1) << 30)
        f = (mu_ibl_fibonacci){f.count, f.before + f.count};
    return f;
}

/* Point i < count. */
static inline void mu_ibl_fibonacci_at(mu_ibl_fibonacci f, const double shift[2], uint32_t i, double u[2]) {
    const double x = shift[0] + (i + 0.5) / f.count, y = shift[1] + (double)((uint64_t)i * f.before % f.count) / f.count;
    u[0] = x - floor(x), u[1] = y - floor(y);
}

#endif
