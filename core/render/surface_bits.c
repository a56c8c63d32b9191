/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * surface_bits.c: NumPy's .npy format 1.0: magic, version, length of the header (two bytes, little-endian), a Python
 * dictionary filled up with blanks and a newline so that the data begin at a multiple of 64, the data.
 */
#include "core/render/surface_bits.h"

#include <stdio.h>
#include <string.h>

#include "core/render/output.h"

enum { PREFIX = 10, ALIGN = 64 };

_Bool mu_surface_bits(const char *file, const mu_measuring *s, mu_error *error) {
    const size_t cells = mu_cells(&s->f);
    char head[4 * ALIGN];
    memset(head, ' ', sizeof head);
    memcpy(head, "\x93NUMPY\x01\x00", 8);
    const int text = snprintf(head + PREFIX, sizeof head - PREFIX,
                              "{'descr': '|u1', 'fortran_order': False, 'shape': (%u, 2, %u, %u), }",
                              s->view_count, s->f.nx, s->f.ny);
    const size_t used = PREFIX + (size_t)text, size = (used + 1 + ALIGN - 1) / ALIGN * ALIGN;
    memset(head + used, ' ', size - used);
    head[size - 1] = '\n';
    head[8] = (char)((size - PREFIX) & 255), head[9] = (char)((size - PREFIX) >> 8);
    mu_output output;
    if (!mu_output_open(&output, file, error)) return 0;
    uint64_t at = size;
    mu_output_write(&output, head, size, 0);
    for (uint32_t v = 0; v < s->view_count; v++)
        for (int upper = 0; upper < 2; upper++, at += cells)
            mu_output_write(&output, s->views[v].seen[upper], cells, at);
    return mu_output_commit(&output, error);
}
