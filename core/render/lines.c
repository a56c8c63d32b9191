/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* lines.c: reads in large pieces, keeps what is left of a line for the next one, never holds more than the
 * longest line allowed. */
#include "core/render/lines.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { PIECE = 1 << 16 };

/* Makes room for a piece behind `end`. */
static _Bool make_room(mu_lines *l) {
    if (l->begin > 0) {
        memmove(l->buffer, l->buffer + l->begin, l->end - l->begin);
        l->end -= l->begin;
        l->begin = 0;
    }
    if (l->room - l->end >= PIECE) return 1;
    const size_t room = 2 * l->room + PIECE;
    char *buffer = realloc(l->buffer, room);
    if (!buffer) {
        l->failure = ENOMEM;
        return 0;
    }
    l->buffer = buffer;
    l->room = room;
    return 1;
}

/* One read. False if it failed or there is no more. */
static _Bool read_piece(mu_lines *l) {
    if (l->before_read && !l->before_read(l->context)) {
        l->ended = 1;
        return 0;
    }
    if (!make_room(l)) return 0;
    ssize_t got;
    do got = read(l->file, l->buffer + l->end, PIECE);
    while (got < 0 && errno == EINTR);
    if (got < 0) l->failure = errno;
    if (got == 0) l->ended = 1;
    if (got > 0) l->end += (size_t)got;
    return got > 0;
}

mu_line mu_lines_next(mu_lines *l, size_t longest, const char **text, size_t *length) {
    size_t scanned = 0;
    for (;;) {
        const char *const start = l->buffer ? l->buffer + l->begin : NULL;
        const size_t there = l->end - l->begin;
        const char *const newline = there > scanned ? memchr(start + scanned, '\n', there - scanned) : NULL;
        const _Bool last = !newline && l->ended && (there > 0 || l->skipping);
        if (newline || last) {
            const _Bool skipped = l->skipping;
            *text = start;
            *length = newline ? (size_t)(newline - start) : there;
            l->begin += *length + (newline != NULL);
            l->skipping = 0;
            l->number++;
            return skipped || *length > longest ? MU_LINE_TOO_LONG : MU_LINE;
        }
        if (l->ended) return MU_LINES_END;
        scanned = there;
        if (there > longest) { /* its rest is of no interest */
            l->begin = l->end;
            l->skipping = 1;
            scanned = 0;
        }
        if (!read_piece(l) && l->failure) return MU_LINES_FAILED;
    }
}

void mu_lines_free(mu_lines *lines) {
    free(lines->buffer);
    lines->buffer = NULL;
}
