/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* pyramid.h: the highest height over any rectangle of vertices of a periodic heightfield, bounded quickly from above. */
#ifndef MU_PYRAMID_H
#define MU_PYRAMID_H

#include <stddef.h>
#include <stdint.h>

#include "core/surface/heightfield.h"

enum { MU_PYRAMID_LEVELS = 16 };

typedef struct mu_pyramid {
    uint32_t nx, ny, levels;
    uint32_t height[MU_PYRAMID_LEVELS], width[MU_PYRAMID_LEVELS]; /* squares along i and along j */
    const double *level[MU_PYRAMID_LEVELS];                       /* the 0-th is the heights themselves */
    double *storage;
} mu_pyramid;

/* Borrows the heights. False: out of memory. */
_Bool mu_pyramid_make(mu_pyramid *pyramid, const mu_heightfield *f);
void mu_pyramid_free(mu_pyramid *pyramid);
/* At least the highest height over i0...i1, j0...j1, any whole numbers; at most that of a rectangle some half larger. */
double mu_pyramid_most(const mu_pyramid *pyramid, int64_t i0, int64_t i1, int64_t j0, int64_t j1);

#endif
