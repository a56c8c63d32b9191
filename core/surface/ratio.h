/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * ratio.h: many ratios of sums over the same few units (realisations of a surface, or blocks of one), with the standard
 * error that follows from how the units scatter: with R = sum t / sum b over K units,
 *     error^2 = K / (K - 1) sum (t - R b)^2 / (sum b)^2,
 * the linearised variance of a ratio (Cochran, Sampling Techniques, 1977, 2.11). For equal b it is the error of a mean.
 */
#ifndef MU_RATIO_H
#define MU_RATIO_H

#include <stddef.h>

typedef struct mu_ratios {
    size_t units, cells;
    double *top;    /* units x cells */
    double *bottom; /* the same, or `units` numbers for all cells */
    _Bool shared;   /* then `bottom` is borrowed */
} mu_ratios;

typedef struct mu_ratio {
    double value, error; /* NaN where nothing was counted; error: NaN for a single unit */
} mu_ratio;

/* All zero. `bottom`: one number per unit that all cells share, or NULL: each has its own. False: out of memory; either
 * way mu_ratios_free is right. */
_Bool mu_ratios_make(mu_ratios *ratios, size_t units, size_t cells, double *bottom);
void mu_ratios_free(mu_ratios *ratios);
mu_ratio mu_ratios_get(const mu_ratios *ratios, size_t cell);

static inline void mu_ratios_add(mu_ratios *r, size_t unit, size_t cell, double top) {
    r->top[unit * r->cells + cell] += top;
}
static inline void mu_ratios_add_both(mu_ratios *r, size_t unit, size_t cell, double top, double bottom) {
    r->top[unit * r->cells + cell] += top;
    r->bottom[unit * r->cells + cell] += bottom;
}

#endif
