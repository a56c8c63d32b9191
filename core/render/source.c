/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* source.c: sources of a parameter's values, from JSON. */
#include "core/render/source.h"

#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/material_settings.h"
#include "core/render/source_picture.h"

static _Bool is_angle(const musurf_param *param) {
    return param->kind == MUSURF_NUMBER && !strcmp(param->unit, "radians");
}

_Bool mu_source_serves(const musurf_param *param) {
    return (param->flags & MUSURF_MAY_VARY) && (param->kind == MUSURF_NUMBER || param->kind == MUSURF_COLOR ||
                                                param->kind == MUSURF_MATRIX || param->kind == MUSURF_VECTOR);
}

_Bool mu_source_blends(const musurf_param *param) {
    return param->kind == MUSURF_NUMBER;
}

_Bool mu_source_is(const json_t *value) {
    return json_object_get(value, "texture") || json_object_get(value, "direction_map") ||
           json_object_get(value, "attribute") || json_object_get(value, "expression");
}

_Bool mu_source_texts(const mu_place *place, int count, const char **out, mu_error *error) {
    if (count == 1 && json_is_string(place->value)) return mu_place_string(place, out, error);
    if (!json_is_array(place->value) || json_array_size(place->value) != (size_t)count)
        return mu_place_fail(place, error, "must be %s%d text%s", count == 1 ? "" : "a list of ", count,
                             count == 1 ? "" : "s");
    for (int i = 0; i < count; i++) {
        const mu_place one = mu_place_element(place, (size_t)i);
        if (!mu_place_string(&one, out + i, error)) return 0;
    }
    return 1;
}

static _Bool read_pair(const mu_place *parent, const char *key, double least, double out[2],
                       mu_error *error) {
    const mu_place place = mu_place_member(parent, key);
    return !place.value || mu_place_numbers(&place, 2, least, 1e6, out, error);
}

_Bool mu_source_placement(mu_placement *out, const mu_place *place, mu_error *error) {
    static const char *const wraps[] = {"repeat", "clamp", "mirror", NULL};
    static const char *const filters[] = {"covariance", "none", NULL};
    const mu_place wrap = mu_place_member(place, "wrap"), filter = mu_place_member(place, "filter");
    size_t which = MU_WRAP_REPEAT, none = 0;
    *out = (mu_placement){.scale = {1, 1}};
    if ((wrap.value && !mu_place_choice(&wrap, wraps, &which, error)) ||
        (filter.value && !mu_place_choice(&filter, filters, &none, error)) ||
        !read_pair(place, "scale", -1e6, out->scale, error) ||
        !read_pair(place, "offset", -1e6, out->offset, error))
        return 0;
    out->wrap = (mu_wrap)which, out->filtered = !none;
    return 1;
}

static _Bool read_picture(mu_source *source, const mu_place *place, const char *key, mu_error *error) {
    static const char *const spaces[] = {"raw", "srgb", NULL};
    static const char *const of_tension[] = {"m00", "m01", "m10", "m11"};
    const mu_place file = mu_place_member(place, key), channels = mu_place_member(place, "channels"),
                   space = mu_place_member(place, "colour_space");
    const _Bool direction = source->kind == MU_SOURCE_DIRECTION;
    const char *names[MU_SOURCE_NUMBERS];
    size_t srgb = 0;
    mu_picture_request request = {.count = direction ? 2 : source->count, .range = {0, 1}};
    if (space.value && (!mu_place_choice(&space, spaces, &srgb, error))) return 0;
    if (channels.value && !mu_source_texts(&channels, request.count, names, error)) return 0;
    request.srgb = srgb == 1, request.named = channels.value != NULL;
    request.names = channels.value ? names : source->param->kind == MUSURF_MATRIX ? of_tension : NULL;
    request.param = direction ? NULL : source->param;
    return read_pair(place, "range", -1e6, request.range, error) &&
           mu_source_placement(&source->placement, place, error) &&
           mu_source_picture(&source->picture, &file, &request, source->placement.wrap, error);
}

static _Bool read_between(mu_source *source, const mu_place *place, mu_error *error) {
    double *const between = source->between;
    char range[160];
    if (!mu_place_numbers(place, 2, -DBL_MAX, DBL_MAX, between, error)) return 0;
    mu_param_range(source->param, range, sizeof range);
    for (int i = 0; i < 2; i++)
        if (!mu_param_allows(source->param, between[i]))
            return mu_place_fail(place, error, "is [%g, %g]; both must be %s", between[0], between[1], range);
    return between[0] <= between[1] ||
           mu_place_fail(place, error, "is [%g, %g]; the second must not be less", between[0], between[1]);
}

static _Bool read_attribute(mu_source *source, const mu_place *place, mu_error *error) {
    const mu_place names = mu_place_member(place, "attribute"), between = mu_place_member(place, "between");
    const char *text[MU_SOURCE_NUMBERS];
    if (!mu_source_texts(&names, source->count, text, error)) return 0;
    for (int i = 0; i < source->count; i++) {
        if (!text[i][0] || strlen(text[i]) >= MU_ATTRIBUTE_NAME)
            return mu_place_fail(&names, error, "must be a name of 1 to %d characters", MU_ATTRIBUTE_NAME - 1);
        snprintf(source->name[i], sizeof source->name[i], "%s", text[i]);
    }
    source->between[0] = -DBL_MAX, source->between[1] = DBL_MAX;
    return !between.value || read_between(source, &between, error);
}

