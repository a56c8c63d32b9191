/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* likelihood.c: the censored likelihood and its gradient: by the chain rule in B and t, by central differences in the
 * numbers of the distribution, whose error is of order 1e-6. */
#include "core/surface/likelihood.h"

#include <stdlib.h>
#include <string.h>

enum { ANGLES = 48 };
static const double nudge = 1e-3; /* of z; numbers go as its exponential at most: relative error 1e-6/6 */

static _Bool make_tables(mu_likelihood *l, const double *parameters) {
    const mu_candidate *c = l->candidate;
    for (int t = 0; t < 1 + 2 * c->shapes; t++) {
        double near[MU_MOST_PARAMETERS];
        memcpy(near, parameters, sizeof near);
        if (t) near[MU_AT_REST + c->scale + (t - 1) / 2] += t & 1 ? -nudge : nudge;
        const mu_definition d = mu_candidate_definition(c, near);
        const size_t bytes = mu_radial_bytes(&d);
        if (bytes > l->bytes) {
            free(l->memory);
            l->memory = aligned_alloc(16, (bytes + 15) / 16 * 16);
            l->bytes = l->memory ? bytes : 0;
        }
        if (!mu_radial_make(&l->tables[t], &d, l->memory)) return 0;
    }
    return 1;
}

/* ln of the share beyond the edge, by one table. */
static double ln_beyond(const mu_likelihood *l, const mu_radial *table, const double *parameters) {
    double b[4], sum = 0;
    mu_candidate_matrix(l->candidate, l->cloud, parameters, b);
    const double *t = parameters + MU_AT_X, edge2 = l->cloud->edge * l->cloud->edge;
    const double room = edge2 - (t[0] * t[0] + t[1] * t[1]);
    if (!(room > 0)) return -INFINITY;
    for (int k = 0; k < ANGLES; k++) {
        const double angle = 6.28318530717958647693 * k / ANGLES;
        const double y = sin(angle) / b[3], x = (cos(angle) - b[1] * y) / b[0]; /* B^-1 e */
        const double square = x * x + y * y, along = t[0] * x + t[1] * y;
        const double r = room / (along + sqrt(along * along + square * room)); /* |t + r B^-1 e| = edge */
        sum += mu_radial_above(table, log(r));
    }
    return log(sum / ANGLES);
}

static double tail(const mu_likelihood *l, const double *parameters, double *gradient) {
    const mu_candidate *c = l->candidate;
    const int geometry = MU_AT_REST + c->scale;
    for (int p = 0; p < geometry; p++) {
        double near[MU_MOST_PARAMETERS];
        memcpy(near, parameters, sizeof near);
        near[p] = parameters[p] - 1e-4;
        const double less = ln_beyond(l, l->tables, near);
        near[p] = parameters[p] + 1e-4;
        gradient[p] = -(ln_beyond(l, l->tables, near) - less) / 2e-4;
    }
    for (int s = 0; s < c->shapes; s++)
        gradient[geometry + s] = -(ln_beyond(l, &l->tables[2 + 2 * s], parameters) -
                                   ln_beyond(l, &l->tables[1 + 2 * s], parameters)) /
                                 (2 * nudge);
    return -ln_beyond(l, l->tables, parameters);
}

/* - ln P22 and its gradient at one point of the cloud; without ln det. */
static double at_point(const mu_likelihood *l, const double b[4], const double *parameters, const double v[2],
                       double *gradient) {
    const mu_candidate *c = l->candidate;
    const double x = v[0] - parameters[MU_AT_X], y = v[1] - parameters[MU_AT_Y];
    const double stretched = b[0] * x, u = stretched + b[1] * y, w = b[3] * y;
    const double r2 = fmax(u * u + w * w, 1e-40);
    const mu_radial_place place = mu_radial_find(log(r2) / 2);
    const double slope = -mu_radial_slope(l->tables, &place), by = slope / r2;
    gradient[MU_AT_D] = by * (u * stretched - w * w);
    gradient[MU_AT_C] = by * u * y * sqrt(b[0] * b[3]); /* e^k */
    gradient[MU_AT_X] = -by * u * b[0];
    gradient[MU_AT_Y] = -by * (u * b[1] + w * b[3]);
    if (c->scale) gradient[MU_AT_REST] = slope;
    for (int s = 0; s < c->shapes; s++)
        gradient[MU_AT_REST + c->scale + s] = -(mu_radial_value(&l->tables[2 + 2 * s], &place) -
                                                mu_radial_value(&l->tables[1 + 2 * s], &place)) /
                                              (2 * nudge);
    return -mu_radial_value(l->tables, &place);
}

/* Means per facet of each bin. */
static void keep(mu_likelihood *l, uint32_t bin, double weight, const double *gradient, double *sum) {
    for (int p = 0; p < MU_MOST_PARAMETERS; p++) l->scores[bin][p] += weight * gradient[p];
    sum[bin] += weight;
}

double mu_likelihood_at(mu_likelihood *l, const mu_point_set *set, const double *parameters,
                        double *gradient) {
    const mu_candidate *c = l->candidate;
    const double *m = l->cloud->shape;
    double b[4], value = 0, one[MU_MOST_PARAMETERS] = {0};
    for (int p = 0; p < MU_MOST_PARAMETERS; p++) gradient[p] = 0;
    const double k = mu_candidate_matrix(c, l->cloud, parameters, b);
    double *sums = l->scores ? calloc(MU_BINS + 1, sizeof *sums) : NULL;
    if (!isfinite(k) || !make_tables(l, parameters) || (l->scores && !sums)) {
        free(sums);
        return INFINITY;
    }
    const double constant = log(m[0] * m[3] - m[1] * m[2]) - 2 * k;
    if (sums) memset(l->scores, 0, (MU_BINS + 1) * sizeof *l->scores);
    for (size_t n = 0; n < set->count; n++) {
        const mu_point *point = &set->points[n];
        const double here = at_point(l, b, parameters, point->v, one) + constant;
        if (c->scale) one[MU_AT_REST] -= 2;
        value += point->weight * here;
        for (int p = 0; p < MU_MOST_PARAMETERS; p++) gradient[p] += point->weight * one[p];
        if (sums) keep(l, point->bin, point->weight, one, sums);
    }
    const double beyond = tail(l, parameters, one);
    if (set->tail > 0) {
        value += set->tail * beyond;
        for (int p = 0; p < MU_MOST_PARAMETERS; p++) gradient[p] += set->tail * one[p];
    }
    if (sums) {
        keep(l, MU_TAIL, 1, one, sums);
        for (uint32_t bin = 0; bin <= MU_TAIL; bin++)
            for (int p = 0; p < MU_MOST_PARAMETERS && sums[bin] > 0; p++) l->scores[bin][p] /= sums[bin];
        free(sums);
    }
    for (int p = 0; p < MU_MOST_PARAMETERS; p++) gradient[p] /= set->facets;
    return value / set->facets;
}
