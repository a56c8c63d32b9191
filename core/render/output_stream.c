/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* output_stream.c: a stdio stream whose writes go to mu_output (GNU fopencookie). */
#include "core/render/output_stream.h"

enum { BUFFER = 1 << 20 };

static ssize_t take(void *context, const char *bytes, size_t size) {
    mu_output_stream *s = context;
    if (!mu_output_write(&s->output, bytes, size, s->at))
        return 0; /* 0 is an error here, -1 is not allowed */
    s->at += size;
    return (ssize_t)size;
}

_Bool mu_output_stream_open(mu_output_stream *s, const char *file, mu_error *error) {
    *s = (mu_output_stream){.at = 0};
    if (!mu_output_open(&s->output, file, error)) return 0;
    s->file = fopencookie(s, "w", (cookie_io_functions_t){.write = take});
    if (s->file && !setvbuf(s->file, NULL, _IOFBF, BUFFER)) return 1;
    mu_output_stream_discard(s);
    return mu_fail(error, "%s: out of memory", file);
}

_Bool mu_output_stream_commit(mu_output_stream *s, mu_error *error) {
    fclose(s->file); /* flushes; what fails there is in output.trouble */
    s->file = NULL;
    return mu_output_commit(&s->output, error);
}

void mu_output_stream_discard(mu_output_stream *s) {
    if (s->file) fclose(s->file);
    s->file = NULL;
    mu_output_discard(&s->output);
}
