/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * shape_invariant.h: what a distribution of slopes in units of alpha has no need to say: no constants, no table (the f of
 * Atanasov et al. 2022, Eq. (6), has none; "shape-invariant" in Heitz 2014, "Understanding the masking-shadowing function in
 * microfacet-based BRDFs"). Included by such a distribution's file.
 */
#ifndef MU_SHAPE_INVARIANT_H
#define MU_SHAPE_INVARIANT_H

#include "core/bsdf/distribution.h"

static size_t table_bytes(const mu_definition *d) {
    (void)d;
    return 0;
}

static double prepare(base *b, const mu_definition *d, void *table) {
    (void)b, (void)table;
    return d->alpha;
}

#endif
