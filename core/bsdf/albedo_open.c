/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_open.c: what a compensated surface loses where no table is near enough: the quadrature that tables are made of, while
 * shading. E of tilted glass under a strong M jumps along curves that no cells are fine enough for; and of an M of the point,
 * unless what reflects is level, each M has an E of its own. There it takes as long as a hundred evaluations or more, on the stack,
 * and is as right as elsewhere. Not in the papers.
 */
#include "core/bsdf/albedo_maker.h"
#include "core/bsdf/albedo_set.h"
#include "core/bsdf/distribution.h"

#if MU_REAL_BITS == 24

int mu_albedo_bind_at(const albedo_open *open, const mu_lobe *l, int side, const float w[3],
                      closure *single) {
    const float *const turn = l->moved ? l->turn : open->turn, c = turn[0], s = turn[1],
                       up = side ? -1.0f : 1.0f,
                       at[3] = {up * (c * w[0] + s * w[1]), up * (c * w[1] - s * w[0]), up * w[2]};
    albedo_source source = open->source;
    source.transform = l->moved ? l->transform : NULL, source.blur = l->moved ? 0 : l->blur;
    return mu_albedo_bind(&source, at, single);
}

float mu_albedo_lost_at(const mu_lobe *l, int side, const float w[3]) {
    const albedo_open *const open = l->moved && l->blur > 0 ? l->set->other : l->set->open;
    albedo_source source = open->source;
    albedo_effort effort = {0, 0};
    closure single;
    source.effort = &effort;
    if (!mu_albedo_bind_at(open, l, side, w, &single)) return 1;
    return fmaxf(mu_albedo_lost(&source, &single), ALBEDO_LEAST);
}

#endif
