/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* plugin.h: what mu_plugins (material.h) is made of, for those who look at whole plugins. */
#ifndef MU_PLUGIN_H
#define MU_PLUGIN_H

#include "core/render/material.h"

/* The plugin vendor_material.so, opened now unless it is open already; *file is where it was found (may be
 * NULL). */
const musurf_plugin *mu_plugins_vendor(mu_plugins *plugins, const char *vendor, const char **file,
                                       mu_error *error);

/* Whether everything that the host will touch is there, so that a plugin built against another interface is
 * refused with a line instead of crashing later. */
_Bool mu_plugin_check(const musurf_plugin *plugin, const char *vendor, const char *file, mu_error *error);

/* The index-th parameter; the table's stride is its own, which may be larger than ours. */
static inline const musurf_param *mu_type_param(const musurf_material_type *type, size_t index) {
    return (const musurf_param *)(const void *)((const char *)type->params + index * type->params->size);
}

/* How many numbers make up a value of this kind; 0 for text. */
static inline size_t mu_kind_numbers(musurf_kind kind) {
    return kind == MUSURF_NUMBER || kind == MUSURF_FLAG ? 1
           : kind == MUSURF_COLOR                       ? 3
           : kind == MUSURF_MATRIX                      ? 4
           : kind == MUSURF_VECTOR                      ? 2
           : kind == MUSURF_MATRIX3                     ? 9
           : kind == MUSURF_FOOTPRINT                   ? 6
                                                        : 0;
}

#endif
