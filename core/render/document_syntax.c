/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * document_syntax.c: where a text stops being JSON. jansson says what is wrong and counts bytes; from the
 * text up to there come the beginning of the offending token, its line and column, and the JSON path that
 * leads to it.
 */
#include "core/render/document_syntax.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "core/render/document_locate.h"
#include "core/render/text.h"

enum { DEEPEST = 64 }; /* levels of a path that are shown */

typedef struct level {
    _Bool object, at_key;
    size_t index;    /* of the element, in an array */
    const char *key; /* as written, of the member, in an object; NULL before there is one */
    size_t key_length;
} level;

static void format_path(const level *levels, size_t depth, char *out, size_t size) {
    snprintf(out, size, depth > DEEPEST ? "$..." : "$");
    for (size_t i = 0; depth <= DEEPEST && i < depth; i++) {
        const level *l = levels + i;
        char step[80] = "";
        if (!l->object)
            snprintf(step, sizeof step, "[%zu]", l->index);
        else if (l->key && l->key_length <= 48)
            snprintf(step, sizeof step, ".%.*s", (int)l->key_length, l->key);
        else if (l->key)
            snprintf(step, sizeof step, ".%.45s...", l->key);
        mu_append(out, size, step);
    }
}

/* The path of what stands at `offset`, from brackets, keys and commas before it. */
static void path_at(const mu_document *d, size_t offset, char *out, size_t size) {
    level levels[DEEPEST + 1];
    size_t depth = 0;
    for (size_t i = 0; i < offset; i++) {
        level *const top = depth > 0 && depth <= DEEPEST ? levels + depth - 1 : NULL;
        const char c = d->text[i];
        if (c == '"') {
            const size_t begin = ++i;
            while (i < offset && d->text[i] != '"') i += d->text[i] == '\\' ? 2 : 1;
            if (top && top->object && top->at_key && i < offset)
                top->key = d->text + begin, top->key_length = i - begin;
        } else if (c == '[' || c == '{') {
            if (depth++ < DEEPEST) levels[depth - 1] = (level){.object = c == '{', .at_key = 1};
        } else if ((c == ']' || c == '}') && depth > 0) {
            depth--;
        } else if (c == ',' && top) {
            top->index++;
            top->key = NULL;
            top->at_key = 1;
        } else if (c == ':' && top) {
            top->at_key = 0;
        }
    }
    format_path(levels, depth, out, size);
}

_Bool mu_syntax_fail(const mu_document *d, size_t offset, mu_error *error, const char *format, ...) {
    char what[sizeof error->text], path[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    path_at(d, offset, path, sizeof path);
    const mu_position p = mu_position_of(d, offset);
    return mu_fail(error, "%.300s:%zu:%zu: %s: %s", d->name, p.line, p.column, path, what);
}

/* Walks over brackets that stand in no string. Returns how many are open at the end; `*last` becomes the
 * offset of the one that was last to open the level `wanted`. */
static size_t walk_brackets(const char *text, size_t length, size_t wanted, size_t *last) {
    size_t depth = 0;
    _Bool string = 0;
    for (size_t i = 0; i < length; i++) {
        const char c = text[i];
        if (string && c == '\\') i++;
        if (c == '"') string = !string;
        if (string) continue;
        if (c == '[' || c == '{') {
            if (++depth == wanted) *last = i;
        } else if ((c == ']' || c == '}') && depth > 0) {
            depth--;
        }
    }
    return depth;
}

_Bool mu_syntax_retell(const mu_document *d, const json_error_t *found, mu_error *error) {
    size_t at = found->position > 0 ? (size_t)found->position : 0;
    if (at > d->length) at = d->length;

    /* jansson appends " near '...'" with the token it has just read, and counts to behind it. */
    char reason[JSON_ERROR_TEXT_LENGTH], token[JSON_ERROR_TEXT_LENGTH] = "";
    snprintf(reason, sizeof reason, "%s", found->text);
    char *near = strstr(reason, " near '");
    if (near) {
        *near = '\0';
        snprintf(token, sizeof token, "%s", near + 7);
        const size_t length = strlen(token);
        if (length > 0) token[length - 1] = '\0'; /* the closing quote */
        if (strlen(token) <= at && memcmp(d->text + at - strlen(token), token, strlen(token)) == 0)
            at -= strlen(token);
    }
    const char *const space = token[0] ? " " : ""; /* jansson does not say what a long token was */

    switch (json_error_code(found)) {
    case json_error_premature_end_of_input: {
        size_t bracket = 0;
        const size_t open = walk_brackets(d->text, d->length, 0, &bracket);
        if (open == 0) return mu_syntax_fail(d, at, error, "the text ends in the middle of a value");
        walk_brackets(d->text, d->length, open, &bracket);
        const mu_position b = mu_position_of(d, bracket);
        return mu_syntax_fail(d, at, error,
                              "the text ends, but the '%c' of line %zu, column %zu is not closed",
                              d->text[bracket], b.line, b.column);
    }
    case json_error_end_of_input_expected:
        return mu_syntax_fail(d, at, error,
                              "more text%s%s after the end of the document; nothing may follow it",
                              token[0] ? ", " : "", token);
    case json_error_duplicate_key:
        return mu_syntax_fail(d, at, error, "the key%s%s stands here a second time; give it once", space,
                              token);
    case json_error_numeric_overflow:
        return mu_syntax_fail(d, at, error,
                              "the number%s%s is too large; at most 1.797e308, whole numbers to 2^63-1",
                              space, token);
    case json_error_stack_overflow:
        return mu_syntax_fail(d, at, error, "nested deeper than %d levels", JSON_PARSER_MAX_DEPTH);
    case json_error_null_character:
    case json_error_null_byte_in_key:
        return mu_syntax_fail(d, at, error, "\\u0000 is not allowed in a string");
    case json_error_out_of_memory:
        return mu_fail(error, "%s: not enough memory", d->name);
    default:
        if (strcmp(token, "NaN") == 0 || strcasecmp(token, "Infinity") == 0 || strcmp(token, "nan") == 0 ||
            strcmp(token, "inf") == 0)
            return mu_syntax_fail(d, at, error, "%s is not JSON; a finite number is needed", token);
        return mu_syntax_fail(d, at, error, "%s%s%s%s", reason, near ? " at '" : "", near ? token : "",
                              near ? "'" : "");
    }
}
