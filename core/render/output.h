/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * output.h: a file that appears whole or not at all.
 *
 * It is written beside its place under another name, flushed to the disk and renamed; whatever goes wrong
 * before that, a file that was there already stays as it was.
 */
#ifndef MU_OUTPUT_H
#define MU_OUTPUT_H

#include <stddef.h>
#include <stdint.h>

#include "core/render/error.h"

typedef struct mu_output {
    char *target; /* where it will appear, symbolic links resolved */
    char *beside; /* where it is being written */
    int descriptor;
    int trouble; /* errno of the first write that failed, or 0 */
} mu_output;

/* Whether `file` could be written: its folder exists and takes files, and nothing but a writable regular file
 * stands there. Leaves no trace. */
_Bool mu_output_check(const char *file, mu_error *error);
/* Whether the file's name, less its folder, is more than `ending` and ends so. */
_Bool mu_output_ends_in(const char *file, const char *ending);
_Bool mu_output_open(mu_output *output, const char *file, mu_error *error);
/* At any offset, in any order. A failure is remembered, so that only commit needs a check. */
_Bool mu_output_write(mu_output *output, const void *data, size_t bytes, uint64_t offset);
/* Closes either way. On failure nothing is left but what was there before. */
_Bool mu_output_commit(mu_output *output, mu_error *error);
void mu_output_discard(mu_output *output);

#endif
