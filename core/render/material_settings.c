/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * material_settings.c: JSON → settings, with nothing known about any material but its parameter table.
 *
 *     "alpha": 0.2                            parameter "alpha"
 *     "histogram": {"bounds": ..., ...}       a grid: see material_grid.h
 *     "fresnel": "none"                       choice parameter "fresnel" = "none"
 *     "fresnel": {"schlick": [1, 0.8, 0.3]}   "fresnel" = "schlick", and the parameter "fresnel.schlick"
 *     "fresnel": {"conductor": {"n": 1.5}}    "fresnel" = "conductor", and the parameter
 * "fresnel.conductor.n"
 */
#include "core/render/material_settings.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/material_grid.h"

enum { LONGEST_NAME = 128 };

const musurf_param *mu_type_find(const musurf_material_type *type, const char *name) {
    for (uint32_t i = 0; i < type->param_count; i++)
        if (strcmp(mu_type_param(type, i)->name, name) == 0) return mu_type_param(type, i);
    return NULL;
}

const musurf_param *mu_type_find_id(const musurf_material_type *type, uint32_t id) {
    for (uint32_t i = 0; i < type->param_count; i++)
        if (mu_type_param(type, i)->id == id) return mu_type_param(type, i);
    return NULL;
}

musurf_setting *mu_settings_find(const mu_settings *settings, const musurf_param *param) {
    for (size_t i = 0; i < settings->count; i++)
        if (settings->items[i].param == param->id) return settings->items + i;
    return NULL;
}

musurf_setting *mu_settings_add(mu_settings *settings, const musurf_param *param) {
    const size_t at = settings->count++;
    memset(settings->values[at], 0, sizeof settings->values[at]);
    settings->items[at] = (musurf_setting){.size = sizeof settings->items[at],
                                           .param = param->id,
                                           .source = MUSURF_CONSTANT,
                                           .values = settings->values[at]};
    return settings->items + at;
}

/* Whether `name` begins with `prefix` and a dot; an empty prefix begins everything. */
static const char *below(const char *name, const char *prefix) {
    const size_t length = strlen(prefix);
    if (length == 0) return name;
    return strncmp(name, prefix, length) == 0 && name[length] == '.' ? name + length + 1 : NULL;
}

static _Bool any_below(const musurf_material_type *type, const char *prefix) {
    for (uint32_t i = 0; i < type->param_count; i++)
        if (below(mu_type_param(type, i)->name, prefix)) return 1;
    return 0;
}

static _Bool is_in(const char *word, const char *const *list) {
    for (; list && *list; list++)
        if (strcmp(word, *list) == 0) return 1;
    return 0;
}

static size_t length_of(const char *const *list) {
    size_t n = 0;
    while (list && list[n]) n++;
    return n;
}

/* Refuses members of the object that are neither in `others` nor the next part of a parameter name below
 * `prefix`. */
static _Bool check_members(const musurf_material_type *type, const char *prefix, const char *const *others,
                           const mu_place *place, mu_error *error) {
    const size_t most = type->param_count, extra = length_of(others);
    const char **known = calloc(most + extra + 1, sizeof *known);
    char(*parts)[LONGEST_NAME] = calloc(most + 1, sizeof *parts);
    _Bool good = known && parts;
    if (!good) {
        mu_place_fail(place, error, "not enough memory");
    } else {
        size_t count = 0;
        for (size_t i = 0; i < extra; i++) known[count++] = others[i];
        for (size_t i = 0; i < most; i++) {
            const char *const rest = below(mu_type_param(type, i)->name, prefix);
            if (!rest) continue;
            snprintf(parts[i], sizeof parts[i], "%.*s", (int)strcspn(rest, "."), rest);
            if (!is_in(parts[i], known)) known[count++] = parts[i];
        }
        good = mu_place_only(place, known, error);
    }
    free(known);
    free(parts);
    return good;
}

void mu_param_range(const musurf_param *p, char *out, size_t size) {
    char low[64] = "", high[64] = "";
    if (isfinite(p->min))
        snprintf(low, sizeof low, p->flags & MUSURF_MIN_EXCLUDED ? "above %.10g" : "at least %.10g", p->min);
    if (isfinite(p->max))
        snprintf(high, sizeof high, p->flags & MUSURF_MAX_EXCLUDED ? "below %.10g" : "at most %.10g", p->max);
    snprintf(out, size, "%s%s%s", low, low[0] && high[0] ? " and " : "", high);
}

