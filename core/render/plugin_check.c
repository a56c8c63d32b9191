/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* plugin_check.c: a plugin is somebody else's program. Before anything of it is used: are its structures as
 * long as version 1.0 of the interface had them, and are names, functions and parameters there? */
#include <string.h>

#include "core/render/plugin.h"

/* Size of a struct up to and including `member`: what version 1.0 of the interface ends with. */
#define SIZE_THROUGH(type, member) (offsetof(type, member) + sizeof(((type *)0)->member))

static _Bool check_param(const musurf_param *p, const char *type, const char *file, mu_error *error) {
    if (p->size < SIZE_THROUGH(musurf_param, choices))
        return mu_fail(error, "%s: a parameter of %s is %u bytes long; at least %zu are needed", file, type,
                       p->size, SIZE_THROUGH(musurf_param, choices));
    if (!p->name || !p->name[0] || !p->label || !p->doc || !p->unit)
        return mu_fail(error, "%s: parameter %u of %s lacks a text; a name, label, doc and unit are needed",
                       file, p->id, type);
    if (p->id == MUSURF_NO_PARAM)
        return mu_fail(error, "%s: parameter \"%s\" of %s has the id 0, which is reserved", file, p->name,
                       type);
    if (p->kind == MUSURF_CHOICE && (!p->choices || !p->choices[0] || !p->initial_choice))
        return mu_fail(error, "%s: parameter \"%s\" of %s lacks its choices or its default", file, p->name,
                       type);
    return 1;
}

static _Bool check_params(const musurf_material_type *t, const char *file, mu_error *error) {
    if (t->param_count == 0) return 1;
    if (!t->params) return mu_fail(error, "%s: %s has no parameter table", file, t->id);
    for (uint32_t i = 0; i < t->param_count; i++) {
        const musurf_param *p = mu_type_param(t, i);
        if (!check_param(p, t->id, file, error)) return 0;
        for (uint32_t j = 0; j < i; j++) {
            const musurf_param *q = mu_type_param(t, j);
            if (p->id == q->id || strcmp(p->name, q->name) == 0)
                return mu_fail(error, "%s: parameters \"%s\" and \"%s\" of %s share a name or an id", file,
                               q->name, p->name, t->id);
        }
    }
    return 1;
}

static _Bool check_type(const musurf_material_type *t, const char *vendor, const char *file,
                        mu_error *error) {
    if (!t) return mu_fail(error, "%s: one of its material types is NULL", file);
    if (t->size < SIZE_THROUGH(musurf_material_type, extension))
        return mu_fail(error, "%s: a material type is %u bytes long; at least %zu are needed", file, t->size,
                       SIZE_THROUGH(musurf_material_type, extension));
    const size_t length = strlen(vendor);
    if (!t->id || strncmp(t->id, vendor, length) != 0 || t->id[length] != '.')
        return mu_fail(error, "%s: material type \"%s\" is not of the vendor \"%s\"", file,
                       t->id ? t->id : "", vendor);
    if (!t->label || !t->doc) return mu_fail(error, "%s: %s lacks its label or doc", file, t->id);
    if (!t->compile || !t->release || !t->describe || !t->setup || !t->eval || !t->sample || !t->pdf ||
        !t->albedo || !t->blur || !t->eval_batch || !t->sample_batch || !t->extension)
        return mu_fail(error, "%s: %s lacks one of its functions", file, t->id);
    return check_params(t, file, error);
}

_Bool mu_plugin_check(const musurf_plugin *plugin, const char *vendor, const char *file, mu_error *error) {
    if (!plugin) return mu_fail(error, "%s: %s returned NULL", file, MUSURF_ENTRY_NAME);
    if (plugin->size < SIZE_THROUGH(musurf_plugin, types))
        return mu_fail(error, "%s: its plugin table is %u bytes long; at least %zu are needed", file,
                       plugin->size, SIZE_THROUGH(musurf_plugin, types));
    if (!plugin->name || !plugin->version || !plugin->license || !plugin->types || plugin->type_count == 0)
        return mu_fail(error, "%s: its plugin table lacks a name, version, license or material types", file);
    for (size_t i = 0; i < plugin->type_count; i++)
        if (!check_type(plugin->types[i], vendor, file, error)) return 0;
    return 1;
}
