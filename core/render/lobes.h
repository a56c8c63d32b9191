/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * lobes.h: the lobe of a material at a hit: its slopes' covariance by its axes, and their mean, in the frame of shading
 * (core/ibl/ibl.h).
 */
#ifndef MU_LOBES_H
#define MU_LOBES_H

#include "core/ibl/reads.h"
#include "core/render/shading.h"
#include "plugin/musurf_slopes.h"

typedef struct mu_lobe_source {
    const musurf_map *map;  /* NULL: M is constant, and so is the lobe */
    musurf_moments moments; /* before M, where it varies */
    mu_ibl_lobe_f lobe;     /* where it does not */
    float tail[MU_IBL_TAIL];
} mu_lobe_source;

_Bool mu_lobe_source_make(mu_lobe_source *source, const mu_named_material *named, mu_error *error);
/* [any] False: M cannot be told, or is singular. */
_Bool mu_lobe_at(const mu_lobe_source *source, const mu_shading *shading, mu_ibl_lobe_f *lobe);

#endif
