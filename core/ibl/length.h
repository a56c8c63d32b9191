/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* length.h: hypot, in float without the call: squares of floats are doubles, neither too large nor too small. */
#ifndef MU_IBL_LENGTH_H
#define MU_IBL_LENGTH_H

#include "core/bsdf/real.h"

static inline real length2(real x, real y) {
#if MU_REAL_BITS == 24
    return (real)sqrt((double)x * (double)x + (double)y * (double)y);
#else
    return hypot(x, y);
#endif
}

static inline real length3(real x, real y, real z) {
#if MU_REAL_BITS == 24
    return (real)sqrt((double)x * (double)x + (double)y * (double)y + (double)z * (double)z);
#else
    return hypot(hypot(x, y), z);
#endif
}

#endif
