/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* info.h: what `musurf info` shows: the build, and a material type's parameters as a table, as JSON, as a
 * JSON Schema. */
#ifndef MU_INFO_H
#define MU_INFO_H

#include "core/render/plugin.h"

/* {"version", "compiler", "abi", "libraries": {...}}; NULL without memory. */
json_t *mu_info_build(void);
/* The type's parameter table; NULL without memory. */
json_t *mu_info_params(const musurf_material_type *type);
/* A JSON Schema (draft 2020-12) of the objects that mu_material_read takes for this type; NULL without
 * memory. */
json_t *mu_info_schema(const musurf_material_type *type);

#endif
