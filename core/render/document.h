/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * document.h: a JSON file that remembers where each value stands.
 *
 * jansson parses; it keeps no positions, so a value is named by its JSON path ("$.objects[2].material.alpha") and
 * the path is found again in the text only when an error needs its line and column.
 */
#ifndef MU_DOCUMENT_H
#define MU_DOCUMENT_H

#include <jansson.h>
#include <stddef.h>

#include "core/render/error.h"

typedef struct mu_document {
    char *name; /* file name as given, for messages */
    char *text;
    size_t length;
    json_t *root;
    size_t first_line; /* 1; for JSON Lines the number of the line */
} mu_document;

/* A place in the document: built on the stack while walking down, nothing is allocated. */
typedef struct mu_place {
    const mu_document *document;
    const struct mu_place *parent; /* NULL at the root */
    const char *key;               /* member of an object, or NULL */
    size_t index;                  /* element of an array if key is NULL */
    json_t *value;                 /* borrowed */
} mu_place;

/* Parsed, the worst text takes some eighty times its own size in memory; real ones are a few KiB. */
#define MU_DOCUMENT_LIMIT (8 << 20)

/* Reads a file ("-": standard input) of at most MU_DOCUMENT_LIMIT bytes. Duplicate keys, NaN, bytes that are not UTF-8,
 * trailing text and nesting beyond jansson's limit are errors. */
_Bool mu_document_read(mu_document *document, const char *file, mu_error *error);
/* The same for a text in memory, which is copied. */
_Bool mu_document_parse(mu_document *document, const char *name, const char *text, size_t length,
                        size_t first_line, mu_error *error);
void mu_document_free(mu_document *document);
/* A file named in the document, relative to it; to be freed. NULL without memory. */
char *mu_document_beside(const mu_document *document, const char *name);

mu_place mu_place_root(const mu_document *document);
/* value is NULL if there is no such member. */
mu_place mu_place_member(const mu_place *parent, const char *key);
mu_place mu_place_element(const mu_place *parent, size_t index);

/* "scene.json:12:18: $.objects[0].radius: ..." Always returns false. */
_Bool mu_place_fail(const mu_place *place, mu_error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* mu_place_fail, but pointing at the member's name: it is the name that is wrong. */
_Bool mu_place_fail_key(const mu_place *place, mu_error *error, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Each reads what stands at `place`, checks kind and finiteness, and fails with what would be right. */
_Bool mu_place_number(const mu_place *place, double min, double max, double *out, mu_error *error);
_Bool mu_place_numbers(const mu_place *place, size_t count, double min, double max, double *out,
                       mu_error *error);
_Bool mu_place_integer(const mu_place *place, long long min, long long max, long long *out, mu_error *error);
_Bool mu_place_flag(const mu_place *place, _Bool *out, mu_error *error);
_Bool mu_place_string(const mu_place *place, const char **out, mu_error *error); /* borrowed */
/* Index into the NULL-terminated `choices`; the error lists them and suggests the nearest. */
_Bool mu_place_choice(const mu_place *place, const char *const *choices, size_t *out, mu_error *error);
/* Every member of the object at place must be in the NULL-terminated `known`; suggests the nearest. */
_Bool mu_place_only(const mu_place *place, const char *const *known, mu_error *error);

/* The candidate nearest to `word` by edit distance, or NULL if none is near. */
const char *mu_nearest(const char *word, const char *const *candidates);

#endif
