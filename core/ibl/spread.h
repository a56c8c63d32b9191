/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* spread.h: reads all over a lobe (spread.c). For reads.c. */
#ifndef MU_IBL_SPREAD_H
#define MU_IBL_SPREAD_H

#include "core/ibl/reads.h"

size_t mu_ibl_spread_reads(const mu_ibl_plan *plan, size_t phase, const mu_ibl_lobe_f *lobe, const float wo[3],
                           mu_ibl_read *out);
/* The very same of up to MU_IBL_AXES views, view i of lobes[i * stride], several at a time. */
void mu_ibl_spread_views(const mu_ibl_plan *plan, size_t phase, size_t views, const mu_ibl_lobe_f *lobes, size_t stride,
                         const float (*wo)[MU_IBL_AXES], mu_ibl_view *out);

#endif
