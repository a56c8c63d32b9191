/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* scene_values.c: optional members of a scene file's objects, in the renderer's single precision. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/scene_read.h"

_Bool mu_read_float(const mu_place *parent, const char *key, double min, double max, float *out,
                    mu_error *error) {
    const mu_place place = mu_place_member(parent, key);
    double value;
    if (!place.value) return 1;
    if (!mu_place_number(&place, min, max, &value, error)) return 0;
    *out = (float)value;
    return 1;
}

_Bool mu_read_floats(const mu_place *parent, const char *key, size_t count, double min, double max,
                     float *out, mu_error *error) {
    const mu_place place = mu_place_member(parent, key);
    double values[4];
    if (!place.value) return 1;
    if (!mu_place_numbers(&place, count, min, max, values, error)) return 0;
    for (size_t i = 0; i < count; ++i) out[i] = (float)values[i];
    return 1;
}

_Bool mu_read_count(const mu_place *parent, const char *key, long long min, long long max, uint32_t *out,
                    mu_error *error) {
    const mu_place place = mu_place_member(parent, key);
    long long value;
    if (!place.value) return 1;
    if (!mu_place_integer(&place, min, max, &value, error)) return 0;
    *out = (uint32_t)value;
    return 1;
}

_Bool mu_read_vector(const mu_place *parent, const char *key, mu_vec3 *out, mu_error *error) {
    float v[3] = {out->x, out->y, out->z};
    if (!mu_read_floats(parent, key, 3, -MU_LARGEST, MU_LARGEST, v, error)) return 0;
    *out = mu_v3(v[0], v[1], v[2]);
    return 1;
}

_Bool mu_read_color(const mu_place *parent, const char *key, float out[3], mu_error *error) {
    const mu_place place = mu_place_member(parent, key);
    if (json_is_array(place.value)) return mu_read_floats(parent, key, 3, 0, MU_LARGEST, out, error);
    if (!place.value) return 1;
    if (!json_is_number(place.value))
        return mu_place_fail(&place, error,
                             "must be a number, or an array of 3 numbers: red, green and blue");
    if (!mu_read_float(parent, key, 0, MU_LARGEST, &out[0], error)) return 0;
    out[1] = out[2] = out[0];
    return 1;
}

_Bool mu_read_choice(const mu_place *parent, const char *key, const char *const *choices, size_t *out,
                     mu_error *error) {
    const mu_place place = mu_place_member(parent, key);
    return place.value ? mu_place_choice(&place, choices, out, error) : 1;
}

char *mu_scene_path(const mu_reader *reader, const char *name) {
    return mu_document_beside(reader->document, name);
}

_Bool mu_fail_unknown(const mu_place *place, json_t *table, const char *what, mu_error *error) {
    const char *name = json_string_value(place->value), *key, *nearest = NULL;
    const char **names = calloc(json_object_size(table) + 1, sizeof *names);
    json_t *value;
    size_t count = 0;
    json_object_foreach(table, key, value) if (names) names[count++] = key;
    if (names) nearest = mu_nearest(name, names);
    if (nearest)
        mu_place_fail(place, error, "there is no %s \"%.60s\"; did you mean \"%.60s\"?", what, name, nearest);
    else
        mu_place_fail(place, error, "there is no %s \"%.60s\"; the scene defines %zu of them", what, name,
                      count);
    free(names);
    return 0;
}

char *mu_place_text(const mu_place *place) {
    mu_error line = {.text = ""};
    mu_place_fail(place, &line, "%s", "");
    char *end = line.text + strlen(line.text);
    while (end > line.text && (end[-1] == ' ' || end[-1] == ':')) --end;
    return strndup(line.text, (size_t)(end - line.text));
}

void mu_scene_warn(const mu_reader *reader, const mu_place *place, const char *text) {
    mu_error line = {.text = ""};
    mu_place_fail(place, &line, "%s", text);
    mu_warn(reader->error, "%s", line.text);
}

_Bool mu_append(void **array, uint32_t *count, size_t size, mu_error *error) {
    char *larger = *count < MU_NO_INDEX ? realloc(*array, ((size_t)*count + 1) * size) : NULL;
    if (!larger) return mu_fail(error, "not enough memory for the scene");
    *array = larger;
    memset(larger + (size_t)*count * size, 0, size);
    ++*count;
    return 1;
}
