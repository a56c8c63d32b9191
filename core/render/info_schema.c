/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * info_schema.c: the JSON Schema (draft 2020-12) of a material, made from its plugin's parameter table by the
 * very rules by which material_settings.c reads one.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/render/info.h"
#include "core/render/jacobian.h"
#include "core/render/material_grid.h"
#include "core/render/material_settings.h"
#include "core/render/normal_map.h"

enum { LONGEST_NAME = 128 };

static json_t *number_schema(const musurf_param *p) {
    json_t *schema = json_pack("{s:s}", "type", "number");
    if (isfinite(p->min))
        json_object_set_new(schema, p->flags & MUSURF_MIN_EXCLUDED ? "exclusiveMinimum" : "minimum",
                            json_real(p->min));
    if (isfinite(p->max))
        json_object_set_new(schema, p->flags & MUSURF_MAX_EXCLUDED ? "exclusiveMaximum" : "maximum",
                            json_real(p->max));
    return schema;
}

static json_t *array_schema(json_t *items, int count) {
    return json_pack("{s:s, s:o, s:i, s:i}", "type", "array", "items", items, "minItems", count, "maxItems",
                     count);
}

static json_t *plain_schema(const musurf_param *p) {
    switch (p->kind) {
    case MUSURF_NUMBER:
        return number_schema(p);
    case MUSURF_COLOR:
        return json_pack("{s:[o, o]}", "anyOf", number_schema(p), array_schema(number_schema(p), 3));
    case MUSURF_MATRIX:
        return array_schema(array_schema(number_schema(p), 2), 2);
    case MUSURF_VECTOR:
        return array_schema(number_schema(p), 2);
    case MUSURF_MATRIX3:
        return array_schema(array_schema(number_schema(p), 3), 3);
    case MUSURF_GRID:
        return mu_grid_schema(p);
    case MUSURF_FOOTPRINT:
        return array_schema(array_schema(number_schema(p), 2), 3);
    case MUSURF_FLAG:
        return json_pack("{s:s}", "type", "boolean");
    case MUSURF_CHOICE: {
        json_t *choices = json_array();
        for (const char *const *c = p->choices; *c; c++) json_array_append_new(choices, json_string(*c));
        return json_pack("{s:o}", "enum", choices);
    }
    default:
        return json_false(); /* matches nothing */
    }
}

static json_t *members_schema(const musurf_material_type *type, const char *prefix);

/* What may stand for `name`: the plain value, an object of the parameters below it, or both. */
static json_t *value_schema(const musurf_material_type *type, const char *name) {
    const musurf_param *p = mu_type_find(type, name);
    json_t *members = members_schema(type, name), *schema;
    const _Bool nested = json_object_size(json_object_get(members, "properties")) > 0;
    if (!p) return members;
    if (nested) {
        /* An object under a choice names exactly one of the choices; other members may accompany it. */
        if (p->kind == MUSURF_CHOICE) {
            json_t *one = json_array(), *properties = json_object_get(members, "properties");
            for (const char *const *c = p->choices; *c; c++)
                if (json_object_get(properties, *c))
                    json_array_append_new(one, json_pack("{s:[s]}", "required", *c));
            /* None is legal where other parameters lie below, such as n and k of a conductor. */
            if (json_array_size(one) == json_object_size(properties))
                json_object_set_new(members, "oneOf", one);
            else
                json_decref(one);
            json_object_set_new(members, "minProperties", json_integer(1));
        }
        schema = json_pack("{s:[o, o]}", "anyOf", plain_schema(p), members);
    } else {
        json_decref(members);
        schema = plain_schema(p);
        if (mu_source_serves(p) || mu_source_blends(p)) {
            json_t *any = mu_source_schema(p, number_schema(p));
            json_array_insert_new(any, 0, schema);
            schema = json_pack("{s:o}", "anyOf", any);
        }
    }
    json_object_set_new(schema, "title", json_string(p->label));
    json_object_set_new(schema, "description",
                        p->unit[0] ? json_sprintf("%s [%s]", p->doc, p->unit) : json_string(p->doc));
    return schema;
}

/* The object whose members are the parameters below `prefix`; no others are allowed. */
static json_t *members_schema(const musurf_material_type *type, const char *prefix) {
    json_t *properties = json_object();
    const size_t length = strlen(prefix);
    for (uint32_t i = 0; i < type->param_count; i++) {
        const char *name = mu_type_param(type, i)->name;
        if (length > 0 && (strncmp(name, prefix, length) != 0 || name[length] != '.')) continue;
        const char *const rest = name + (length > 0 ? length + 1 : 0);
        char part[LONGEST_NAME], whole[LONGEST_NAME];
        snprintf(part, sizeof part, "%.*s", (int)strcspn(rest, "."), rest);
        if (json_object_get(properties, part)) continue;
        snprintf(whole, sizeof whole, "%.*s", (int)((size_t)(rest - name) + strlen(part)), name);
        json_object_set_new(properties, part, value_schema(type, whole));
    }
    return json_pack("{s:s, s:o, s:b}", "type", "object", "properties", properties, "additionalProperties",
                     0);
}

json_t *mu_info_schema(const musurf_material_type *type) {
    json_t *schema = members_schema(type, "");
    json_t *properties = json_object_get(schema, "properties");
    json_object_set_new(properties, "material", json_pack("{s:s}", "const", type->id));
    const musurf_param *transform = mu_type_find(type, "transform");
    if (transform && transform->kind == MUSURF_MATRIX && (transform->flags & MUSURF_MAY_VARY))
        json_object_set_new(properties, "jacobian", mu_jacobian_schema());
    json_object_set_new(properties, "normal_map", mu_normal_map_schema());
    json_object_set_new(schema, "required", json_pack("[s]", "material"));
    json_object_set_new(schema, "title", json_string(type->label));
    json_object_set_new(schema, "description", json_string(type->doc));
    json_object_set_new(schema, "$schema", json_string("https://json-schema.org/draft/2020-12/schema"));
    return schema;
}
