/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* pyramid.c: squares of 2^level vertices; the last ones of a row may be cut off by the period. */
#include "core/surface/pyramid.h"

#include <math.h>
#include <stdlib.h>

_Bool mu_pyramid_make(mu_pyramid *p, const mu_heightfield *f) {
    *p = (mu_pyramid){.nx = f->nx, .ny = f->ny, .levels = 1};
    p->height[0] = f->nx;
    p->width[0] = f->ny;
    p->level[0] = f->h;
    size_t room = 0;
    while ((p->height[p->levels - 1] > 1 || p->width[p->levels - 1] > 1) && p->levels < MU_PYRAMID_LEVELS) {
        const uint32_t height = (p->height[p->levels - 1] + 1) / 2, width = (p->width[p->levels - 1] + 1) / 2;
        p->height[p->levels] = height;
        p->width[p->levels++] = width;
        room += (size_t)height * width;
    }
    p->storage = malloc((room ? room : 1) * sizeof *p->storage);
    if (!p->storage) return 0;
    double *out = p->storage;
    for (uint32_t l = 1; l < p->levels; l++) {
        const uint32_t rows = p->height[l - 1], below = p->width[l - 1], width = p->width[l];
        const double *from = p->level[l - 1];
        p->level[l] = out;
        for (uint32_t i = 0; i < p->height[l]; i++)
            for (uint32_t j = 0; j < width; j++) {
                const size_t i1 = 2 * i + 1 < rows ? 2 * i + 1 : 2 * i,
                             j1 = 2 * j + 1 < below ? 2 * j + 1 : 2 * j;
                const double *a = from + (size_t)2 * i * below, *b = from + i1 * below;
                *out++ = fmax(fmax(a[2 * j], a[j1]), fmax(b[2 * j], b[j1]));
            }
    }
    return 1;
}

void mu_pyramid_free(mu_pyramid *p) {
    free(p->storage);
    *p = (mu_pyramid){0};
}

static uint32_t wrapped(int64_t i, uint32_t n) {
    const int64_t rest = i % (int64_t)n;
    return (uint32_t)(rest < 0 ? rest + n : rest);
}

double mu_pyramid_most(const mu_pyramid *p, int64_t i0, int64_t i1, int64_t j0, int64_t j1) {
    const int64_t nx = p->nx, ny = p->ny;
    if (i1 - i0 >= nx) i0 = 0, i1 = nx - 1;
    if (j1 - j0 >= ny) j0 = 0, j1 = ny - 1;
    const int64_t extent = i1 - i0 > j1 - j0 ? i1 - i0 : j1 - j0;
    uint32_t l = 0;
    while (l + 1 < p->levels && extent >> l > 3) l++;
    const uint32_t width = p->width[l];
    /* The period may end inside a square, so that a rectangle is met in up to two runs either way. */
    const uint32_t a0 = wrapped(i0, p->nx), b0 = wrapped(j0, p->ny);
    double most = -INFINITY;
    for (int64_t left_i = i1 - i0, a = a0; left_i >= 0;) {
        const uint32_t row = (uint32_t)a >> l;
        for (int64_t left_j = j1 - j0, b = b0; left_j >= 0;) {
            const uint32_t column = (uint32_t)b >> l;
            most = fmax(most, p->level[l][(size_t)row * width + column]);
            const int64_t end = ((int64_t)column + 1) << l, stop = end < ny ? end : ny;
            left_j -= stop - b;
            b = stop < ny ? stop : 0;
        }
        const int64_t end = ((int64_t)row + 1) << l, stop = end < nx ? end : nx;
        left_i -= stop - a;
        a = stop < nx ? stop : 0;
    }
    return most;
}
