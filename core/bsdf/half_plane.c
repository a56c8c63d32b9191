/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * half_plane.c: the integral of the positive part of k = k0 x + k1 y + k2 against a piecewise constant density, row by row:
 * cells inside from sums over the row, cells that the line k = 0 cuts one by one, at most columns + rows in all. Compiled
 * once, in double. Not in the paper.
 */
#include "core/bsdf/tabulated.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 53

half_plane mu_half_plane(const tabulated_grid *g, const double k[3]) {
    half_plane h = {.k = {k[0], k[1], k[2]}, .span = {fabs(k[0]) * g->cell[0], fabs(k[1]) * g->cell[1]}};
    h.more = fmax(h.span[0], h.span[1]), h.less = fmin(h.span[0], h.span[1]);
    h.half = (h.more + h.less) / 2;
    if (h.less < 1e-18 * h.more) h.less = 0; /* below the last place of the mean */
    h.per_less = h.less > 0 ? 1 / h.less : 0;
    return h;
}

/* Over a cell, k spans a trapezoidal density: from middle - half, rising over `less`. With s = half - |middle| the size of the
 * part of the other sign at its corner:
 *     s <= less:  s³ / (6 less more);    up to half:  (s² - s less + less²/3) / (2 more);   from half: by symmetry. */
double mu_half_plane_cell(const half_plane *h, double middle) {
    const double s = h->half - fabs(middle), other = middle > 0 ? middle : 0;
    if (!(s > 0)) return other;
    if (s <= h->less) return other + s * (s / h->more) * (s * h->per_less) / 6;
    return other + (s * (s - h->less) + h->less * h->less / 3) / (2 * h->more);
}

/* Clamped to 0 ... n; NaN, of a row along the line, to 0. */
static size_t column(double x, size_t n) {
    return !(x > 0) ? 0 : x < (double)n ? (size_t)x : n;
}

cut_cells mu_half_plane_row(const half_plane *h, const tabulated_grid *g, size_t row) {
    const double x0 = g->origin[0] + g->cell[0] / 2, y = g->origin[1] + ((double)row + 0.5) * g->cell[1];
    const double centre = h->k[1] * y + h->k[2],
                 start = centre + h->k[0] * x0; /* at the first cell's middle */
    const double step = h->k[0] * g->cell[0];
    const size_t n = g->columns, stride = n + 1;
    cut_cells out = {0, n, centre, 0};
    if (step > 0) { /* outside, cut, inside */
        out.first = column((-h->half - start) / step, n);
        out.last = column((h->half - start) / step + 1, n);
    } else if (step < 0) { /* inside, cut, outside */
        out.first = column((h->half - start) / step, n);
        out.last = column((-h->half - start) / step + 1, n);
    } else if (fabs(start) >= h->half) {
        out.first = out.last = start > 0 ? n : 0; /* all inside, to the left of it; or none */
    }
    const double *mass = g->mass + row * stride, *moment = g->moment + row * stride;
    if (step > 0)
        out.area = centre * (mass[n] - mass[out.last]) + h->k[0] * (moment[n] - moment[out.last]);
    else
        out.area = centre * mass[out.first] + h->k[0] * moment[out.first];
    for (size_t i = out.first; i < out.last; i++)
        out.area += (mass[i + 1] - mass[i]) * mu_half_plane_cell(h, start + (double)i * step);
    out.area = fmax(out.area, 0); /* rounding */
    return out;
}

#endif
