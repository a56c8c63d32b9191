/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* vary.c: the lists of values, and how they come into a scene's document. */
#include "core/render/vary.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/vary_name.h"

/* ------------------------------------------------------------------------------------------------- parsing */

/* The length up to the first of `stops` that stands outside of brackets and strings. */
static size_t span(const char *text, const char *stops) {
    int depth = 0;
    _Bool quoted = 0;
    const char *at = text;
    for (; *at; ++at) {
        if (quoted && *at == '\\' && at[1])
            ++at;
        else if (*at == '"')
            quoted = !quoted;
        else if (!quoted && (*at == '[' || *at == '{'))
            ++depth;
        else if (!quoted && (*at == ']' || *at == '}'))
            --depth;
        else if (!quoted && depth <= 0 && strchr(stops, *at))
            break;
    }
    return (size_t)(at - text);
}

/* The whole text as a finite number. */
static _Bool is_number(const char *text, double *out) {
    char *end;
    *out = strtod(text, &end);
    return end != text && !*end && isfinite(*out) && !strpbrk(text, "xXpP \t");
}

/* A number as JSON has it: whole ones stay whole, as counts must be. */
static json_t *number(double value) {
    return floor(value) == value && fabs(value) <= 0x1p53 ? json_integer((json_int_t)value) : json_real(value);
}

/* A..B/N; 0: it is no range, -1: a wrong one. */
static int add_range(json_t *values, char *text) {
    char *const dots = strstr(text, ".."), *const slash = strrchr(text, '/');
    double from, to, count;
    if (!dots || !slash || slash < dots) return 0;
    *dots = *slash = '\0';
    if (!is_number(text, &from) || !is_number(dots + 2, &to) || !is_number(slash + 1, &count)) {
        *dots = '.', *slash = '/';
        return 0;
    }
    if (count < 2 || count > MU_VARY_VALUES || floor(count) != count) return -1;
    for (double i = 0; i < count; ++i)
        if (json_array_append_new(values, number(i == count - 1 ? to : from + (to - from) * (i / (count - 1)))))
            return -1;
    return 1;
}

static json_t *value_of(const char *text) {
    double plain;
    if (is_number(text, &plain)) return number(plain);
    json_t *json = json_loads(text, JSON_DECODE_ANY | JSON_REJECT_DUPLICATES, NULL);
    return json ? json : json_string(text);
}

static _Bool add_values(mu_variation *variation, const char *text, mu_error *error) {
    while (1) {
        const size_t length = span(text, ":");
        char *const one = strndup(text, length);
        if (!one) return mu_fail(error, "out of memory");
        const int range = length ? add_range(variation->values, one) : 0;
        if (range < 0) {
            mu_fail(error, "\"%.*s\" is no range of values; A..B/N with N from 2 to %d is needed", (int)length, text,
                    MU_VARY_VALUES);
            free(one);
            return 0;
        }
        const _Bool added = range || (length && !json_array_append_new(variation->values, value_of(one)));
        free(one);
        if (!added)
            return mu_fail(error, "%s: an empty or unreadable value; NAME=VALUE:VALUE is needed", variation->name);
        if (json_array_size(variation->values) > MU_VARY_VALUES)
            return mu_fail(error, "%s: more than %d values", variation->name, MU_VARY_VALUES);
        if (!text[length]) return 1;
        text += length + 1;
    }
}

static _Bool add(mu_variations *variations, const char *text, mu_error *error) {
    const size_t length = strcspn(text, "=");
    if (!length || !text[length])
        return mu_fail(error, "\"%s\" is no variation; NAME=VALUE:VALUE is needed, as in alpha=.1:.2:.4", text);
    if (variations->count == MU_VARY_MOST)
        return mu_fail(error, "more than %d names vary", MU_VARY_MOST);
    mu_variation *variation = &variations->of[variations->count++];
    *variation = (mu_variation){.name = strndup(text, length), .values = json_array()};
    if (!variation->name || !variation->values) return mu_fail(error, "out of memory");
    for (size_t i = 0; i + 1 < variations->count; ++i)
        if (!strcmp(variations->of[i].name, variation->name))
            return mu_fail(error, "%s varies twice", variation->name);
    return add_values(variation, text + length + 1, error);
}

_Bool mu_vary_parse(mu_variations *variations, const char *text, mu_error *error) {
    while (1) {
        const size_t length = span(text, ",");
        char *const one = strndup(text, length);
        if (!one) return mu_fail(error, "out of memory");
        const _Bool good = add(variations, one, error);
        free(one);
        if (!good) return 0;
        if (!text[length]) return 1;
        text += length + 1;
    }
}

void mu_vary_free(mu_variations *variations) {
    for (size_t i = 0; i < variations->count; ++i) {
        free(variations->of[i].name);
        free(variations->of[i].path);
        json_decref(variations->of[i].values);
    }
    *variations = (mu_variations){.count = 0};
}

/* ------------------------------------------------------------------------------------------------ applying */

_Bool mu_vary_bind(mu_variations *variations, const mu_document *scene, mu_error *error) {
    for (size_t i = 0; i < variations->count; ++i) {
        mu_variation *variation = &variations->of[i];
        variation->path = mu_vary_path(variation->name, scene, error);
        if (!variation->path) return 0;
        for (size_t k = 0; k < i; ++k)
            if (!strcmp(variations->of[k].path, variation->path))
                return mu_fail(error, "%s and %s are the same: %s", variations->of[k].name, variation->name,
                               variation->path);
    }
    return 1;
}

_Bool mu_vary_apply(const mu_variations *variations, const size_t *which, mu_document *scene, mu_error *error) {
    for (size_t i = 0; i < variations->count; ++i) {
        const mu_variation *variation = &variations->of[i];
        if (!mu_vary_set(variation->path, json_array_get(variation->values, which[i]), scene, error)) return 0;
    }
    return 1;
}

void mu_vary_caption(const mu_variation *variation, size_t which, char *out, size_t size) {
    const json_t *value = json_array_get(variation->values, which);
    const char *const name = !strncmp(variation->name, "$.", 2) ? variation->name + 2 : variation->name;
    if (json_is_string(value)) {
        snprintf(out, size, "%s %s", name, json_string_value(value));
        return;
    }
    char *text = json_is_real(value) ? NULL : json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(4) | JSON_COMPACT);
    if (text)
        snprintf(out, size, "%s %s", name, text);
    else
        snprintf(out, size, "%s %.4g", name, json_real_value(value));
    free(text);
}
