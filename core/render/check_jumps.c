/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_jumps.c: see check_jumps.h. */
#include "core/render/check_jumps.h"

#include <math.h>

enum { POINTS = 2584, STEP = 1597 }; /* of each lattice: neighbours in Fibonacci's sequence */

static void lattice(mu_integrand integrand, void *context, const double x[2], const double y[2],
                    double *value, double *error) {
    double sum[2] = {0, 0}, low = INFINITY, high = 0;
    for (int i = 0; i < 2 * POINTS; i++) {
        const double u = (i / 2 + (i % 2 ? .75 : .25)) / POINTS,
                     v = fmod((double)(i / 2) * STEP / POINTS + (i % 2 ? .75 : .25), 1);
        double f[MU_PARTS] = {0};
        integrand(context, x[0] + (x[1] - x[0]) * u, y[0] + (y[1] - y[0]) * v, f);
        sum[i % 2] += f[0];
        low = fmin(low, f[0]), high = fmax(high, f[0]);
    }
    const double area = (x[1] - x[0]) * (y[1] - y[0]), n = POINTS;
    *value += (sum[0] + sum[1]) / (2 * n) * area;
    *error += area * fmax((high - low) * pow(2 * n, -.75), fabs(sum[0] - sum[1]) / (2 * n));
}

void mu_integrate_jumps(mu_integrand integrand, void *context, const double x[2], const double y[2],
                        double fine, double *value, double *error) {
    const double middle = (x[0] + x[1]) / 2;
    *value = *error = 0;
    if (x[1] - x[0] <= 2 * fine) {
        lattice(integrand, context, x, y, value, error);
        return;
    }
    double from = 0;
    for (double to = fine; from < middle - x[0]; from = to, to *= 2) {
        if (to > middle - x[0]) to = middle - x[0];
        lattice(integrand, context, (const double[2]){x[0] + from, x[0] + to}, y, value, error);
        lattice(integrand, context, (const double[2]){x[1] - to, x[1] - from}, y, value, error);
    }
}
