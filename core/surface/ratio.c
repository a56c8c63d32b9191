/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* ratio.c: the sums behind ratio.h. */
#include "core/surface/ratio.h"

#include <math.h>
#include <stdlib.h>

_Bool mu_ratios_make(mu_ratios *r, size_t units, size_t cells, double *bottom) {
    *r = (mu_ratios){units, cells, calloc(units * cells, sizeof *r->top), bottom, bottom != NULL};
    if (!bottom) r->bottom = calloc(units * cells, sizeof *r->bottom);
    return r->top && r->bottom;
}

void mu_ratios_free(mu_ratios *r) {
    free(r->top);
    if (!r->shared) free(r->bottom);
    *r = (mu_ratios){0};
}

mu_ratio mu_ratios_get(const mu_ratios *r, size_t cell) {
    const double nan = (double)NAN, units = (double)r->units;
    double top = 0, bottom = 0, squares = 0;
    for (size_t k = 0; k < r->units; k++) {
        top += r->top[k * r->cells + cell];
        bottom += r->shared ? r->bottom[k] : r->bottom[k * r->cells + cell];
    }
    if (!(bottom > 0)) return (mu_ratio){nan, nan};
    for (size_t k = 0; k < r->units; k++) {
        const double b = r->shared ? r->bottom[k] : r->bottom[k * r->cells + cell];
        const double rest = r->top[k * r->cells + cell] - top / bottom * b;
        squares += rest * rest;
    }
    return (mu_ratio){top / bottom, r->units > 1 ? sqrt(squares * units / (units - 1)) / bottom : nan};
}
