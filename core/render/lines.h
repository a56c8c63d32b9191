/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* lines.h: a file line by line, for commands that answer line by line. */
#ifndef MU_LINES_H
#define MU_LINES_H

#include <stddef.h>

typedef struct mu_lines {
    int file; /* descriptor; not closed by mu_lines_free */
    char *buffer;
    size_t room, begin, end;
    size_t number; /* of the last line returned, from 1 */
    int failure;   /* errno of the read that failed, or of the lack of memory */
    _Bool ended, skipping;
    /* Called before each read, which may wait: what was answered so far must be on its way by then, so that a
     * partner who waits for the answer before it asks again is not kept waiting. False stops the reading. */
    _Bool (*before_read)(void *context);
    void *context;
} mu_lines;

typedef enum mu_line { MU_LINE, MU_LINE_TOO_LONG, MU_LINES_END, MU_LINES_FAILED } mu_line;

/* The next line without its newline, valid until the next call. Longer lines than `longest` are passed over.
 */
mu_line mu_lines_next(mu_lines *lines, size_t longest, const char **text, size_t *length);
void mu_lines_free(mu_lines *lines);

#endif
