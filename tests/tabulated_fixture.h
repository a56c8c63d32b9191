/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * tabulated_fixture.h: histograms of slopes for tests, and their projected areas told without the core: each cell of the
 * transformed histogram is a parallelogram of slopes, which is clipped to the side that faces w and integrated as a fan of
 * triangles (Sutherland & Hodgman 1974), no sums over rows, no formula for a cut rectangle.
 */
#ifndef MU_TEST_TABULATED_FIXTURE_H
#define MU_TEST_TABULATED_FIXTURE_H

#include <stdlib.h>

#include "tests/bsdf_fixture.h"

typedef struct tabulated_surfaces {
    void *in_double, *in_float;
    mu_surface_d *d;
    mu_surface_f *f;
} tabulated_surfaces;

static inline mu_definition tabulated_definition(const double *weights, size_t columns, size_t rows,
                                                 double x_min, double x_max, double y_min, double y_max) {
    mu_definition d = mu_definition_default();
    d.ndf = MU_TABULATED;
    d.histogram = weights, d.histogram_columns = columns, d.histogram_rows = rows;
    d.histogram_bounds[0] = x_min, d.histogram_bounds[1] = x_max;
    d.histogram_bounds[2] = y_min, d.histogram_bounds[3] = y_max;
    return d;
}

static inline tabulated_surfaces tabulated_make(const mu_definition *d, int with_float) {
    tabulated_surfaces s = {0};
    mu_complaint why;
    if (!mu_definition_check(d, &why)) print_error("%s: %s\n", why.field, why.text);
    assert_true(mu_definition_check(d, &why));
    s.in_double = malloc(mu_surface_bytes_d(d));
    assert_non_null(s.in_double);
    s.d = mu_surface_make_d(d, s.in_double);
    if (with_float) {
        s.in_float = malloc(mu_surface_bytes_f(d));
        assert_non_null(s.in_float);
        s.f = mu_surface_make_f(d, s.in_float);
    }
    return s;
}

static inline void tabulated_free(tabulated_surfaces *s) {
    free(s->in_double);
    free(s->in_float);
}

/* The slope (dz/dx, dz/dy) of the transformed surface where the untransformed one has s: M^-T (s + tilt). */
static inline void tabulated_move(const mu_definition *d, const double s[2], double out[2]) {
    const double *m = d->transform, det = m[0] * m[3] - m[1] * m[2];
    const double x = s[0] + d->tilt[0], y = s[1] + d->tilt[1];
    out[0] = (m[3] * x - m[2] * y) / det;
    out[1] = (-m[1] * x + m[0] * y) / det;
}

/* How much of the parallelogram corner + [0,1]² (e, f) faces w, and what area it shows: the integral of max(0, w.z - w.x s.x
 * - w.y s.y) over it. `all`: of everything in it, whichever way it faces, 1 for each unit of area. */
static inline double polygon_area(const double corner[2], const double e[2], const double f[2],
                                  const double w[3], int all) {
    double p[8][3], q[8][3]; /* x, y, and what it shows */
    int n = 0;
    for (int k = 0; k < 4; k++) {
        const double a = k == 1 || k == 2, b = k >= 2;
        q[k][0] = corner[0] + a * e[0] + b * f[0], q[k][1] = corner[1] + a * e[1] + b * f[1];
        q[k][2] = all ? 1 : w[2] - w[0] * q[k][0] - w[1] * q[k][1];
    }
    for (int k = 0; k < 4; k++) {
        const double *a = q[k], *b = q[(k + 1) % 4];
        if (a[2] >= 0) {
            for (int i = 0; i < 3; i++) p[n][i] = a[i];
            n++;
        }
        if ((a[2] < 0) != (b[2] < 0)) {
            const double t = a[2] / (a[2] - b[2]);
            p[n][0] = a[0] + t * (b[0] - a[0]), p[n][1] = a[1] + t * (b[1] - a[1]), p[n][2] = 0;
            n++;
        }
    }
    double sum = 0;
    for (int k = 1; k + 1 < n; k++) {
        const double ux = p[k][0] - p[0][0], uy = p[k][1] - p[0][1], vx = p[k + 1][0] - p[0][0],
                     vy = p[k + 1][1] - p[0][1];
        sum += fabs(ux * vy - uy * vx) / 2 * (p[0][2] + p[k][2] + p[k + 1][2]) / 3;
    }
    return sum;
}

/* The same for the part (i, j) of `parts` x `parts` equal ones of a cell, times the cell's P22 of the transformed surface. */
static inline double tabulated_part(const mu_definition *d, size_t column, size_t row, int parts, int i,
                                    int j, const double w[3], int all) {
    const double *b = d->histogram_bounds;
    const double step[2] = {(b[1] - b[0]) / (double)d->histogram_columns / parts,
                            (b[3] - b[2]) / (double)d->histogram_rows / parts};
    const double s[3][2] = {
        {b[0] + step[0] * ((double)column * parts + i), b[2] + step[1] * ((double)row * parts + j)},
        {s[0][0] + step[0], s[0][1]},
        {s[0][0], s[0][1] + step[1]}};
    double corner[2], e[2], f[2], total = 0;
    tabulated_move(d, s[0], corner), tabulated_move(d, s[1], e), tabulated_move(d, s[2], f);
    for (int k = 0; k < 2; k++) e[k] -= corner[k], f[k] -= corner[k];
    for (size_t k = 0; k < d->histogram_columns * d->histogram_rows; k++) total += d->histogram[k];
    const double mass = d->histogram[row * d->histogram_columns + column] / total / (parts * parts);
    return mass * polygon_area(corner, e, f, w, all) / fabs(e[0] * f[1] - e[1] * f[0]);
}

static inline double tabulated_sigma(const mu_definition *d, const double w[3]) {
    double sum = 0;
    for (size_t j = 0; j < d->histogram_rows; j++)
        for (size_t i = 0; i < d->histogram_columns; i++) sum += tabulated_part(d, i, j, 1, 0, 0, w, 0);
    return sum;
}

/* By the core. */
static inline double tabulated_sigma_d(const tabulated_surfaces *s, const double w[3]) {
    const double up[3] = {0, 0, 1};
    mu_closure_d c;
    assert_true(mu_bind_d(s->d, up, NULL, &c));
    return mu_view_d(&c, w).sigma;
}

static inline double tabulated_density_d(const tabulated_surfaces *s, const double m[3]) {
    const double up[3] = {0, 0, 1};
    mu_closure_d c;
    assert_true(mu_bind_d(s->d, up, NULL, &c));
    return mu_normal_d(&c, m).D;
}

#endif