_Bool mu_param_allows(const musurf_param *p, double x) {
    const _Bool low = p->flags & MUSURF_MIN_EXCLUDED ? x <= p->min : x < p->min;
    const _Bool high = p->flags & MUSURF_MAX_EXCLUDED ? x >= p->max : x > p->max;
    return !low && !high;
}

static _Bool read_number(const musurf_param *p, const mu_place *place, double *out, mu_error *error) {
    if (!mu_place_number(place, -INFINITY, INFINITY, out, error)) return 0;
    if (mu_param_allows(p, *out)) return 1;
    char range[160];
    mu_param_range(p, range, sizeof range);
    return mu_place_fail(place, error, "is %.10g; it must be %s%s%s", *out, range, p->unit[0] ? " " : "",
                         p->unit);
}

static _Bool read_numbers(const musurf_param *p, const mu_place *place, size_t count, double *out,
                          mu_error *error) {
    for (size_t i = 0; i < count; i++) {
        const mu_place element = mu_place_element(place, i);
        if (!read_number(p, &element, out + i, error)) return 0;
    }
    return 1;
}

static _Bool is_array_of(const json_t *value, size_t count) {
    return json_is_array(value) && json_array_size(value) == count;
}

static _Bool read_color(const musurf_param *p, const mu_place *place, double *out, mu_error *error) {
    if (is_array_of(place->value, 3)) return read_numbers(p, place, 3, out, error);
    if (!json_is_number(place->value)) return mu_place_fail(place, error, "a color is a number or [r, g, b]");
    if (!read_number(p, place, out, error)) return 0;
    out[1] = out[2] = out[0];
    return 1;
}

static _Bool read_matrix(const musurf_param *p, const mu_place *place, double *out, mu_error *error) {
    const mu_place row[2] = {mu_place_element(place, 0), mu_place_element(place, 1)};
    if (!is_array_of(place->value, 2) || !is_array_of(row[0].value, 2) || !is_array_of(row[1].value, 2))
        return mu_place_fail(place, error, "a 2x2 matrix is written as its two rows, [[a, c], [b, d]]");
    return read_numbers(p, row, 2, out, error) && read_numbers(p, row + 1, 2, out + 2, error);
}

static _Bool read_vector(const musurf_param *p, const mu_place *place, double *out, mu_error *error) {
    if (!is_array_of(place->value, 2))
        return mu_place_fail(place, error, "a vector of the tangent plane is [x, y]");
    return read_numbers(p, place, 2, out, error);
}

static _Bool read_matrix3(const musurf_param *p, const mu_place *place, double *out, mu_error *error) {
    for (size_t i = 0; i < 3; i++) {
        const mu_place row = mu_place_element(place, i);
        if (!is_array_of(place->value, 3) || !is_array_of(row.value, 3))
            return mu_place_fail(
                place, error, "a 3x3 matrix is written as its three rows, [[a, b, c], [d, e, f], [g, h, i]]");
        if (!read_numbers(p, &row, 3, out + 3 * i, error)) return 0;
    }
    return 1;
}

static _Bool read_footprint(const musurf_param *p, const mu_place *place, double *out, mu_error *error) {
    for (size_t i = 0; i < 3; i++) {
        const mu_place pair = mu_place_element(place, i);
        if (!is_array_of(place->value, 3) || !is_array_of(pair.value, 2))
            return mu_place_fail(place, error,
                                 "a footprint is its centre and two half-axes, [[u, v], [u, v], [u, v]], in "
                                 "texture coordinates");
        if (!read_numbers(p, &pair, 2, out + 2 * i, error)) return 0;
    }
    return 1;
}

