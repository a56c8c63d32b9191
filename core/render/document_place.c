/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* document_place.c: walking down a document, and saying in an error where one stands: file, line, column,
 * JSON path. */
#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core/render/document_locate.h"

mu_place mu_place_root(const mu_document *document) {
    return (mu_place){.document = document, .value = document->root};
}

mu_place mu_place_member(const mu_place *parent, const char *key) {
    return (mu_place){parent->document, parent, key, 0, json_object_get(parent->value, key)};
}

mu_place mu_place_element(const mu_place *parent, size_t index) {
    return (mu_place){parent->document, parent, NULL, index, json_array_get(parent->value, index)};
}

static _Bool is_plain(const char *key) {
    if (!isalpha((unsigned char)key[0]) && key[0] != '_') return 0;
    for (; *key; key++)
        if (!isalnum((unsigned char)*key) && *key != '_') return 0;
    return 1;
}

enum { LONGEST_KEY = 48 };

void mu_place_path(const mu_place *place, char *out, size_t size) {
    char step[LONGEST_KEY + 32];
    if (!place->parent) {
        snprintf(out, size, "$");
        return;
    }
    if (!place->key)
        snprintf(step, sizeof step, "[%zu]", place->index);
    else if (is_plain(place->key) && strlen(place->key) <= LONGEST_KEY)
        snprintf(step, sizeof step, ".%s", place->key);
    else
        snprintf(step, sizeof step, "[\"%.*s%s\"]", LONGEST_KEY, place->key,
                 strlen(place->key) > LONGEST_KEY ? "..." : "");

    mu_place_path(place->parent, out, size);
    const size_t length = strlen(out), more = strlen(step);
    if (length + more < size) {
        memcpy(out + length, step, more + 1);
    } else if (more + 5 < size) { /* too deep to show whole: the end of the path says more than its middle */
        snprintf(out, size, "$...%s", step);
    }
}

static _Bool fail(const mu_place *place, _Bool at_key, mu_error *error, const char *format,
                  va_list arguments) {
    char what[sizeof error->text], path[256];
    vsnprintf(what, sizeof what, format, arguments);
    mu_place_path(place, path, sizeof path);

    const char *const name = place->document->name;
    mu_span span;
    if (!mu_locate(place, at_key, &span)) return mu_fail(error, "%.300s: %s: %s", name, path, what);
    const mu_position p = mu_position_of(place->document, span.begin);
    return mu_fail(error, "%.300s:%zu:%zu: %s: %s", name, p.line, p.column, path, what);
}

_Bool mu_place_fail(const mu_place *place, mu_error *error, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fail(place, 0, error, format, arguments);
    va_end(arguments);
    return 0;
}

_Bool mu_place_fail_key(const mu_place *place, mu_error *error, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    fail(place, 1, error, format, arguments);
    va_end(arguments);
    return 0;
}
