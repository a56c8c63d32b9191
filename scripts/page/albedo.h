/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo.h: the directional albedo of the page's material, Fresnel included, by view: the other factor of the split
 * integral.
 *
 * Over a quarter turn from the lobe's axis U to V: the page's distributions are radially symmetric before M, so that what is
 * mirrored at U or V is the same.
 */
#ifndef PAGE_ALBEDO_H
#define PAGE_ALBEDO_H

#include "scripts/page/material.h"

enum { PAGE_COSINES = 24, PAGE_AZIMUTHS = 10 };

typedef struct page_albedo {
    float rgb[PAGE_AZIMUTHS + 2][PAGE_COSINES][4]; /* with one beyond either end; the last number unused: four at a time */
    float scale, widen[2];                         /* of heights, and along U and V: how nodes are placed */
} page_albedo;

/* By up to `samples` directions of light each. */
void page_albedo_make(page_albedo *table, const page_material *material, int samples);
/* Of several views. */
void page_albedo_at(const page_albedo *table, const mu_ibl_lobe_f *lobe, const float (*wo)[MU_IBL_AXES], float (*rgb)[4]);

#endif
