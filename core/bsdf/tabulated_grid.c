/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* tabulated_grid.c: from a slope histogram to the sums that answer for any part of a row at once. Compiled once, in
 * double. Not in the papers, which leave it to a black box (Atanasov et al. 2022, Section 4.5). */
#include "core/bsdf/tabulated.h"

#include "core/bsdf/real.h"

#if MU_REAL_BITS == 53

/* The smallest rectangle of cells with all the mass; the largest weight. */
typedef struct frame {
    size_t columns[2], rows[2]; /* [first, last) */
    double largest, width[2];
} frame;

static frame frame_of(const mu_definition *d) {
    frame f = {{d->histogram_columns, 0}, {d->histogram_rows, 0}, 0, {0}};
    for (size_t j = 0; j < d->histogram_rows; j++)
        for (size_t i = 0; i < d->histogram_columns; i++) {
            const double weight = d->histogram[j * d->histogram_columns + i];
            if (!(weight > 0)) continue;
            f.largest = fmax(f.largest, weight);
            if (i < f.columns[0]) f.columns[0] = i;
            if (i >= f.columns[1]) f.columns[1] = i + 1;
            if (j < f.rows[0]) f.rows[0] = j;
            if (j >= f.rows[1]) f.rows[1] = j + 1;
        }
    const double *b = d->histogram_bounds;
    f.width[0] = (b[1] - b[0]) / (double)d->histogram_columns;
    f.width[1] = (b[3] - b[2]) / (double)d->histogram_rows;
    return f;
}

/* Relative to the largest: the sum of them is finite. */
static double weight_at(const mu_definition *d, double largest, size_t i, size_t j) {
    return d->histogram[j * d->histogram_columns + i] / largest;
}

void mu_tabulated_moments(const mu_definition *d, double mean[2], double covariance[3]) {
    const frame f = frame_of(d);
    double total = 0, first[2] = {0}, second[3] = {0};
    /* in cells, about the middle of the frame */
    const double middle[2] = {(double)(f.columns[0] + f.columns[1]) / 2, (double)(f.rows[0] + f.rows[1]) / 2};
    for (size_t j = f.rows[0]; j < f.rows[1]; j++)
        for (size_t i = f.columns[0]; i < f.columns[1]; i++) {
            const double w = weight_at(d, f.largest, i, j), x = (double)i + 0.5 - middle[0],
                         y = (double)j + 0.5 - middle[1];
            total += w, first[0] += w * x, first[1] += w * y;
        }
    for (int k = 0; k < 2; k++) first[k] /= total;
    for (size_t j = f.rows[0]; j < f.rows[1]; j++)
        for (size_t i = f.columns[0]; i < f.columns[1]; i++) {
            const double w = weight_at(d, f.largest, i, j), x = (double)i + 0.5 - middle[0] - first[0],
                         y = (double)j + 0.5 - middle[1] - first[1];
            second[0] += w * x * x, second[1] += w * x * y, second[2] += w * y * y;
        }
    covariance[0] = (second[0] / total + 1. / 12) * f.width[0] * f.width[0];
    covariance[1] = second[1] / total * f.width[0] * f.width[1];
    covariance[2] = (second[2] / total + 1. / 12) * f.width[1] * f.width[1];
    for (int k = 0; k < 2; k++) {
        mean[k] = d->histogram_bounds[2 * k] + (middle[k] + first[k]) * f.width[k];
        /* no more than the rounding of the sums: a symmetric table is not tilted */
        const double extent = fmax(fabs(d->histogram_bounds[2 * k]), fabs(d->histogram_bounds[2 * k + 1]));
        if (fabs(mean[k]) < 1e-14 * extent) mean[k] = 0;
    }
}

double mu_tabulated_spread(const double covariance[3]) {
    return sqrt(covariance[0] + covariance[2]);
}

double mu_tabulated_density(const tabulated_grid *g, const mu_definition *d, size_t column, size_t row) {
    const double mass = weight_at(d, g->largest, g->last[0] - column, g->last[1] - row) / g->total;
    return mass / g->cell[0] / g->cell[1];
}

size_t mu_tabulated_grid_bytes(const mu_definition *d) {
    return (3 * (d->histogram_columns + 1) * d->histogram_rows + 2 * (d->histogram_rows + 1)) *
           sizeof(double);
}

