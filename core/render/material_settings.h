/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* material_settings.h: a JSON object turned into a plugin's settings by the plugin's own parameter table. */
#ifndef MU_MATERIAL_SETTINGS_H
#define MU_MATERIAL_SETTINGS_H

#include "core/render/plugin.h"
#include "core/render/source.h"

typedef struct mu_settings {
    const musurf_material_type *type;
    musurf_setting *items; /* room for each parameter of the table */
    double (*values)[9];   /* items[i].values points to values[i] */
    double **grids;        /* of MUSURF_GRID: items[i].values points to grids[i]; NULL elsewhere */
    size_t count;
    mu_source *sources; /* of the settings in slots, in the order of these */
    size_t source_count;
    mu_source blended[MU_BLENDED]; /* of parameters that the plugin wants constant (blend.h) */
    int blended_count;
} mu_settings;

/* Whether a number is in the parameter's range, and that in words. */
_Bool mu_param_allows(const musurf_param *param, double value);
void mu_param_range(const musurf_param *param, char *out, size_t size);

/* Reads every member of the object at `place`, except the NULL-terminated `reserved` ones. Text is borrowed
 * from the document. On failure there is nothing to free. */
_Bool mu_settings_read(mu_settings *settings, const musurf_material_type *type, const mu_place *place,
                       const char *const *reserved, mu_error *error);
void mu_settings_free(mu_settings *settings);

/* NULL if there is none. */
const musurf_param *mu_type_find(const musurf_material_type *type, const char *name);
const musurf_param *mu_type_find_id(const musurf_material_type *type, uint32_t id);
musurf_setting *mu_settings_find(const mu_settings *settings, const musurf_param *param);
/* Adds a setting with zeros for values; there must be none of this parameter yet. */
musurf_setting *mu_settings_add(mu_settings *settings, const musurf_param *param);

/* The source of a parameter that the plugin refuses in a slot becomes a blended one; false: it has none, or as many as there may
 * be are blended already. Its setting is a constant then, of values to be filled in. */
_Bool mu_settings_blend(mu_settings *settings, uint32_t param);

/* Fails at the place of parameter `name` in the object at `place`, or at the object if it is not given there.
 */
_Bool mu_settings_fail(const mu_place *place, const char *name, mu_error *error, const char *text);

#endif
