/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_quadrature.h: adaptive integration over a rectangle, several integrands at once, with an error
 * estimate.
 *
 * A panel is integrated by the tensor product of a Kronrod rule with itself; replacing it in one direction by
 * the Gauss rule inside it gives that direction's error. The panel with the worst error is halved worse
 * direction until the sum of all errors is small enough. Where the integrand is smooth that difference
 * overstates the error of the Kronrod value by far; next to a singular end it is about as large as the error,
 * so four times the difference counts.
 */
#ifndef MU_CHECK_QUADRATURE_H
#define MU_CHECK_QUADRATURE_H

#include <stddef.h>

#define MU_PARTS 4 /* integrands at most */

/* Integrand values at x, y. Must be finite. */
typedef void (*mu_integrand)(void *context, double x, double y, double value[MU_PARTS]);

typedef enum mu_rule { MU_KRONROD_7, MU_KRONROD_15 } mu_rule;

typedef struct mu_quadrature {
    mu_integrand integrand;
    void *context;
    size_t parts;
    double target[MU_PARTS]; /* absolute error wanted of each part; 0: this part does not steer */
    size_t panel_limit;
    mu_rule rule;
} mu_quadrature;

typedef struct mu_integral {
    double value[MU_PARTS], error[MU_PARTS];
    size_t panels;
    _Bool resolved; /* every target was met within the limit, and memory sufficed */
} mu_integral;

/* Over [x0, x1] x [y0, y1], starting from columns x rows equal panels. */
mu_integral mu_integrate(const mu_quadrature *quadrature, const double x[2], size_t columns,
                         const double y[2], size_t rows);

#endif
