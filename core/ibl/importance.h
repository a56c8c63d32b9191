/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* importance.h: reads by filtered importance sampling (importance.c). For reads.c. */
#ifndef MU_IBL_IMPORTANCE_H
#define MU_IBL_IMPORTANCE_H

#include "core/ibl/reads.h"

/* Of the largest square number up to `count`, which is returned. */
size_t mu_ibl_importance_make(size_t count, mu_ibl_grid *grid);
size_t mu_ibl_importance_reads(const mu_ibl_grid *grid, size_t count, const mu_ibl_lobe_f *lobe, const float wo[3],
                               mu_ibl_read *out);

#endif
