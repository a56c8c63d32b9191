/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_place.h: where views are in a table of albedos, and what is between its nodes (part of albedo_table.h).
 */
#ifndef MU_ALBEDO_PLACE_H
#define MU_ALBEDO_PLACE_H

#include "core/render/albedo_table.h"

/* A view in the frame of the lobe's axes: by how it is found in the table. */
typedef struct mu_albedo_place {
    float height, around; /* 0 to 1 */
} mu_albedo_place;

/* [any] A unit vector there. */
void mu_albedo_view_of(const float sigma[2], mu_albedo_place at, float w[3]);
/* [any] The row that has an azimuth. */
uint32_t mu_albedo_row_of(const mu_albedo_table *table, uint32_t azimuth);
/* [any] How many intervals of azimuths there are, of which `sharp` tells. */
uint32_t mu_albedo_intervals(const mu_albedo_table *table);
/* [any] As mu_albedo_table_at, of a table that has nodes. */
_Bool mu_albedo_interpolate(const mu_albedo_table *table, const mu_ibl_lobe_f *lobe, const float wo[3], float rgb[3]);

#endif
