/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* json_out.c: appends members to a line of JSON. Keys are the program's own and need no escapes. */
#include "core/render/json_out.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void put(mu_json *json, const char *text, size_t length) {
    if (json->no_memory) return;
    if (json->room - json->length < length) {
        const size_t room = 2 * (json->length + length) + 256;
        char *more = realloc(json->text, room);
        if (!more) {
            json->no_memory = 1;
            return;
        }
        json->text = more;
        json->room = room;
    }
    memcpy(json->text + json->length, text, length);
    json->length += length;
}

static void put_key(mu_json *json, const char *key) {
    if (json->length > 1) put(json, ", ", 2);
    put(json, "\"", 1);
    put(json, key, strlen(key));
    put(json, "\": ", 3);
}

static void put_number(mu_json *json, double value) {
    char digits[40];
    if (isfinite(value))
        put(json, digits, (size_t)snprintf(digits, sizeof digits, "%.17g", value + 0.0)); /* no -0 */
    else
        put(json, "null", 4);
}

void mu_json_begin(mu_json *json) {
    json->length = 0;
    json->no_memory = 0;
    put(json, "{", 1);
}

void mu_json_raw(mu_json *json, const char *key, const char *text, size_t length) {
    put_key(json, key);
    put(json, text, length);
}

void mu_json_string(mu_json *json, const char *key, const char *text) {
    put_key(json, key);
    put(json, "\"", 1);
    for (; *text; text++) {
        char escape[8];
        const unsigned char byte = (unsigned char)*text;
        if (byte == '"' || byte == '\\')
            put(json, escape, (size_t)snprintf(escape, sizeof escape, "\\%c", byte));
        else if (byte < 0x20)
            put(json, escape, (size_t)snprintf(escape, sizeof escape, "\\u%04x", byte));
        else
            put(json, text, 1);
    }
    put(json, "\"", 1);
}

void mu_json_number(mu_json *json, const char *key, double value) {
    put_key(json, key);
    put_number(json, value);
}

static void put_numbers(mu_json *json, const double *values, size_t count) {
    put(json, "[", 1);
    for (size_t i = 0; i < count; i++) {
        if (i) put(json, ", ", 2);
        put_number(json, values[i]);
    }
    put(json, "]", 1);
}

void mu_json_numbers(mu_json *json, const char *key, const double *values, size_t count) {
    put_key(json, key);
    put_numbers(json, values, count);
}

void mu_json_vectors(mu_json *json, const char *key, const double *values, size_t count, size_t size) {
    put_key(json, key);
    put(json, "[", 1);
    for (size_t i = 0; i < count; i++) {
        if (i) put(json, ", ", 2);
        put_numbers(json, values + i * size, size);
    }
    put(json, "]", 1);
}

void mu_json_object(mu_json *json, const char *key, const mu_json *object) {
    if (object->no_memory) json->no_memory = 1;
    if (json->no_memory) return;
    put_key(json, key);
    put(json, object->text, object->length);
    put(json, "}", 1);
}

void mu_json_list_begin(mu_json *json, const char *key) {
    put_key(json, key);
    put(json, "[", 1);
}

void mu_json_list_add(mu_json *json, const mu_json *object) {
    if (object->no_memory) json->no_memory = 1;
    if (json->no_memory) return;
    if (json->text[json->length - 1] != '[') put(json, ", ", 2);
    put(json, object->text, object->length);
    put(json, "}", 1);
}

void mu_json_list_end(mu_json *json) {
    put(json, "]", 1);
}

_Bool mu_json_write(mu_json *json, FILE *out) {
    put(json, "}\n", 2);
    if (json->no_memory) {
        errno = ENOMEM;
        return 0;
    }
    return fwrite(json->text, 1, json->length, out) == json->length;
}

void mu_json_free(mu_json *json) {
    free(json->text);
    *json = (mu_json){0};
}
