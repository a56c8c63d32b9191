/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* minimise.c: BFGS, Hessians, and inverses by Cholesky factors. */
#include "core/surface/minimise.h"

#include <math.h>
#include <string.h>

enum { STEPS = 200, HALVINGS = 30 };

static double dot(const double *a, const double *b, int n) {
    double sum = 0;
    for (int k = 0; k < n; k++) sum += a[k] * b[k];
    return sum;
}

static void unit(double *h, int n) {
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) h[i * n + j] = i == j;
}

/* h = (1 - s y^T/ys) h (1 - y s^T/ys) + s s^T/ys: equation (6.17) */
static void update(double *h, const double *s, const double *y, int n) {
    double hy[MU_MOST_UNKNOWNS];
    const double ys = dot(y, s, n);
    for (int i = 0; i < n; i++) hy[i] = dot(h + i * n, y, n);
    const double more = (1 + dot(y, hy, n) / ys) / ys;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) h[i * n + j] += more * s[i] * s[j] - (hy[i] * s[j] + s[i] * hy[j]) / ys;
}

double mu_minimise(mu_smooth f, void *context, int n, double *x, double tolerance, _Bool *converged) {
    double h[MU_MOST_UNKNOWNS * MU_MOST_UNKNOWNS], g[MU_MOST_UNKNOWNS];
    double value = f(context, x, g);
    _Bool fresh = 1;
    *converged = 0;
    unit(h, n);
    for (int step = 0; step < STEPS && isfinite(value); step++) {
        double p[MU_MOST_UNKNOWNS], at[MU_MOST_UNKNOWNS], there[MU_MOST_UNKNOWNS], most = 0;
        for (int k = 0; k < n; k++) most = fmax(most, fabs(g[k]));
        if (most < tolerance) return *converged = 1, value;
        for (int k = 0; k < n; k++) p[k] = -dot(h + k * n, g, n);
        const double length = sqrt(dot(p, p, n)), down = dot(p, g, n);
        double scale = length > 0.7 ? 0.7 / length : 1, next = INFINITY;
        int halving = 0;
        for (; halving < HALVINGS; halving++, scale /= 2) {
            for (int k = 0; k < n; k++) at[k] = x[k] + scale * p[k];
            next = f(context, at, there);
            if (next <= value + 1e-4 * scale * down) break;
        }
        if (halving == HALVINGS || !(down < 0)) {
            if (fresh) return value;
            unit(h, n); /* steepest descent, once, before giving up */
            fresh = 1;
            continue;
        }
        double s[MU_MOST_UNKNOWNS], y[MU_MOST_UNKNOWNS];
        for (int k = 0; k < n; k++) s[k] = at[k] - x[k], y[k] = there[k] - g[k];
        const double ys = dot(y, s, n);
        if (ys > 1e-12 * sqrt(dot(y, y, n) * dot(s, s, n))) {
            if (fresh)
                for (int k = 0; k < n * n; k++) h[k] *= ys / dot(y, y, n); /* equation (6.20) */
            update(h, s, y, n);
            fresh = 0;
        }
        memcpy(x, at, (size_t)n * sizeof *x);
        memcpy(g, there, (size_t)n * sizeof *g);
        value = next;
    }
    return value;
}

void mu_hessian(mu_smooth f, void *context, int n, const double *x, double step, double *out) {
    double rows[MU_MOST_UNKNOWNS * MU_MOST_UNKNOWNS];
    for (int i = 0; i < n; i++) {
        double at[MU_MOST_UNKNOWNS], less[MU_MOST_UNKNOWNS], more[MU_MOST_UNKNOWNS];
        memcpy(at, x, (size_t)n * sizeof *at);
        at[i] = x[i] - step;
        f(context, at, less);
        at[i] = x[i] + step;
        f(context, at, more);
        for (int j = 0; j < n; j++) rows[i * n + j] = (more[j] - less[j]) / (2 * step);
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) out[i * n + j] = (rows[i * n + j] + rows[j * n + i]) / 2;
}

_Bool mu_invert(const double *a, int n, double *out) {
    double l[MU_MOST_UNKNOWNS * MU_MOST_UNKNOWNS] = {0}, inverse[MU_MOST_UNKNOWNS * MU_MOST_UNKNOWNS] = {0};
    for (int i = 0; i < n; i++)
        for (int j = 0; j <= i; j++) {
            const double rest = a[i * n + j] - dot(l + i * n, l + j * n, j);
            if (i == j && !(rest > 1e-13 * fabs(a[i * n + i]))) return 0;
            l[i * n + j] = i == j ? sqrt(rest) : rest / l[j * n + j];
        }
    for (int j = 0; j < n; j++)
        for (int i = j; i < n; i++) {
            double rest = i == j;
            for (int k = j; k < i; k++) rest -= l[i * n + k] * inverse[k * n + j];
            inverse[i * n + j] = rest / l[i * n + i];
        }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            out[i * n + j] = 0;
            for (int k = i > j ? i : j; k < n; k++) out[i * n + j] += inverse[k * n + i] * inverse[k * n + j];
        }
    return 1;
}
