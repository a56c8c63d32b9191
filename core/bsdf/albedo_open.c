/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_open.c: what a compensated surface loses where its tables are open: the quadrature that they are made of, while
 * shading. E of tilted glass under a strong M jumps along curves that no cells are fine enough for: there it takes as long as a
 * hundred evaluations or more, on the stack, and is as right as elsewhere. Not in the papers.
 */
#include "core/bsdf/albedo_maker.h"
#include "core/bsdf/albedo_set.h"
#include "core/bsdf/distribution.h"

#if MU_REAL_BITS == 24

float mu_albedo_lost_at(const mu_lobe *l, int side, const float w[3]) {
    const albedo_open *const open = l->set->open;
    const float c = open->turn[0], s = open->turn[1], up = side ? -1.0f : 1.0f,
                at[3] = {up * (c * w[0] + s * w[1]), up * (c * w[1] - s * w[0]), up * w[2]};
    albedo_source source = open->source;
    albedo_effort effort = {0, 0};
    closure single;
    source.effort = &effort, source.blur = l->blur;
    if (!mu_albedo_bind(&source, at, &single)) return 1;
    return fmaxf(mu_albedo_lost(&source, &single), ALBEDO_LEAST);
}

#endif
