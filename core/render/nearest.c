/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* nearest.c: the known word that a mistyped one was probably meant to be: the least number of insertions,
 * deletions, substitutions and swaps of neighbours (optimal string alignment), upper and lower case alike. */
#include <ctype.h>
#include <string.h>
#include <strings.h>

#include "core/render/document.h"

enum { LONGEST = 64 };

static size_t least(size_t a, size_t b) {
    return a < b ? a : b;
}

static size_t distance(const char *a, size_t m, const char *b, size_t n) {
    size_t rows[3][LONGEST + 1]; /* the last three rows of the table, in turn */
    for (size_t j = 0; j <= n; j++) rows[0][j] = j;
    for (size_t i = 1; i <= m; i++) {
        size_t *now = rows[i % 3], *above = rows[(i + 2) % 3], *two_above = rows[(i + 1) % 3];
        now[0] = i;
        for (size_t j = 1; j <= n; j++) {
            const int x = tolower((unsigned char)a[i - 1]), y = tolower((unsigned char)b[j - 1]);
            now[j] = least(least(above[j] + 1, now[j - 1] + 1), above[j - 1] + (x != y));
            if (i > 1 && j > 1 && x == tolower((unsigned char)b[j - 2]) &&
                y == tolower((unsigned char)a[i - 2]))
                now[j] = least(now[j], two_above[j - 2] + 1);
        }
    }
    return rows[m % 3][n];
}

const char *mu_nearest(const char *word, const char *const *candidates) {
    const size_t length = strlen(word);
    if (length == 0 || length > LONGEST) return NULL;

    /* One slip in a short word, one in three letters of a long one: beyond that a guess misleads. */
    size_t best = length == 1 ? 1 : length < 4 ? 2 : (length + 2) / 3 + 1;
    const char *found = NULL, *longer = NULL;
    for (; *candidates; candidates++) {
        const size_t other = strlen(*candidates);
        if (other > LONGEST) continue;
        const size_t d = distance(word, length, *candidates, other);
        if (d < best) best = d, found = *candidates;
        /* An abbreviation: "rough" for "roughness". */
        if (length >= 3 && !longer && strncasecmp(word, *candidates, length) == 0) longer = *candidates;
    }
    return found ? found : longer;
}