static _Bool read_plain(mu_settings *s, const musurf_param *p, const mu_place *place, musurf_setting *setting,
                        double *values, mu_error *error) {
    size_t index;
    _Bool flag;
    switch (p->kind) {
    case MUSURF_NUMBER:
        return read_number(p, place, values, error);
    case MUSURF_COLOR:
        return read_color(p, place, values, error);
    case MUSURF_MATRIX:
        return read_matrix(p, place, values, error);
    case MUSURF_VECTOR:
        return read_vector(p, place, values, error);
    case MUSURF_MATRIX3:
        return read_matrix3(p, place, values, error);
    case MUSURF_GRID:
        setting->values = s->grids[s->count - 1] = mu_grid_read(p, place, &setting->count, error);
        return setting->values != NULL;
    case MUSURF_FOOTPRINT:
        return read_footprint(p, place, values, error);
    case MUSURF_FLAG:
        if (!mu_place_flag(place, &flag, error)) return 0;
        values[0] = flag;
        return 1;
    case MUSURF_CHOICE:
        if (!mu_place_choice(place, p->choices, &index, error)) return 0;
        setting->text = p->choices[index];
        return 1;
    default:
        return mu_place_fail(place, error,
                             "this program is older than the plugin and cannot set a parameter of kind %u",
                             p->kind);
    }
}

static _Bool read_members(mu_settings *s, const mu_place *place, const char *prefix,
                          const char *const *reserved, mu_error *error);

/* {"conductor": ...} under a choice parameter: the key is the choice, its value a parameter of its own. */
static _Bool read_choice_object(mu_settings *s, const musurf_param *p, const mu_place *place,
                                mu_error *error) {
    if (!check_members(s->type, p->name, p->choices, place, error)) return 0;
    if (json_object_size(place->value) == 0)
        return mu_place_fail(place, error, "is an empty object; a choice, or what belongs to one, is needed");
    const char *chosen = NULL, *key;
    json_t *value;
    json_object_foreach(place->value, key, value) {
        if (!is_in(key, p->choices)) continue;
        char name[LONGEST_NAME];
        snprintf(name, sizeof name, "%s.%s", p->name, key);
        const mu_place member = mu_place_member(place, key);
        if (chosen)
            return mu_place_fail_key(&member, error, "only one can be chosen, and \"%s\" is already", chosen);
        if (!any_below(s->type, name) && !mu_type_find(s->type, name))
            return mu_place_fail(place, error, "\"%s\" takes no value; write \"%s\" alone", key, key);
        chosen = key;
    }
    if (chosen) {
        musurf_setting *setting = mu_settings_add(s, p);
        for (const char *const *c = p->choices; *c; c++) /* the table's text, which outlives the document */
            if (strcmp(*c, chosen) == 0) setting->text = *c;
    }
    return read_members(s, place, p->name, NULL, error);
}

/* The floats of a new source: after those that the renderer knows by name. */
static _Bool place_source(const mu_settings *s, mu_source *source, const mu_place *place, mu_error *error) {
    source->slot = MU_SLOT_VALUES;
    for (size_t i = 0; i < s->source_count; i++)
        if (s->sources[i].slot + (uint32_t)s->sources[i].count > source->slot)
            source->slot = s->sources[i].slot + (uint32_t)s->sources[i].count;
    return source->slot + (uint32_t)source->count <= MU_SLOTS ||
           mu_place_fail(place, error, "is more than varies at once: %d numbers may",
                         MU_SLOTS - MU_SLOT_VALUES);
}

/* A source of values in place of one. */
static _Bool read_source(mu_settings *s, const musurf_param *p, const mu_place *place, mu_error *error) {
    mu_source *source = s->sources + s->source_count;
    if (!mu_source_read(source, p, place, error)) return 0;
    musurf_setting *setting = mu_settings_add(s, p);
    if (mu_source_is_constant(source, s->values[s->count - 1])) {
        setting->count = (size_t)source->count; /* which the document does not tell */
        mu_source_free(source);
        return 1;
    }
    if (!mu_source_serves(p)) {
        if (s->blended_count == MU_BLENDED) {
            mu_source_free(source);
            return mu_place_fail(place, error,
                                 "cannot vary too: of what the plugin wants constant %s and %s vary already",
                                 s->blended[0].param->name, s->blended[1].param->name);
        }
        s->blended[s->blended_count++] = *source;
        return 1;
    }
    if (!place_source(s, source, place, error)) {
        mu_source_free(source);
        return 0;
    }
    s->source_count++;
    setting->source = MUSURF_SLOT;
    setting->slot = source->slot;
    setting->values = NULL;
    return 1;
}

