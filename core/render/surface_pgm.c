/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_pgm.c: grey maps of Netpbm, P5 (bytes, or big-endian pairs of them above 255) and P2 (text): the codes, unscaled. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/render/surface_source.h"

/* The next number of the header (or of P2's pixels), blanks and comments passed over; -1: there is none. */
static long next_number(FILE *in) {
    int c = getc(in);
    while (c == '#' || isspace(c)) {
        while (c == '#' && (c = getc(in)) != '\n' && c != EOF)
            if (c != '\n') c = '#';
        c = getc(in);
    }
    if (!isdigit(c)) return -1;
    long number = 0;
    for (; isdigit(c) && number < 1000000; c = getc(in)) number = 10 * number + (c - '0');
    if (isdigit(c)) return -1;
    ungetc(c, in);
    return number;
}

static long next_code(FILE *in, _Bool text, _Bool wide) {
    if (text) return next_number(in);
    const int high = wide ? getc(in) : 0, low = getc(in);
    return high == EOF || low == EOF ? -1 : high << 8 | low;
}

double *mu_pgm_read(const char *file, int *width, int *height, mu_error *error) {
    FILE *in = fopen(file, "rbe");
    if (!in) {
        mu_fail(error, "%s: cannot be opened", file);
        return NULL;
    }
    const char *wrong = NULL;
    double *values = NULL;
    const _Bool text = getc(in) == 'P' && getc(in) == '2';
    const long w = next_number(in), h = next_number(in), most = next_number(in);
    if (w < 1 || h < 1 || w > MU_SURFACE_MOST || h > MU_SURFACE_MOST || most < 1 || most > 65535) {
        wrong = "its PGM header is damaged, or it is larger than 16384 pixels a side";
    } else {
        getc(in); /* one blank after the header */
        values = malloc((size_t)w * (size_t)h * sizeof *values);
        if (!values) wrong = "not enough memory";
    }
    for (size_t k = 0; !wrong && k < (size_t)w * (size_t)h; k++) {
        const long code = next_code(in, text, most > 255);
        if (code < 0) wrong = "is truncated or damaged";
        if (code > most) wrong = "holds codes above the largest that its header names";
        values[k] = (double)code;
    }
    fclose(in);
    *width = (int)w, *height = (int)h;
    if (!wrong) return values;
    free(values);
    mu_fail(error, "%s: %s", file, wrong);
    return NULL;
}
