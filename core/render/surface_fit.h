/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_fit.h: fits as JSON: the report, and materials to paste into a scene. */
#ifndef MU_SURFACE_FIT_H
#define MU_SURFACE_FIT_H

#include "core/render/error.h"
#include "core/render/json_out.h"
#include "core/surface/fit.h"

/* One line about all candidates, the best first; file: what was fitted, tabulated: a file written, or NULL. */
_Bool mu_surface_fit_report(const mu_fit *fit, const char *file, const char *tabulated, double outside,
                            FILE *out);
/* The best candidate, or flat, as a material's JSON object (not ended). */
void mu_surface_fit_material(const mu_fit *fit, mu_json *json);
/* Writes what mu_json_write would, whole or not at all. */
_Bool mu_surface_fit_save(const char *file, mu_json *json, mu_error *error);
/* A tabulated material: 128 x 128 bins around the middle of the cloud that leave as little as 1/1000 of the facets
 * outside; `outside`: their share. False if memory was short. */
_Bool mu_surface_fit_tabulate(const mu_slopes *s, mu_json *json, double *outside);

#endif
