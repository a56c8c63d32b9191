/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* text.h: a message put together piece by piece in a buffer of fixed size. */
#ifndef MU_TEXT_H
#define MU_TEXT_H

#include <string.h>

/* Appends to the string in `out`; what does not fit into `size` is left out. */
static inline void mu_append(char *out, size_t size, const char *text) {
    const size_t length = strlen(out), more = strlen(text), room = size - length - 1;
    const size_t count = more < room ? more : room;
    memcpy(out + length, text, count);
    out[length + count] = '\0';
}

#endif