_Bool mu_settings_blend(mu_settings *s, uint32_t param) {
    size_t i = 0;
    while (i < s->source_count && s->sources[i].param->id != param) i++;
    if (i == s->source_count || s->blended_count == MU_BLENDED || !mu_source_blends(s->sources[i].param)) return 0;
    const mu_source *blended = &s->blended[s->blended_count++];
    s->blended[s->blended_count - 1] = s->sources[i];
    memmove(s->sources + i, s->sources + i + 1, (--s->source_count - i) * sizeof *s->sources);
    musurf_setting *setting = mu_settings_find(s, blended->param);
    setting->source = MUSURF_CONSTANT;
    setting->values = s->values[setting - s->items];
    return 1;
}

static _Bool read_param(mu_settings *s, const musurf_param *p, const mu_place *place, mu_error *error) {
    if (json_is_object(place->value) && p->kind == MUSURF_CHOICE)
        return read_choice_object(s, p, place, error);
    if (json_is_object(place->value) && any_below(s->type, p->name))
        return read_members(s, place, p->name, NULL, error);
    if (mu_source_serves(p) ? json_is_object(place->value) : mu_source_is(place->value))
        return read_source(s, p, place, error);
    musurf_setting *setting = mu_settings_add(s, p);
    return read_plain(s, p, place, setting, s->values[s->count - 1], error);
}

static _Bool read_members(mu_settings *s, const mu_place *place, const char *prefix,
                          const char *const *reserved, mu_error *error) {
    const musurf_param *around = mu_type_find(s->type, prefix);
    const char *const *others = around && around->kind == MUSURF_CHOICE ? around->choices : reserved;
    if (!check_members(s->type, prefix, others, place, error)) return 0;
    const char *key;
    json_t *value;
    json_object_foreach(place->value, key, value) {
        if (is_in(key, reserved)) continue;
        char name[LONGEST_NAME];
        snprintf(name, sizeof name, "%s%s%s", prefix, prefix[0] ? "." : "", key);
        const mu_place member = mu_place_member(place, key);
        const musurf_param *p = mu_type_find(s->type, name);
        if (!(p ? read_param(s, p, &member, error) : read_members(s, &member, name, NULL, error))) return 0;
    }
    return 1;
}

_Bool mu_settings_read(mu_settings *settings, const musurf_material_type *type, const mu_place *place,
                       const char *const *reserved, mu_error *error) {
    *settings = (mu_settings){.type = type};
    settings->items = calloc(type->param_count + 1, sizeof *settings->items);
    settings->values = calloc(type->param_count + 1, sizeof *settings->values);
    settings->grids = calloc(type->param_count + 1, sizeof *settings->grids);
    settings->sources = calloc(type->param_count + 1, sizeof *settings->sources);
    const _Bool good = settings->items && settings->values && settings->grids && settings->sources
                           ? read_members(settings, place, "", reserved, error)
                           : mu_place_fail(place, error, "not enough memory");
    if (!good) mu_settings_free(settings);
    return good;
}

void mu_settings_free(mu_settings *settings) {
    for (size_t i = 0; settings->grids && i < settings->count; i++) free(settings->grids[i]);
    for (size_t i = 0; i < settings->source_count; i++) mu_source_free(settings->sources + i);
    for (int i = 0; i < settings->blended_count; i++) mu_source_free(settings->blended + i);
    free(settings->sources);
    free(settings->grids);
    free(settings->items);
    free(settings->values);
    *settings = (mu_settings){0};
}

_Bool mu_settings_fail(const mu_place *place, const char *name, mu_error *error, const char *text) {
    const size_t length = strcspn(name, ".");
    char part[LONGEST_NAME];
    snprintf(part, sizeof part, "%.*s", (int)length, name);
    if (!json_object_get(place->value, part)) return mu_place_fail(place, error, "%s", text);
    const mu_place member = mu_place_member(place, part);
    if (name[length] == '.') return mu_settings_fail(&member, name + length + 1, error, text);
    return mu_place_fail(&member, error, "%s", text);
}
