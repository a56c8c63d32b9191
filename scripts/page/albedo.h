/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo.h: the directional albedo of the page's material, Fresnel included, by view: the other factor of the split
 * integral.
 *
 * Nodes are even in the root of the cosine and in the azimuth from the lobe's axis U to V: the page's distributions are
 * radially symmetric before M, so that what is mirrored at U or V is the same.
 */
#ifndef PAGE_ALBEDO_H
#define PAGE_ALBEDO_H

#include "scripts/page/material.h"

enum { PAGE_COSINES = 24, PAGE_AZIMUTHS = 10 };

typedef struct page_albedo {
    float rgb[PAGE_AZIMUTHS][PAGE_COSINES][4]; /* the last unused: four at a time */
} page_albedo;

/* Mean weights of `samples` directions of the material's own sampler. */
void page_albedo_make(page_albedo *table, const page_material *material, int samples);
void page_albedo_at(const page_albedo *table, const mu_ibl_lobe_f *lobe, const float wo[3], float rgb[4]);

#endif
