/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* info_params.c: a plugin's parameter table as JSON, nothing added and nothing left out. */
#include <math.h>

#include "core/render/info.h"

static const char *kind_name(musurf_kind kind) {
    switch (kind) {
    case MUSURF_NUMBER:
        return "number";
    case MUSURF_COLOR:
        return "color";
    case MUSURF_MATRIX:
        return "matrix";
    case MUSURF_VECTOR:
        return "vector";
    case MUSURF_MATRIX3:
        return "matrix3";
    case MUSURF_GRID:
        return "grid";
    case MUSURF_FOOTPRINT:
        return "footprint";
    case MUSURF_CHOICE:
        return "choice";
    case MUSURF_FLAG:
        return "flag";
    default:
        return "unknown";
    }
}

static json_t *number(double value) {
    return isfinite(value) ? json_real(value) : json_null();
}

/* As a scene file would write it. */
static json_t *initial(const musurf_param *p) {
    const double *v = p->initial;
    if (p->flags & MUSURF_NO_DEFAULT) return json_null();
    switch (p->kind) {
    case MUSURF_NUMBER:
        return number(v[0]);
    case MUSURF_COLOR:
        return json_pack("[o, o, o]", number(v[0]), number(v[1]), number(v[2]));
    case MUSURF_MATRIX:
        return json_pack("[[o, o], [o, o]]", number(v[0]), number(v[1]), number(v[2]), number(v[3]));
    case MUSURF_VECTOR:
        return json_pack("[o, o]", number(v[0]), number(v[1]));
    case MUSURF_CHOICE:
        return json_string(p->initial_choice);
    case MUSURF_FLAG:
        return json_boolean(v[0] != 0);
    default:
        return json_null();
    }
}

static json_t *one(const musurf_param *p) {
    json_t *entry = json_pack("{s:s, s:s, s:s, s:s, s:s, s:o, s:b}", "name", p->name, "kind",
                              kind_name(p->kind), "label", p->label, "doc", p->doc, "unit", p->unit,
                              "default", initial(p), "may_vary", (p->flags & MUSURF_MAY_VARY) != 0);
    if (!entry) return NULL;
    if (p->kind == MUSURF_CHOICE) {
        json_t *choices = json_array();
        for (const char *const *c = p->choices; *c; c++) json_array_append_new(choices, json_string(*c));
        json_object_set_new(entry, "choices", choices);
    } else if (p->kind != MUSURF_FLAG) {
        json_object_set_new(entry, "min", number(p->min));
        json_object_set_new(entry, "max", number(p->max));
        json_object_set_new(entry, "min_excluded", json_boolean(p->flags & MUSURF_MIN_EXCLUDED));
        json_object_set_new(entry, "max_excluded", json_boolean(p->flags & MUSURF_MAX_EXCLUDED));
        json_object_set_new(entry, "soft_min", number(p->soft_min));
        json_object_set_new(entry, "soft_max", number(p->soft_max));
    }
    return entry;
}

json_t *mu_info_params(const musurf_material_type *type) {
    json_t *all = json_array();
    for (uint32_t i = 0; i < type->param_count; i++) json_array_append_new(all, one(mu_type_param(type, i)));
    return all;
}
