/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * surroundings.h: what lights the sphere: radiance from all directions, filtered for every roughness
 * (core/ibl/globe.h). World space, +z up, azimuths counter-clockwise from +x.
 */
#ifndef PAGE_SURROUNDINGS_H
#define PAGE_SURROUNDINGS_H

#include "core/ibl/globe.h"
#include "scripts/page/page.h"

struct page_surroundings {
    mu_ibl_globe globe;
    float *memory;
};

#endif
