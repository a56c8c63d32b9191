/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * material.h: the material that the page's controls describe, compiled by core/bsdf for float and for double.
 */
#ifndef PAGE_MATERIAL_H
#define PAGE_MATERIAL_H

#include "core/ibl/ibl.h"
#include "scripts/page/page.h"

struct page_material {
    mu_definition definition;
    mu_complaint why; /* of what was refused */
    void *memory;
    const mu_surface_f *shaded; /* pictures */
    const mu_surface_d *exact;  /* numbers */
    mu_ibl_lobe_f lobe;
    mu_ibl_lobe_d lobe_exact; /* its turn is the cosine and sine of `angle`, as `musurf ibl axis` makes it */
    double angle;
};

/* The numbers that page_material_set takes. */
enum {
    PAGE_NDF,
    PAGE_ROUGHNESS, /* perceptual: alpha is its square */
    PAGE_GAMMA,
    PAGE_EXPONENT,
    PAGE_TRANSFORM, /* four: rows of M */
    PAGE_MASKING = PAGE_TRANSFORM + 4,
    PAGE_METAL, /* of mu_metal_names, counted from 1; 0: F = 1 */
    PAGE_MATERIAL_NUMBERS
};

#endif
