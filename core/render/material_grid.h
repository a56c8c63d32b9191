/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* material_grid.h: a parameter of the kind MUSURF_GRID, as scene files write it. */
#ifndef MU_MATERIAL_GRID_H
#define MU_MATERIAL_GRID_H

#include "core/render/document.h"
#include "plugin/musurf_plugin.h"

/* The values of a setting of this kind, to be freed, and how many; NULL on failure. Any of
 *     {"bounds": [x_min, x_max, y_min, y_max], "weights": [[...], ...]}      a row per y, from y_min on; "columns" and "rows" may
 *                                                                            say how many there are
 *     {"bounds": [...], "file": "slopes.exr"}                                a one-channel OpenEXR image, a scanline per row
 *     {"heightfield": "h.exr", "bins": 128, "range": [...]}                  the slopes of a periodic heightfield's triangles,
 *                                                                            within bounds that all of them set if none are given
 * File names are relative to the document. */
double *mu_grid_read(const musurf_param *param, const mu_place *place, size_t *count, mu_error *error);

/* What may stand there, as a JSON Schema. */
json_t *mu_grid_schema(const musurf_param *param);

#endif
