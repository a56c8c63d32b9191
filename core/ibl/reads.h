/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * reads.h: techniques of image-based lighting, side by side. Each is a rule that turns a lobe and a view into a few reads of an
 * environment filtered in advance: where to look, how blurred, with what weight. In float; frame of wo, as ibl.h.
 *
 * The radiance seen is the directional albedo times the sum of the reads: weights are 1 in all, so that in even light every
 * technique gives the albedo.
 */
#ifndef MU_IBL_READS_H
#define MU_IBL_READS_H

#include "core/ibl/ibl.h"

enum { MU_IBL_READS_MOST = 64 };

typedef struct mu_ibl_read {
    float direction[3];
    float roughness; /* alpha_lin, 0 to 1: that times levels - 1 is the level, Eq. (3) */
    float weight;
} mu_ibl_read;

/* MU_IBL_SPLIT: the split integral (Karis 2013): one read, along the mirrored view, of the isotropic lobe whose roughness is
 *     the mean of both, the paper's h1.
 * MU_IBL_BENT_NORMAL: Revie 2011 as Lagarde and Golubev 2018 have it: one read, mirrored at a normal that is bent across the
 *     grain, and sharper than h1.
 * MU_IBL_MAJOR_AXIS: N reads along the axis, all alike, Eq. (5). */
typedef enum mu_ibl_technique { MU_IBL_SPLIT, MU_IBL_BENT_NORMAL, MU_IBL_MAJOR_AXIS } mu_ibl_technique;

/* How many there are, at most MU_IBL_READS_MOST: 1, or settings->samples. wo.z > 0. */
size_t mu_ibl_reads(mu_ibl_technique technique, const mu_ibl_lobe_f *lobe, const float wo[3],
                    const mu_ibl_settings_f *settings, mu_ibl_read *out);

#endif
