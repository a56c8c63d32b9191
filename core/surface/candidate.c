/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* candidate.c: the candidates, their ranges and starts, and what their parameters mean. */
#include "core/surface/candidate.h"

#include <math.h>

/* Ranges: std gamma - 3/2 = e^w, from 0.018 to 400, where it is Beckmann to 1/800; gtr alpha = exp(-e^w), 0.999 to 1e-6,
 * gamma = e^w, 0.007 to 55; phong exponent e^w, 0.01 to 1.6e5; sheen r = e^w, 0.007 to 30. */
static const mu_candidate candidates[MU_CANDIDATES] = {
    {"ggx", MU_GGX, 1, 0, {0}, {0}},
    {"beckmann", MU_BECKMANN, 1, 0, {0}, {0}},
    {"gtr", MU_GTR, 0, 2, {-6.9, -5}, {2.6, 4}},
    {"std", MU_STD, 1, 1, {-4}, {6}},
    {"phong", MU_PHONG, 0, 1, {-4.6}, {12}},
    {"sheen", MU_SHEEN, 0, 1, {-5}, {3.4}},
    {"gtr scaled", MU_GTR, 1, 2, {-6.9, -5}, {2.6, 4}},
};

const mu_candidate *mu_candidate_get(int index) {
    return index >= 0 && index < MU_CANDIDATES ? &candidates[index] : NULL;
}

static double number(const mu_candidate *c, const double *parameters, int shape) {
    const double z = parameters[MU_AT_REST + c->scale + shape];
    return c->low[shape] + (c->high[shape] - c->low[shape]) / (1 + exp(-z));
}

/* z of a number; kept off the ends, where nothing moves. */
static double search(const mu_candidate *c, int shape, double w) {
    const double part = (w - c->low[shape]) / (c->high[shape] - c->low[shape]),
                 in = fmin(fmax(part, 0.02), 0.98);
    return log(in / (1 - in));
}

_Bool mu_candidate_start(const mu_candidate *c, int start, double alpha, double *parameters) {
    static const double gammas[MU_MOST_STARTS] = {1.5, 0.6, 4};
    const int last = c->ndf == MU_GTR ? MU_MOST_STARTS : c->ndf == MU_SHEEN ? 2 : 1;
    double *shape = parameters + MU_AT_REST + c->scale;
    if (start >= last) return 0;
    for (int k = 0; k < MU_MOST_PARAMETERS; k++) parameters[k] = 0;
    switch (c->ndf) {
    case MU_GTR: {
        const double law = fmin(alpha, 0.9);
        shape[0] = search(c, 0, log(-log(law)));
        shape[1] = search(c, 1, log(gammas[start]));
        if (c->scale) parameters[MU_AT_REST] = log(law); /* u of the size of alpha */
        break;
    }
    case MU_STD:
        shape[0] = search(c, 0, log(1.5));
        break;
    case MU_PHONG: /* a small slope's density goes as exp(-(n + 4)/2 r^2) */
        shape[0] = search(c, 0, log(fmax(2 / (alpha * alpha) - 4, 0.5)));
        break;
    case MU_SHEEN:
        shape[0] = search(c, 0, log(start ? 0.2 : 1));
        break;
    default:
        break;
    }
    return 1;
}

mu_definition mu_candidate_definition(const mu_candidate *c, const double *parameters) {
    mu_definition d = mu_definition_default();
    d.ndf = c->ndf;
    d.alpha = 1;
    if (c->ndf == MU_GTR) {
        d.alpha = exp(-exp(number(c, parameters, 0)));
        d.gamma = exp(number(c, parameters, 1));
    } else if (c->ndf == MU_STD) {
        d.gamma = 1.5 + exp(number(c, parameters, 0));
    } else if (c->ndf == MU_PHONG) {
        d.exponent = exp(number(c, parameters, 0));
    } else if (c->ndf == MU_SHEEN) {
        d.alpha = exp(number(c, parameters, 0));
    }
    return d;
}

_Bool mu_candidate_at_end(const mu_candidate *c, const double *parameters) {
    for (int k = 0; k < c->shapes; k++) {
        const double part = 1 / (1 + exp(-parameters[MU_AT_REST + c->scale + k]));
        if (part < 0.01 || part > 0.99) return 1;
    }
    return 0;
}

double mu_candidate_matrix(const mu_candidate *c, const mu_cloud *cloud, const double *parameters,
                           double b[4]) {
    const double *m = cloud->shape;
    const double k = c->scale ? parameters[MU_AT_REST] : log(m[0] * m[3] - m[1] * m[2]) / 2; /* det S = 1 */
    const double d = parameters[MU_AT_D];
    b[0] = exp(k + d), b[1] = parameters[MU_AT_C] * exp(k), b[2] = 0, b[3] = exp(k - d);
    return k;
}

/* The symmetric root of G G^T, by Cayley and Hamilton. */
static void polar(const double g[4], double out[3]) {
    const double xx = g[0] * g[0] + g[1] * g[1], xy = g[0] * g[2] + g[1] * g[3],
                 yy = g[2] * g[2] + g[3] * g[3];
    const double r = fabs(g[0] * g[3] - g[1] * g[2]), by = sqrt(xx + yy + 2 * r);
    out[0] = (xx + r) / by, out[1] = xy / by, out[2] = (yy + r) / by;
}

void mu_candidate_tell(const mu_candidate *c, const mu_cloud *cloud, const double *parameters, mu_told *out) {
    const double *a = cloud->shape, *t = parameters + MU_AT_X;
    const mu_definition d = mu_candidate_definition(c, parameters);
    double b[4];
    mu_candidate_matrix(c, cloud, parameters, b);
    /* s - mean = shape B^-1 u */
    const double det = b[0] * b[3], i[3] = {b[3] / det, -b[1] / det, b[0] / det};
    const double g[4] = {a[0] * i[0], a[0] * i[1] + a[1] * i[2], a[2] * i[0], a[2] * i[1] + a[3] * i[2]};
    double S[3];
    polar(g, S);
    const _Bool closed = c->ndf == MU_GGX || c->ndf == MU_BECKMANN || c->ndf == MU_STD;
    const double unit = closed ? sqrt(S[0] * S[2] - S[1] * S[1]) : 1; /* u's own scale becomes alpha */
    for (int k = 0; k < 3; k++) S[k] /= unit;
    out->alpha = d.alpha * unit, out->gamma = d.gamma, out->exponent = d.exponent;
    for (int k = 0; k < 2; k++) out->mean[k] = cloud->centre[k] + a[2 * k] * t[0] + a[2 * k + 1] * t[1];
    const double size = S[0] * S[2] - S[1] * S[1];
    out->transform[0] = S[2] / size, out->transform[1] = -S[1] / size, out->transform[2] = S[0] / size;
    const double *M = out->transform, full[4] = {M[0], M[1], M[1], M[2]};
    out->tilt[0] = M[0] * out->mean[0] + M[1] * out->mean[1];
    out->tilt[1] = M[1] * out->mean[0] + M[2] * out->mean[1];
    mu_anisotropy axes;
    if (!mu_transform_anisotropy(full, out->alpha, &axes)) axes = (mu_anisotropy){NAN, NAN, NAN};
    out->alpha_x = axes.alpha_x, out->alpha_y = axes.alpha_y, out->rotation = axes.rotation;
}
