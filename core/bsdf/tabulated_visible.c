/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * tabulated_visible.c: visible normals of a slope histogram from any direction, by inversion: the exact areas of rows give the
 * row, those of its cells the cell. Work grows with columns + rows. Compiled once, in double. Not in the paper.
 */
#include "core/bsdf/tabulated.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 53

/* The cell in [first, last) of the row, all inside, in which the area from `first` on passes `target`. */
static size_t inside_cell(const half_plane *h, const tabulated_grid *g, const cut_cells *cut, size_t row,
                          size_t first, size_t last, double target) {
    const double *mass = g->mass + row * (g->columns + 1), *moment = g->moment + row * (g->columns + 1);
    size_t low = first, high = last;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        const double area =
            cut->centre * (mass[middle] - mass[first]) + h->k[0] * (moment[middle] - moment[first]);
        if (area > target)
            high = middle;
        else
            low = middle;
    }
    while (low > first && !(mass[low + 1] > mass[low]))
        low--; /* rounding went past the last that is not empty */
    return low;
}

static size_t cell_of(const half_plane *h, const tabulated_grid *g, const cut_cells *cut, size_t row,
                      double target) {
    const double *mass = g->mass + row * (g->columns + 1), *moment = g->moment + row * (g->columns + 1);
    const size_t n = g->columns;
    const double step = h->k[0] * g->cell[0], x0 = g->origin[0] + g->cell[0] / 2;
    if (!(step > 0)) { /* those inside come first */
        const double area = cut->centre * mass[cut->first] + h->k[0] * moment[cut->first];
        if (target < area) return inside_cell(h, g, cut, row, 0, cut->first, target);
        target -= area;
    }
    size_t best = n; /* the last with any area: where rounding left more to pass than there is */
    for (size_t i = cut->first; i < cut->last; i++) {
        const double area =
            (mass[i + 1] - mass[i]) * mu_half_plane_cell(h, cut->centre + h->k[0] * x0 + (double)i * step);
        if (!(area > 0)) continue;
        best = i;
        if (target < area) return i;
        target -= area;
    }
    if (step > 0 && cut->last < n && mass[n] > mass[cut->last])
        return inside_cell(h, g, cut, row, cut->last, n, target);
    if (best < n) return best;
    return step > 0 ? n - 1 : inside_cell(h, g, cut, row, 0, cut->first > 0 ? cut->first : 1, target);
}

/* Where in a cell, as fractions of its sides, with a density like the positive part of k. Uniform in the smallest rectangle,
 * at the corner that faces most, that holds all of it: k over its largest value accepts 1/6 (a triangle) to 1. */
static void within_cell(const half_plane *h, double middle, double (*more)(void *), void *state,
                        double f[2]) {
    const double most = middle + h->half; /* at the corner that faces most */
    double side[2];
    f[0] = f[1] = 0.5;
    if (!(most > 0)) return;
    for (int i = 0; i < 2; i++) side[i] = h->span[i] > most ? most / h->span[i] : 1;
    f[0] = f[1] = 0;
    for (int tries = 0; tries < 128; tries++) {
        const double x = side[0] * more(state), y = side[1] * more(state);
        if (more(state) * most >= most - x * h->span[0] - y * h->span[1]) continue;
        f[0] = x, f[1] = y;
        break;
    }
    for (int i = 0; i < 2; i++)
        if (h->k[i] > 0) f[i] = 1 - f[i]; /* the corner lies at the upper end */
}

void mu_tabulated_visible(const tabulated_grid *g, const double w[3], const double u[2],
                          double (*more)(void *state), void *state, double p[2]) {
    const half_plane h = mu_half_plane(g, w);
    double area[TABULATED_MOST], total = 0;
    for (size_t j = 0; j < g->rows; j++) total += area[j] = mu_half_plane_row(&h, g, j).area;
    double target = u[1] * total;
    size_t row = 0; /* the last with any area, where rounding left too much of the target */
    for (size_t j = 0; j < g->rows; j++) {
        if (!(area[j] > 0)) continue;
        row = j;
        if (target < area[j]) break;
        target -= area[j];
    }
    const cut_cells cut = mu_half_plane_row(&h, g, row);
    const size_t column = cell_of(&h, g, &cut, row, u[0] * cut.area);
    const double x = g->origin[0] + ((double)column + 0.5) * g->cell[0];
    double f[2];
    within_cell(&h, cut.centre + h.k[0] * x, more, state, f);
    p[0] = g->origin[0] + ((double)column + f[0]) * g->cell[0];
    p[1] = g->origin[1] + ((double)row + f[1]) * g->cell[1];
}

#endif
