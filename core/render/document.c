/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * document.c: reads and parses a JSON document. What jansson finds wrong is said again in one line that
 * points at the beginning of the offending text.
 */
#include "core/render/document.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/render/document_syntax.h"
#include "core/render/utf8.h"

static _Bool parse(mu_document *d, mu_error *error) {
    /* A byte order mark, as some editors leave it, becomes white space. */
    if (d->length >= 3 && memcmp(d->text, "\xef\xbb\xbf", 3) == 0) memset(d->text, ' ', 3);

    const char *const nul = memchr(d->text, '\0', d->length);
    if (nul) return mu_syntax_fail(d, (size_t)(nul - d->text), error, "a NUL byte; JSON text is needed");
    const size_t valid = mu_utf8_valid(d->text, d->length);
    if (valid < d->length)
        return mu_syntax_fail(d, valid, error, "byte 0x%02x is not UTF-8",
                              (unsigned)(unsigned char)d->text[valid]);
    if (strspn(d->text, " \t\r\n") == d->length)
        return mu_syntax_fail(d, 0, error, "is empty; a JSON object is needed");

    json_error_t found;
    d->root = json_loadb(d->text, d->length, JSON_REJECT_DUPLICATES | JSON_DECODE_ANY, &found);
    return d->root ? 1 : mu_syntax_retell(d, &found, error);
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
            mu_fail(error, "%s:1:1: $: larger than %d MiB; no document needs that", name,
                    MU_DOCUMENT_LIMIT >> 20);
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
        mu_fail(error, "%s:1:1: $: larger than %d MiB; no document needs that", name,
                MU_DOCUMENT_LIMIT >> 20);
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

char *mu_document_beside(const mu_document *document, const char *name) {
    const char *file = document->name;
    const char *slash = strrchr(file, '/');
    const size_t folder = slash && name[0] != '/' ? (size_t)(slash - file) + 1 : 0;
    char *path = malloc(folder + strlen(name) + 1);
    if (!path) return NULL;
    memcpy(path, file, folder);
    strcpy(path + folder, name);
    return path;
}
