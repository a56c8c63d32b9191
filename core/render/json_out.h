/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * json_out.h: one JSON object written as one line. Numbers have 17 significant digits, enough to come back as
 * the same double; what is not finite becomes null, for JSON has no word for it.
 */
#ifndef MU_JSON_OUT_H
#define MU_JSON_OUT_H

#include <stddef.h>
#include <stdio.h>

typedef struct mu_json { /* grows as needed and is used again for the next line */
    char *text;
    size_t length, room;
    _Bool no_memory;
} mu_json;

void mu_json_begin(mu_json *json);
/* `text` is JSON already. */
void mu_json_raw(mu_json *json, const char *key, const char *text, size_t length);
void mu_json_string(mu_json *json, const char *key, const char *text);
void mu_json_number(mu_json *json, const char *key, double value);
void mu_json_numbers(mu_json *json, const char *key, const double *values, size_t count);
/* [[x, y, z], ...]: `count` lists of `size` numbers each. */
void mu_json_vectors(mu_json *json, const char *key, const double *values, size_t count, size_t size);
/* An object within: begun and filled in another mu_json, which is ended by this. */
void mu_json_object(mu_json *json, const char *key, const mu_json *object);
/* A list of objects: each is begun and filled in another mu_json and then added, which ends it. */
void mu_json_list_begin(mu_json *json, const char *key);
void mu_json_list_add(mu_json *json, const mu_json *object);
void mu_json_list_end(mu_json *json);
/* Ends the object and writes the line. False if memory or the file failed; errno says how. */
_Bool mu_json_write(mu_json *json, FILE *out);
void mu_json_free(mu_json *json);

#endif
