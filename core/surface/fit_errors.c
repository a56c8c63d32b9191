/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* fit_errors.c: standard errors by the sandwich over blocks, and tests of isotropy and of a level surface. */
#include <math.h>
#include <string.h>

#include "core/surface/fit.h"
#include "core/surface/minimise.h"

enum { TOLD = sizeof(mu_told) / sizeof(double), P = MU_MOST_PARAMETERS };
_Static_assert((int)MU_MOST_PARAMETERS <= (int)MU_MOST_UNKNOWNS,
               "minimise.h holds fewer unknowns than a candidate has");

typedef struct mu_asked {
    mu_likelihood *l;
    const mu_point_set *set;
} mu_asked;

static double ask(void *context, const double *x, double *gradient) {
    const mu_asked *a = context;
    double all[P] = {0}, g[P];
    memcpy(all, x, (size_t)mu_candidate_parameters(a->l->candidate) * sizeof *all);
    const double value = mu_likelihood_at(a->l, a->set, all, g);
    memcpy(gradient, g, (size_t)mu_candidate_parameters(a->l->candidate) * sizeof *g);
    return value;
}

/* J: the scatter of the scores of blocks, per facet. */
static void scatter(const mu_likelihood *l, uint32_t blocks, int n, double *out) {
    const mu_cloud *cloud = l->cloud;
    const uint32_t wide = MU_PATCHES / blocks;
    double sum[(MU_PATCHES * MU_PATCHES)][P];
    memset(sum, 0, sizeof sum);
    for (uint32_t patch = 0; patch < MU_PATCHES * MU_PATCHES; patch++) {
        double *block = sum[patch / MU_PATCHES / wide * blocks + patch % MU_PATCHES / wide];
        const uint32_t *counts = cloud->counts + (size_t)patch * (MU_BINS + 1);
        for (uint32_t bin = 0; bin <= MU_TAIL; bin++)
            if (counts[bin])
                for (int p = 0; p < n; p++) block[p] += counts[bin] * l->scores[bin][p];
    }
    const double m = (double)blocks * blocks, scale = m / (m - 1) / cloud->sets[MU_FOLDS].facets;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            out[i * n + j] = 0;
            for (uint32_t b = 0; b < blocks * blocks; b++) out[i * n + j] += scale * sum[b][i] * sum[b][j];
        }
}

static void times(const double *a, const double *b, int n, double *out) {
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            out[i * n + j] = 0;
            for (int k = 0; k < n; k++) out[i * n + j] += a[i * n + k] * b[k * n + j];
        }
}

/* Derivatives of what is told. */
static void derive(const mu_fitted *f, const mu_cloud *cloud, int n, double out[TOLD][P]) {
    const double step = 1e-5, pi = 3.14159265358979323846;
    for (int p = 0; p < n; p++) {
        double near[P];
        mu_told less, more;
        memcpy(near, f->parameters, sizeof near);
        near[p] = f->parameters[p] - step;
        mu_candidate_tell(f->candidate, cloud, near, &less);
        near[p] = f->parameters[p] + step;
        mu_candidate_tell(f->candidate, cloud, near, &more);
        more.rotation -= pi * nearbyint((more.rotation - less.rotation) / pi);
        double a[TOLD], b[TOLD];
        memcpy(a, &less, sizeof a);
        memcpy(b, &more, sizeof b);
        for (int k = 0; k < TOLD; k++) out[k][p] = (b[k] - a[k]) / (2 * step);
    }
}

static double between(const double *a, const double *b, const double *covariance, int n) {
    double sum = 0;
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) sum += a[i] * covariance[i * n + j] * b[j];
    return sum;
}

/* Two numbers that are 0 by chance: chi^2 of two degrees of freedom, whose tail is exp(-x/2). */
static double chance(double x, double y, const double *gx, const double *gy, const double *covariance,
                     int n) {
    const double xx = between(gx, gx, covariance, n), xy = between(gx, gy, covariance, n),
                 yy = between(gy, gy, covariance, n), det = xx * yy - xy * xy;
    return det > 0 ? exp(-(yy * x * x - 2 * xy * x * y + xx * y * y) / det / 2) : NAN;
}

_Bool mu_fit_errors(mu_fitted *f, mu_likelihood *l, uint32_t blocks) {
    const mu_candidate *c = f->candidate;
    /* At the end of its range a number has no error, and its own limit is what is fitted. */
    const int all = mu_candidate_parameters(c), n = f->at_end ? all - c->shapes : all;
    const mu_cloud *cloud = l->cloud;
    double curvature[P * P], h[P * P], inverse[P * P], j[P * P], hj[P * P], covariance[P * P], told[TOLD],
        g[P];
    double derivatives[TOLD][P] = {{0}};
    mu_told nothing;
    for (int k = 0; k < TOLD; k++) told[k] = NAN;
    memcpy(&nothing, told, sizeof nothing);
    f->error = nothing;
    f->isotropic = f->level = f->alike = NAN;
    mu_asked asked = {l, &cloud->sets[MU_FOLDS]};
    mu_likelihood_at(l, asked.set, f->parameters, g);
    scatter(l, blocks, n, j);
    double(*const scores)[P] = l->scores;
    l->scores = NULL;
    mu_hessian(ask, &asked, all, f->parameters, 1e-3, curvature);
    l->scores = scores;
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++) h[i * n + k] = curvature[i * all + k];
    if (!mu_invert(h, n, inverse)) return 0;
    times(inverse, j, n, hj);
    times(hj, inverse, n, covariance);
    f->alike = 0;
    for (int k = 0; k < n; k++) f->alike += hj[k * n + k] / n;
    for (int k = 0; k < n * n; k++) covariance[k] /= cloud->sets[MU_FOLDS].facets;
    derive(f, cloud, n, derivatives);
    for (int k = 0; k < TOLD; k++) told[k] = sqrt(between(derivatives[k], derivatives[k], covariance, n));
    memcpy(&f->error, told, sizeof f->error);
    if (f->error.rotation > 0.78) f->error.rotation = NAN; /* any direction */
    if (f->at_end) f->error.gamma = f->error.exponent = NAN;
    if (f->at_end && (c->ndf == MU_GTR || c->ndf == MU_SHEEN)) f->error.alpha = NAN;
    const size_t xx = offsetof(mu_told, transform) / sizeof(double),
                 mean = offsetof(mu_told, mean) / sizeof(double);
    double unlike[P];
    for (int k = 0; k < P; k++) unlike[k] = derivatives[xx][k] - derivatives[xx + 2][k];
    f->isotropic = chance(f->told.transform[0] - f->told.transform[2], f->told.transform[1], unlike,
                          derivatives[xx + 1], covariance, n);
    f->level =
        chance(f->told.mean[0], f->told.mean[1], derivatives[mean], derivatives[mean + 1], covariance, n);
    return 1;
}
