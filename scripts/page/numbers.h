/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* numbers.h: the settings of the axis as the page hands them over, and the axis they give in double. */
#ifndef PAGE_NUMBERS_H
#define PAGE_NUMBERS_H

#include "scripts/page/material.h"

/* Numbers of a query. Directions are unit vectors. */
enum {
    PAGE_WO,
    PAGE_WI = PAGE_WO + 3,
    PAGE_K = PAGE_WI + 3,
    PAGE_BETA,
    PAGE_SAMPLES,
    PAGE_SHIFT, /* mu_ibl_shift */
    PAGE_QUERY_NUMBERS
};

mu_ibl_settings_d page_settings(const double *query);

#endif
