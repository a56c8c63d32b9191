/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * candidate.h: what a fit may answer: distributions, and how numbers without bounds make their parameters.
 *
 * A slope of the surface is s = mean + S u, u drawn from the isotropic distribution, S symmetric, positive definite:
 * that is the distribution under M = S^-1 with a tilt M mean (Eq. (9): slopes go with M^-T). An orthogonal factor on
 * the right of M moves no isotropic surface, so a symmetric M is all that a surface can tell. Where the family of
 * distributions is closed under scaling (ggx, beckmann, std), only alpha S is known: det M = 1 by convention, and the
 * singular values of alpha S are alpha_x and alpha_y. gtr, phong and sheen have scales of their own, slope 1; they are
 * fitted with det M = 1, and gtr again with det M free.
 *
 * In the cloud's frame, s = centre + shape v, u = B (v - t) with B = e^k [e^d c; 0 e^-d]; any B with this B^T B would
 * do. Parameters are d, c, t_x, t_y, then k if the scale is free, then up to two of the distribution, each
 * low + (high - low) / (1 + e^-z) with z what is searched.
 */
#ifndef MU_CANDIDATE_H
#define MU_CANDIDATE_H

#include "core/bsdf/musurf.h"
#include "core/surface/cloud.h"

enum { MU_MOST_PARAMETERS = 7, MU_MOST_STARTS = 3, MU_CANDIDATES = 7 };
enum { MU_AT_D, MU_AT_C, MU_AT_X, MU_AT_Y, MU_AT_REST };

typedef struct mu_candidate {
    const char *name; /* unique */
    mu_ndf ndf;
    _Bool scale; /* det M, or alpha, is free */
    int shapes;
    double low[2], high[2]; /* of the numbers that mu_candidate_definition takes */
} mu_candidate;

const mu_candidate *mu_candidate_get(int index);
static inline int mu_candidate_parameters(const mu_candidate *c) {
    return MU_AT_REST + c->scale + c->shapes;
}
/* Start number `start`, 0 to MU_MOST_STARTS - 1, for a cloud whose pilot has slope roughness `alpha`; false past the
 * last. */
_Bool mu_candidate_start(const mu_candidate *c, int start, double alpha, double *parameters);
/* ndf, alpha, gamma and exponent; not M. */
mu_definition mu_candidate_definition(const mu_candidate *c, const double *parameters);
/* One of them stands at the end of its range: the family's limit fits better than the family. */
_Bool mu_candidate_at_end(const mu_candidate *c, const double *parameters);
/* B, two rows; returns k. */
double mu_candidate_matrix(const mu_candidate *c, const mu_cloud *cloud, const double *parameters,
                           double b[4]);

/* What a scene file would say. */
typedef struct mu_told {
    double alpha, gamma,
        exponent; /* of the distribution; alpha of ggx, beckmann, std: sqrt(alpha_x alpha_y) */
    double alpha_x, alpha_y, rotation; /* singular values of alpha S, the larger first, and its direction */
    double mean[2];                    /* slope */
    double tilt[2];                    /* M mean */
    double transform[3];               /* M: xx, xy, yy */
} mu_told;
void mu_candidate_tell(const mu_candidate *c, const mu_cloud *cloud, const double *parameters, mu_told *out);

#endif