static void roots(tabulated_grid *g, const double covariance[3], double unit) {
    const double xx = covariance[0] / unit / unit, xy = covariance[1] / unit / unit,
                 yy = covariance[2] / unit / unit;
    g->root[0] = sqrt(xx);
    g->root[1] = xy / g->root[0];
    /* a cell's own variance is a lower bound that no rounding breaks */
    g->root[2] = sqrt(fmax(yy - g->root[1] * g->root[1], g->cell[1] * g->cell[1] / 12));
}

/* |L^-1 p| */
static double reach_of(const tabulated_grid *g, double x, double y) {
    const double first = x / g->root[0];
    return hypot(first, (y - g->root[1] * first) / g->root[2]);
}

/* Cells with more than their share that are narrower, along one side at least, than some ten steps of the table. */
static void find_heavy(tabulated_grid *g) {
    const double narrowest = fmin(g->cell[0] / g->root[0], g->cell[1] / g->root[2]);
    const size_t stride = g->columns + 1;
    g->heavy = 0, g->light = 0;
    for (size_t j = 0; j < g->rows; j++)
        for (size_t i = 0; i < g->columns; i++) {
            const double m = g->mass[j * stride + i + 1] - g->mass[j * stride + i];
            if (m > 1.0 / TABULATED_HEAVY && narrowest < 0.25 && g->heavy < TABULATED_HEAVY) {
                g->heavy_cell[g->heavy++] = (tabulated_cell){{g->origin[0] + ((double)i + 0.5) * g->cell[0],
                                                              g->origin[1] + ((double)j + 0.5) * g->cell[1]},
                                                             m};
            } else {
                g->light += m;
            }
        }
}

void mu_tabulated_grid_make(tabulated_grid *g, const mu_definition *d, double *sums) {
    const frame f = frame_of(d);
    double mean[2], covariance[3];
    mu_tabulated_moments(d, mean, covariance);
    const double unit = mu_tabulated_spread(covariance);
    g->columns = f.columns[1] - f.columns[0], g->rows = f.rows[1] - f.rows[0];
    for (int k = 0; k < 2; k++) {
        g->last[k] = (k ? f.rows[1] : f.columns[1]) - 1;
        g->cell[k] = f.width[k] / unit;
        g->origin[k] =
            (mean[k] - (d->histogram_bounds[2 * k] + (double)(g->last[k] + 1) * f.width[k])) / unit;
    }
    roots(g, covariance, unit);
    g->farthest =
        fmax(reach_of(g, g->cell[0] / 2, g->cell[1] / 2), reach_of(g, g->cell[0] / 2, -g->cell[1] / 2));

    const size_t stride = g->columns + 1;
    g->mass = sums, g->moment = g->mass + stride * g->rows, g->reach = g->moment + stride * g->rows;
    g->mass_below = g->reach + stride * g->rows, g->reach_below = g->mass_below + g->rows + 1;
    g->largest = f.largest, g->total = 0;
    for (size_t j = f.rows[0]; j < f.rows[1]; j++)
        for (size_t i = f.columns[0]; i < f.columns[1]; i++) g->total += weight_at(d, f.largest, i, j);
    g->mass_below[0] = g->reach_below[0] = 0;
    for (size_t j = 0; j < g->rows; j++) {
        double *mass = g->mass + j * stride, *moment = g->moment + j * stride, *reach = g->reach + j * stride;
        const double y = g->origin[1] + ((double)j + 0.5) * g->cell[1];
        mass[0] = moment[0] = reach[0] = 0;
        for (size_t i = 0; i < g->columns; i++) {
            const double m = weight_at(d, g->largest, g->last[0] - i, g->last[1] - j) / g->total;
            const double x = g->origin[0] + ((double)i + 0.5) * g->cell[0];
            mass[i + 1] = mass[i] + m;
            moment[i + 1] = moment[i] + m * x;
            reach[i + 1] = reach[i] + m * (reach_of(g, x, y) + g->farthest);
        }
        g->mass_below[j + 1] = g->mass_below[j] + mass[g->columns];
        g->reach_below[j + 1] = g->reach_below[j] + reach[g->columns];
    }
    g->mean_reach = g->reach_below[g->rows];
    find_heavy(g);
}

#endif
