/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* document_values.c: typed readers. Each either fills in its result or says what would have been right. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/render/document.h"
#include "core/render/text.h"

/* "a string", or a short value itself: what the user wrote. */
static void describe(const json_t *value, char *out, size_t size) {
    switch (json_typeof(value)) {
    case JSON_OBJECT:
        snprintf(out, size, "an object");
        return;
    case JSON_ARRAY:
        snprintf(out, size, "an array of %zu", json_array_size(value));
        return;
    case JSON_STRING:
        snprintf(out, size, json_string_length(value) > 40 ? "\"%.37s...\"" : "\"%s\"",
                 json_string_value(value));
        return;
    case JSON_INTEGER:
        snprintf(out, size, "%" JSON_INTEGER_FORMAT, json_integer_value(value));
        return;
    case JSON_REAL:
        snprintf(out, size, "%.10g", json_real_value(value));
        return;
    case JSON_TRUE:
        snprintf(out, size, "true");
        return;
    case JSON_FALSE:
        snprintf(out, size, "false");
        return;
    case JSON_NULL:
        snprintf(out, size, "null");
        return;
    }
}

static _Bool fail_kind(const mu_place *place, mu_error *error, const char *wanted) {
    if (!place->value) return mu_place_fail(place, error, "is missing; %s is needed", wanted);
    char found[64];
    describe(place->value, found, sizeof found);
    return mu_place_fail(place, error, "is %s; %s is needed", found, wanted);
}

/* "a number from 0 to 1", "a number of at least 0", "a finite number". */
static void describe_range(char *out, size_t size, const char *kind, double min, double max) {
    if (isfinite(min) && isfinite(max))
        snprintf(out, size, "%s from %.10g to %.10g", kind, min, max);
    else if (isfinite(min))
        snprintf(out, size, "%s of at least %.10g", kind, min);
    else if (isfinite(max))
        snprintf(out, size, "%s of at most %.10g", kind, max);
    else
        snprintf(out, size, "%s", kind);
}

_Bool mu_place_number(const mu_place *place, double min, double max, double *out, mu_error *error) {
    const double value = json_number_value(place->value); /* 0 if it is none */
    if (!json_is_number(place->value) || !isfinite(value) || value < min || value > max) {
        char wanted[96];
        describe_range(wanted, sizeof wanted, "a number", min, max);
        return fail_kind(place, error, wanted);
    }
    *out = value;
    return 1;
}

_Bool mu_place_numbers(const mu_place *place, size_t count, double min, double max, double *out,
                       mu_error *error) {
    if (!json_is_array(place->value) || json_array_size(place->value) != count) {
        char wanted[64];
        snprintf(wanted, sizeof wanted, "an array of %zu numbers", count);
        return fail_kind(place, error, wanted);
    }
    for (size_t i = 0; i < count; i++) {
        const mu_place element = mu_place_element(place, i);
        if (!mu_place_number(&element, min, max, out + i, error)) return 0;
    }
    return 1;
}

_Bool mu_place_integer(const mu_place *place, long long min, long long max, long long *out, mu_error *error) {
    long long value = 0;
    _Bool good = 0;
    if (json_is_integer(place->value)) {
        value = json_integer_value(place->value);
        good = 1;
    } else if (json_is_real(place->value)) { /* 1e3 is a whole number, too */
        const double real = json_real_value(place->value);
        good = floor(real) == real && fabs(real) <= 0x1p53;
        if (good) value = (long long)real;
    }
    if (!good || value < min || value > max) {
        char wanted[96];
        snprintf(wanted, sizeof wanted, "a whole number from %lld to %lld", min, max);
        return fail_kind(place, error, wanted);
    }
    *out = value;
    return 1;
}

_Bool mu_place_flag(const mu_place *place, _Bool *out, mu_error *error) {
    if (!json_is_boolean(place->value)) return fail_kind(place, error, "true or false");
    *out = json_is_true(place->value);
    return 1;
}

_Bool mu_place_string(const mu_place *place, const char **out, mu_error *error) {
    if (!json_is_string(place->value)) return fail_kind(place, error, "a string");
    *out = json_string_value(place->value);
    return 1;
}

/* `; did you mean "ggx"? Known: beckmann ggx gtr`. A long list is shown only where there is no better hint.
 */
static void suggest(char *out, size_t size, const char *word, const char *const *known) {
    char list[512] = "";
    for (const char *const *k = known; *k; k++) {
        mu_append(list, sizeof list, k == known ? "" : ", ");
        mu_append(list, sizeof list, *k);
    }
    const char *const nearest = mu_nearest(word, known);
    out[0] = '\0';
    if (nearest) {
        mu_append(out, size, "; did you mean \"");
        mu_append(out, size, nearest);
        mu_append(out, size, "\"?");
        if (strlen(list) > 160) return;
    }
    mu_append(out, size, nearest ? " Known: " : "; known: ");
    mu_append(out, size, list);
}

_Bool mu_place_choice(const mu_place *place, const char *const *choices, size_t *out, mu_error *error) {
    char list[600];
    if (!json_is_string(place->value)) {
        snprintf(list, sizeof list, "one of");
        for (const char *const *c = choices; *c; c++) {
            mu_append(list, sizeof list, " \"");
            mu_append(list, sizeof list, *c);
            mu_append(list, sizeof list, "\"");
        }
        return fail_kind(place, error, list);
    }
    const char *const word = json_string_value(place->value);
    for (size_t i = 0; choices[i]; i++) {
        if (strcmp(choices[i], word) == 0) {
            *out = i;
            return 1;
        }
    }
    suggest(list, sizeof list, word, choices);
    return mu_place_fail(place, error, "\"%.60s\" is not known%s", word, list);
}

_Bool mu_place_only(const mu_place *place, const char *const *known, mu_error *error) {
    if (!json_is_object(place->value)) return fail_kind(place, error, "an object");
    const char *key;
    json_t *value;
    json_object_foreach(place->value, key, value) {
        const char *const *k = known;
        while (*k && strcmp(*k, key) != 0) k++;
        if (*k) continue;
        char list[600];
        suggest(list, sizeof list, key, known);
        const mu_place member = mu_place_member(place, key);
        return mu_place_fail_key(&member, error, "this key is not known%s", list);
    }
    return 1;
}
