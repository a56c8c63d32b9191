/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * even_light.h: the directional albedo of whatever can be evaluated and drawn from: how much of even light it reflects to wo.
 * Frame of the surface.
 */
#ifndef MU_EVEN_LIGHT_H
#define MU_EVEN_LIGHT_H

#include <stddef.h>

#include "core/ibl/even.h"

/* What is asked, seen from one wo. */
typedef struct mu_even_source {
    void *context;
    mu_ibl_toward toward; /* f cos of r, g, b; of no delta lobe */
    void (*drawn)(void *context, const double u[3], double rgb[3]);   /* weight of a sample; 0 below the horizon */
    const mu_ibl_lobe_d *lobe; /* where light comes from, roughly; NULL: not known, or there are delta lobes: by samples alone */
    _Bool (*known)(void *context, double enough, double rgb[3]); /* itself knows all of it (musurf_slopes.h); NULL: does not */
} mu_even_source;

/* Means of batches, and the largest standard error of them. */
typedef struct mu_even_mean {
    double rgb[3], error;
} mu_even_mean;

/* To `enough`, or by `most` calls. */
typedef struct mu_even_effort {
    double enough;
    size_t most;
} mu_even_effort;
mu_even_mean mu_even_light(const mu_even_source *source, const double wo[3], const mu_even_effort *effort);

/* By some 2 batches `each` calls, half of them of either kind if both are possible: the better of both. In `batches` lattices, each
 * shifted at random. */
mu_even_mean mu_even_light_shifted(const mu_even_source *source, const double wo[3], size_t batches, size_t each,
                                   unsigned long long seed, unsigned long long index);

#endif
