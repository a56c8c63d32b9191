/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * gamma_ratio.h: Gamma(x - 1/2) / Gamma(x) for x > 1/2, in double, also for huge x, where a difference of lgamma has no
 * digits left.
 *
 * Beyond 60 by the series of Gamma(w + 1/4) / Gamma(w + 3/4) sqrt(w) in 1/w², w = x - 3/4 (DLMF 5.11.14), whose next term is below
 * 1e-20 there (coefficients: fitted in 60-digit arithmetic, then recognised as rationals). Below, by the C library, whose
 * tgamma is good to some units in the last place.
 */
#ifndef MU_GAMMA_RATIO_H
#define MU_GAMMA_RATIO_H

#include <math.h>

static inline double gamma_ratio(double x) {
    if (x < 60) return tgamma(x - 0.5) / tgamma(x);
    const double w = x - 0.75, y = 1 / (w * w);
    return (1 + y * (-1 / 64. + y * (21 / 8192. + y * (-671 / 524288. + y * (180323 / 134217728.))))) /
           sqrt(w);
}

#endif
