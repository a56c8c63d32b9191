/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* output_stream.h: a file of output.h written from beginning to end by stdio, for what is too large to hold. */
#ifndef MU_OUTPUT_STREAM_H
#define MU_OUTPUT_STREAM_H

#include <stdio.h>

#include "core/render/output.h"

typedef struct mu_output_stream {
    mu_output output;
    uint64_t at;
    FILE *file; /* writes to it need no check: a failure is remembered */
} mu_output_stream;

/* The stream must stay where it is in memory until it is committed or discarded. */
_Bool mu_output_stream_open(mu_output_stream *stream, const char *file, mu_error *error);
_Bool mu_output_stream_commit(mu_output_stream *stream, mu_error *error);
void mu_output_stream_discard(mu_output_stream *stream);

#endif
