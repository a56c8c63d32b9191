/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_source.h: a bound closure as even_light.h asks it, through the ABI alone.
 */
#ifndef MU_ALBEDO_SOURCE_H
#define MU_ALBEDO_SOURCE_H

#include "core/render/even_light.h"
#include "plugin/musurf_slopes.h"

typedef struct mu_albedo_bound {
    const musurf_material_type *type;
    void *closure;
    const musurf_slopes *slopes; /* NULL: the type has none */
} mu_albedo_bound;

/* Both are borrowed; the lobe is left out where directions in float are too few for it. */
mu_even_source mu_albedo_source(mu_albedo_bound *bound, const mu_ibl_lobe_d *lobe);

#endif
