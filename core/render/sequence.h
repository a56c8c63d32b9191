/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * sequence.h: files that are numbered: "balloon_####.ply" is balloon_0001.ply, balloon_0002.ply, ... The last run of #
 * in the name after the last slash stands for the number, with zeros in front to that many digits. A file that is
 * there under the very name is no sequence.
 */
#ifndef MU_SEQUENCE_H
#define MU_SEQUENCE_H

#include <stddef.h>

#include "core/render/error.h"

#define MU_NO_FRAME (-1)
enum { MU_LAST_FRAME = 999999999 };

_Bool mu_sequence_is(const char *pattern);
/* The file of one number, to be freed; NULL without memory. */
char *mu_sequence_file(const char *pattern, long long frame);
/* The numbers there are files of, rising, to be freed; at least one, or it fails. */
_Bool mu_sequence_list(const char *pattern, long long **frames, size_t *count, mu_error *error);

#endif
