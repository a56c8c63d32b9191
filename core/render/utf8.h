/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* utf8.h: what is one UTF-8 character, and where in a text is the first byte that is none. */
#ifndef MU_UTF8_H
#define MU_UTF8_H

#include <stddef.h>

/* Bytes of the character that starts at `text` (1 to 4), or 0 if the `length` bytes there start with no
 * shortest-form UTF-8 character of a Unicode scalar value (RFC 3629). */
size_t mu_utf8_character(const char *text, size_t length);

/* Offset of the first byte that belongs to no character; `length` if all do. */
size_t mu_utf8_valid(const char *text, size_t length);

#endif
