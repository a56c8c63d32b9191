/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * document.c: reads and parses a JSON document. What jansson finds wrong is said again in one line that
 * points at the beginning of the offending text.
 */
#include "core/render/document.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/render/document_locate.h"
#include "core/render/utf8.h"

static _Bool fail_at(const mu_document *d, size_t offset, mu_error *error, const char *what) {
    const mu_position p = mu_position_of(d, offset);
    return mu_fail(error, "%s:%zu:%zu: %s", d->name, p.line, p.column, what);
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

static _Bool fail_syntax(const mu_document *d, const json_error_t *found, mu_error *error) {
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
    const mu_position p = mu_position_of(d, at);
    const char *const space = token[0] ? " " : ""; /* jansson does not say what a long token was */
    const char *const name = d->name;

    switch (json_error_code(found)) {
    case json_error_premature_end_of_input: {
        size_t bracket = 0;
        const size_t open = walk_brackets(d->text, d->length, 0, &bracket);
        if (open == 0)
            return mu_fail(error, "%s:%zu:%zu: the text ends in the middle of a value", name, p.line,
                           p.column);
        walk_brackets(d->text, d->length, open, &bracket);
        const mu_position b = mu_position_of(d, bracket);
        return mu_fail(error, "%s:%zu:%zu: the text ends, but the '%c' of line %zu, column %zu is not closed",
                       name, p.line, p.column, d->text[bracket], b.line, b.column);
    }
    case json_error_end_of_input_expected:
        return mu_fail(error,
                       "%s:%zu:%zu: more text%s%s after the end of the document; nothing may follow it", name,
                       p.line, p.column, token[0] ? ", " : "", token);
    case json_error_duplicate_key:
        return mu_fail(error, "%s:%zu:%zu: the key%s%s stands here a second time; give it once", name, p.line,
                       p.column, space, token);
    case json_error_numeric_overflow:
        return mu_fail(error,
                       "%s:%zu:%zu: the number%s%s is too large; at most 1.797e308, whole numbers to 2^63-1",
                       name, p.line, p.column, space, token);
    case json_error_stack_overflow:
        return mu_fail(error, "%s:%zu:%zu: nested deeper than %d levels", name, p.line, p.column,
                       JSON_PARSER_MAX_DEPTH);
    case json_error_null_character:
    case json_error_null_byte_in_key:
        return mu_fail(error, "%s:%zu:%zu: \\u0000 is not allowed in a string", name, p.line, p.column);
    case json_error_out_of_memory:
        return mu_fail(error, "%s: not enough memory", name);
    default:
        if (strcmp(token, "NaN") == 0 || strcasecmp(token, "Infinity") == 0 || strcmp(token, "nan") == 0 ||
            strcmp(token, "inf") == 0)
            return mu_fail(error, "%s:%zu:%zu: %s is not JSON; a finite number is needed", name, p.line,
                           p.column, token);
        return mu_fail(error, "%s:%zu:%zu: %s%s%s%s", name, p.line, p.column, reason, near ? " at '" : "",
                       near ? token : "", near ? "'" : "");
    }
}

static _Bool parse(mu_document *d, mu_error *error) {
    /* A byte order mark, as some editors leave it, becomes white space. */
    if (d->length >= 3 && memcmp(d->text, "\xef\xbb\xbf", 3) == 0) memset(d->text, ' ', 3);

    const char *const nul = memchr(d->text, '\0', d->length);
    if (nul) return fail_at(d, (size_t)(nul - d->text), error, "a NUL byte; JSON text is needed");
    const size_t valid = mu_utf8_valid(d->text, d->length);
    if (valid < d->length) {
        const mu_position p = mu_position_of(d, valid);
        return mu_fail(error, "%s:%zu:%zu: byte 0x%02x is not UTF-8", d->name, p.line, p.column,
                       (unsigned)(unsigned char)d->text[valid]);
    }
    if (strspn(d->text, " \t\r\n") == d->length)
        return fail_at(d, 0, error, "is empty; a JSON object is needed");

    json_error_t found;
    d->root = json_loadb(d->text, d->length, JSON_REJECT_DUPLICATES | JSON_DECODE_ANY, &found);
    return d->root ? 1 : fail_syntax(d, &found, error);
}

/* Takes `text`, which has one byte more than `length`. */
static _Bool adopt(mu_document *d, const char *name, char *text, size_t length, size_t first_line,
                   mu_error *error) {
    *d = (mu_document){.name = strdup(name), .text = text, .length = length, .first_line = first_line};
    if (!d->name) mu_fail(error, "not enough memory");
    if (d->name) {
        text[length] = '\0';
        if (parse(d, error)) return 1;
    }
    mu_document_free(d);
    return 0;
}

_Bool mu_document_parse(mu_document *document, const char *name, const char *text, size_t length,
                        size_t first_line, mu_error *error) {
    *document = (mu_document){0};
    char *copy = malloc(length + 1);
    if (!copy) return mu_fail(error, "%s: not enough memory", name);
    if (length) memcpy(copy, text, length);
    return adopt(document, name, copy, length, first_line, error);
}

/* Everything up to the end of `file`, or NULL. */
static char *read_all(int file, size_t expected, const char *name, size_t *length, mu_error *error) {
    size_t room = expected + 1 < 4096 ? 4096 : expected + 1;
    char *text = malloc(room + 1);
    *length = 0;
    while (text) {
        const ssize_t got = read(file, text + *length, room - *length);
        if (got == 0) return text;
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) {
            mu_fail(error, "%s: cannot be read: %s", name, strerror(errno));
            break;
        }
        *length += (size_t)got;
        if (*length > MU_DOCUMENT_LIMIT) {
            mu_fail(error, "%s:1:1: $: larger than %d MiB; no document needs that", name, MU_DOCUMENT_LIMIT >> 20);
            break;
        }
        if (*length == room) {
            room *= 2;
            char *more = realloc(text, room + 1);
            if (!more) break;
            text = more;
        }
    }
    mu_fail(error, "%s: not enough memory", name); /* unless the reason is there already */
    free(text);
    return NULL;
}

_Bool mu_document_read(mu_document *document, const char *file, mu_error *error) {
    *document = (mu_document){0};
    const _Bool standard = strcmp(file, "-") == 0;
    const char *const name = standard ? "stdin" : file;
    const int descriptor = standard ? STDIN_FILENO : open(file, O_RDONLY | O_CLOEXEC);
    struct stat status;
    if (descriptor < 0 || fstat(descriptor, &status) != 0) {
        mu_fail(error, "%s: cannot be opened: %s", name, strerror(errno));
        if (descriptor >= 0 && !standard) close(descriptor);
        return 0;
    }

    char *text = NULL;
    size_t length = 0;
    if (S_ISDIR(status.st_mode))
        mu_fail(error, "%s: is a directory; a JSON file is needed", name);
    else if (S_ISREG(status.st_mode) && status.st_size > MU_DOCUMENT_LIMIT)
        mu_fail(error, "%s:1:1: $: larger than %d MiB; no document needs that", name, MU_DOCUMENT_LIMIT >> 20);
    else
        text =
            read_all(descriptor, S_ISREG(status.st_mode) ? (size_t)status.st_size : 0, name, &length, error);
    if (!standard) close(descriptor);
    return text ? adopt(document, name, text, length, 1, error) : 0;
}

void mu_document_free(mu_document *document) {
    json_decref(document->root);
    free(document->name);
    free(document->text);
    *document = (mu_document){0};
}
