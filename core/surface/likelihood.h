/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * likelihood.h: how likely a cloud of slopes is under a candidate, and how that changes with its parameters.
 *
 * Per facet, - ln of P22(u) det B det(shape)^-1 within the cloud's edge, and of the share of facets beyond it for those
 * beyond: the censored likelihood of facets as if they were independent. Its maximum is consistent though they are not
 * (only its curvature does not tell the error; errors.h does), and needs no moments, which heavy tails lack.
 *
 * The share beyond is the mean over directions of u of the share steeper than where that direction leaves the ellipse:
 * exact for any B, a periodic integral, by 48 points.
 */
#ifndef MU_LIKELIHOOD_H
#define MU_LIKELIHOOD_H

#include "core/surface/candidate.h"
#include "core/surface/radial.h"

/* Of one candidate; some 60 KB, and memory for the distributions asked. */
typedef struct mu_likelihood {
    const mu_candidate *candidate;
    const mu_cloud *cloud;
    mu_radial tables[5]; /* here; then for each number of the distribution a little less, a little more */
    void *memory;
    size_t bytes;
    double (*scores)[MU_MOST_PARAMETERS]; /* NULL, or room for [bins and tail]: mean gradient per facet */
} mu_likelihood;

/* The mean over the set's facets of - ln likelihood, and its gradient; INFINITY where the distribution is refused. */
double mu_likelihood_at(mu_likelihood *l, const mu_point_set *set, const double *parameters,
                        double *gradient);

#endif