static _Bool read_expression(mu_source *source, const mu_place *place, mu_error *error) {
    const mu_place texts = mu_place_member(place, "expression");
    const char *text[MU_SOURCE_NUMBERS];
    char why[256];
    if (!mu_source_texts(&texts, source->count, text, error)) return 0;
    source->formula = calloc((size_t)source->count, sizeof *source->formula);
    if (!source->formula) return mu_place_fail(place, error, "not enough memory");
    for (int i = 0; i < source->count; i++)
        if (!mu_expression_parse(source->formula + i, text[i], why, sizeof why))
            return mu_place_fail(&texts, error, "\"%.60s\" is no formula such as \"0.1 + 0.2*u\": it %s",
                                 text[i], why);
    return 1;
}

_Bool mu_source_read(mu_source *source, const musurf_param *param, const mu_place *place, mu_error *error) {
    static const char *const any[] = {"texture",  "direction_map", "attribute", "expression",
                                      "channels", "range",         "wrap",      "colour_space",
                                      "scale",    "offset",        "filter",    "between", NULL};
    static const char *const of_attribute[] = {"attribute", "between", NULL},
                      *const of_expression[] = {"expression", NULL};
    *source = (mu_source){.param = param, .count = (int)mu_kind_numbers(param->kind)};
    if (!mu_place_only(place, any, error)) return 0;
    if (!mu_source_serves(param) && !mu_source_blends(param))
        return mu_place_fail(place, error, "%s cannot vary over the surface: a constant is needed",
                             param->name);
    _Bool good;
    if (json_object_get(place->value, "attribute")) {
        source->kind = MU_SOURCE_ATTRIBUTE;
        good = mu_place_only(place, of_attribute, error) && read_attribute(source, place, error);
    } else if (json_object_get(place->value, "expression")) {
        source->kind = MU_SOURCE_EXPRESSION;
        good = mu_place_only(place, of_expression, error) && read_expression(source, place, error);
    } else if (json_object_get(place->value, "direction_map")) {
        const mu_place map = mu_place_member(place, "direction_map");
        source->kind = MU_SOURCE_DIRECTION;
        good = (is_angle(param) ||
                mu_place_fail_key(&map, error, "gives an angle, which %s is not", param->name)) &&
               (!json_object_get(place->value, "texture") ||
                mu_place_fail_key(&map, error, "set texture or direction_map, not both")) &&
               read_picture(source, place, "direction_map", error);
    } else if (json_object_get(place->value, "texture")) {
        good = read_picture(source, place, "texture", error);
    } else {
        good = mu_place_fail(place, error,
                             "needs a \"texture\", an \"attribute\", an \"expression\" or, of an angle, a "
                             "\"direction_map\"; or is a constant");
    }
    if (!good) mu_source_free(source);
    return good;
}

void mu_source_free(mu_source *source) {
    mu_mipmap_free(&source->picture);
    free(source->formula);
    source->formula = NULL;
}

_Bool mu_source_is_constant(const mu_source *source, double *values) {
    const mu_mipmap *p = &source->picture;
    if (source->kind != MU_SOURCE_TEXTURE) return 0;
    const size_t count = (size_t)p->level[0].width * (size_t)p->level[0].height,
                 bytes = (size_t)p->channels * sizeof(float);
    for (size_t i = 1; i < count; i++)
        if (memcmp(p->texels, p->texels + i * (size_t)p->channels, bytes)) return 0;
    for (int c = 0; c < p->channels; c++) values[c] = (double)p->texels[c];
    return 1;
}

json_t *mu_source_schema(const musurf_param *param, json_t *number) {
    const int count = (int)mu_kind_numbers(param->kind);
    json_t *texts = json_pack("{s:s, s:{s:s}, s:i, s:i}", "type", "array", "items", "type", "string",
                              "minItems", count, "maxItems", count);
    json_t *text = count == 1 ? json_pack("{s:[{s:s}, o]}", "anyOf", "type", "string", texts) : texts;
    json_t *pair = json_pack("{s:s, s:{s:s, s:f, s:f}, s:i, s:i}", "type", "array", "items", "type", "number",
                             "minimum", -1e6, "maximum", 1e6, "minItems", 2, "maxItems", 2);
    json_t *placed = json_pack("{s:{s:[s,s]}, s:{s:[s,s,s]}, s:{s:[s,s]}, s:O, s:O, s:O}", "colour_space",
                               "enum", "raw", "srgb", "wrap", "enum", "repeat", "clamp", "mirror", "filter",
                               "enum", "covariance", "none", "scale", pair, "offset", pair, "range", pair);
    json_decref(pair);
    json_t *kinds = json_array();
    for (int k = 0; k < (is_angle(param) ? 2 : 1); k++) {
        json_t *properties = json_copy(placed);
        json_t *names = json_pack("{s:s, s:{s:s}, s:i, s:i}", "type", "array", "items", "type", "string",
                                  "minItems", k ? 2 : count, "maxItems", k ? 2 : count);
        json_object_set_new(properties, k ? "direction_map" : "texture",
                            json_pack("{s:s}", "type", "string"));
        json_object_set(properties, "channels", k || count > 1 ? names : text);
        json_decref(names);
        json_array_append_new(kinds, json_pack("{s:s, s:o, s:[s], s:b}", "type", "object", "properties",
                                               properties, "required", k ? "direction_map" : "texture",
                                               "additionalProperties", 0));
    }
    json_decref(placed);
    json_array_append_new(kinds, json_pack("{s:s, s:{s:O, s:{s:s, s:o, s:i, s:i}}, s:[s], s:b}", "type", "object",
                                           "properties", "attribute", text, "between", "type", "array", "items", number,
                                           "minItems", 2, "maxItems", 2, "required", "attribute", "additionalProperties", 0));
    json_array_append_new(kinds, json_pack("{s:s, s:{s:O}, s:[s], s:b}", "type", "object", "properties",
                                           "expression", text, "required", "expression", "additionalProperties", 0));
    json_decref(text);
    return kinds;
}
