/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* utf8.c: UTF-8 by the table of RFC 3629, section 4. Needed twice: to keep messages printable, and to point
 * at the very byte of a document that is wrong. */
#include "core/render/utf8.h"

size_t mu_utf8_character(const char *text, size_t length) {
    const unsigned char *s = (const unsigned char *)text;
    if (length == 0) return 0;
    if (s[0] < 0x80) return 1;

    size_t count;
    unsigned char low = 0x80,
                  high = 0xbf; /* range of the second byte: excludes overlong forms and surrogates */
    if (s[0] >= 0xc2 && s[0] <= 0xdf) {
        count = 2;
    } else if (s[0] >= 0xe0 && s[0] <= 0xef) {
        count = 3;
        if (s[0] == 0xe0) low = 0xa0;
        if (s[0] == 0xed) high = 0x9f;
    } else if (s[0] >= 0xf0 && s[0] <= 0xf4) {
        count = 4;
        if (s[0] == 0xf0) low = 0x90;
        if (s[0] == 0xf4) high = 0x8f;
    } else {
        return 0;
    }
    if (length < count || s[1] < low || s[1] > high) return 0;
    for (size_t i = 2; i < count; i++)
        if ((s[i] & 0xc0) != 0x80) return 0;
    return count;
}

size_t mu_utf8_valid(const char *text, size_t length) {
    size_t at = 0;
    while (at < length) {
        const size_t count = mu_utf8_character(text + at, length - at);
        if (!count) break;
        at += count;
    }
    return at;
}
