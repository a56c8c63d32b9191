/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_table.h: the directional albedo of a material, Fresnel included, as a table over views and, where M varies, over the
 * two roughnesses that a picture meets, to 1e-3. Made through the ABI alone.
 *
 * Views are in the frame of the lobe's axes U and V. For a microsurface that is radially symmetric before M that is exact; one that
 * is not (a histogram, a tilt) has no table under an M that varies, and one whose albedo has creases none along these: there it is to be
 * integrated (albedo_source.h).
 */
#ifndef MU_ALBEDO_TABLE_H
#define MU_ALBEDO_TABLE_H

#include "core/ibl/ibl.h"
#include "core/render/material.h"
#include "plugin/musurf_map.h"
#include "plugin/musurf_slopes.h"

typedef struct mu_albedo_table {
    uint32_t heights, azimuths; /* of views: nodes from the horizon on, and around */
    uint32_t rows;              /* azimuths that there are nodes for: all, or those of a quarter turn and its end */
    uint32_t sigmas[2];         /* nodes evenly in ln sigma along U and V; 1: it does not vary */
    float least[2], step[2];
    float *rgb;           /* NULL: no table is near enough, or worth while */
    _Bool drawn;          /* by samples, for want of anything better: where it does not hold, too */
    unsigned char *sharp; /* views between nodes where it is not, azimuth by azimuth; NULL: it is */
} mu_albedo_table;

/* `map`: NULL for a constant M, of lobe `low`; else sigmas lie between those of `low` and `high`, and `still` are the
 * moments before M. `hits`: how often it will be asked; below the number of nodes, none are made. */
_Bool mu_albedo_table_make(mu_albedo_table *table, const mu_material *material, const musurf_map *map,
                           const musurf_moments *still, const mu_ibl_lobe_f *low, const mu_ibl_lobe_f *high,
                           uint64_t hits, uint32_t threads, mu_error *error);
void mu_albedo_table_free(mu_albedo_table *table);
size_t mu_albedo_table_bytes(const mu_albedo_table *table);

/* [any] wo in the frame that the lobe is in. False: it is not known to 1e-3. */
_Bool mu_albedo_table_at(const mu_albedo_table *table, const mu_ibl_lobe_f *lobe, const float wo[3],
                        float rgb[3]);

#endif
