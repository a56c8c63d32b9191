/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* error.c: formats the one line that a user gets. It may quote hostile bytes, so it never passes on a control
 * character (terminal escapes) or a broken UTF-8 sequence. */
#include "core/render/error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core/render/utf8.h"

/* C0, DEL and C1: what a terminal might obey. */
static _Bool is_control(const char *at, size_t count) {
    const unsigned char first = (unsigned char)at[0];
    if (count == 1) return first < 0x20 || first == 0x7f;
    return count == 2 && first == 0xc2 && (unsigned char)at[1] < 0xa0;
}

static void write_line(mu_error *error, const char *format, va_list arguments) {
    const int wanted = vsnprintf(error->text, sizeof error->text, format, arguments);
    if (wanted <= 0) {
        strcpy(error->text, "unknown error");
        return;
    }

    size_t length = strlen(error->text);
    const _Bool cut = (size_t)wanted >= sizeof error->text;
    if (cut) length -= 3; /* room for the dots */
    char *out = error->text;
    for (size_t at = 0; at < length;) {
        const size_t count = mu_utf8_character(error->text + at, length - at);
        if (cut && !count && length - at < 4) break; /* the last character was cut in half */
        if (!count || is_control(error->text + at, count)) {
            *out++ = '?';
            at += count ? count : 1;
        } else {
            memmove(out, error->text + at, count);
            out += count;
            at += count;
        }
    }
    strcpy(out, cut ? "..." : "");
}

_Bool mu_fail(mu_error *error, const char *format, ...) {
    if (!error || error->text[0]) return 0;
    va_list arguments;
    va_start(arguments, format);
    write_line(error, format, arguments);
    va_end(arguments);
    return 0;
}

void mu_warn(const mu_error *error, const char *format, ...) {
    mu_error line = {.text = ""};
    va_list arguments;
    va_start(arguments, format);
    write_line(&line, format, arguments);
    va_end(arguments);
    if (error && error->warn)
        error->warn(error->context, line.text);
    else
        fprintf(stderr, "musurf: warning: %s\n", line.text);
}
