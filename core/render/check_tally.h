/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_tally.h: what was tested how often, and the worst case of each law. A tally belongs to one thread;
 * tallies are added in a fixed order, so that the result does not depend on the number of threads.
 */
#ifndef MU_CHECK_TALLY_H
#define MU_CHECK_TALLY_H

#include <stddef.h>
#include <stdio.h>

#include "core/render/check_subject.h"

/* Each law: name, what it says, and whether it is judged by a p-value (P) or by an error within a tolerance
 * (E). */
#define MU_LAWS(X)                                                                                           \
    X(NORMALISATION, "Eq. (3)   integral of D cos = 1", E)                                                   \
    X(MASKING, "Eq. (2)   integral of D G1 (v.m)+ = v.n, or sigma", E)                                       \
    X(PROJECTED_AREA, "sigma     = integral of D (v.m)+", E)                                                 \
    X(VISIBLE_NORMALS, "Dv        integral = 1", E)                                                          \
    X(HIDDEN_NORMALS, "G1, Dv    = 0 behind the view", E)                                                    \
    X(VISIBLE_SAMPLER, "chi^2     visible normals", P)                                                       \
    X(NDF_SAMPLER, "chi^2     D cos", P)                                                                     \
    X(OWN_SAMPLER, "chi^2     directions, where a choice is made", P)                                        \
    X(REFRACTED_SAMPLER, "chi^2     refracted directions", P)                                                \
    X(SHADING_SAMPLER, "chi^2     sampler of the shading calls", P)                                          \
    X(REJECTION, "integral of pdf + P(rejected) = 1", P)                                                     \
    X(ALBEDO, "mean weight = integral of f cos", P)                                                          \
    X(FURNACE, "integral of f cos <= 1", E)                                                                  \
    X(WEIGHT, "weight pdf = f cos", E)                                                                       \
    X(WEIGHT_BOUND, "weight <= 1 (visible normals; eta^2 weight)", E)                                        \
    X(SAMPLE_PDF, "pdf of sample = pdf of eval", E)                                                          \
    X(NORMAL_PDF, "pdf = density of wm, by reflection or refraction", E)                                     \
    X(VISIBLE_DENSITY, "Dv = (wo.wm) D / sigma, G1 = min(1, wo.n / sigma)", E)                               \
    X(BRDF, "f = F D G2 / (4 cos cos)", E)                                                                   \
    X(BTDF, "f = (1-F) D G2 (o.m)(i.m) / (cos cos |H|^2)", E)                                                \
    X(SNELL, "wm refracts wo into wi", E)                                                                    \
    X(SHADOWING_FORM, "G2 by Lambda_o, Lambda_i: its form", E)                                               \
    X(RANGE, "G1, G2 <= 1, G2 <= min G1; finite, >= 0", E)                                                   \
    X(RECIPROCITY, "f(wo,wi) / n_o^2 = f(wi,wo) / n_i^2", E)                                                 \
    X(WALK_ENERGY, "random walk: mean weight = integral of f cos", P)                                        \
    X(WALK_RECIPROCITY, "random walk: f(wo,wi) / n_o^2 = f(wi,wo) / n_i^2, mean", P)                         \
    X(SLOPES_COVARIANT, "Eq. (22)  P22_M(p) = |det M| P22(M^T p - tilt)", E)                                 \
    X(MASKING_INVARIANT, "Eq. (12)  G1_M(v) = G1(M^-1 v)", E)                                                \
    X(SHADOWING_INVARIANT, "G2_M(v,l) = G2(M^-1 v, M^-1 l)", E)                                              \
    X(ROTATION, "M, v, l, m rotated together", E)                                                            \
    X(CLASSIC, "ggx, diagonal M = classic alpha_x, alpha_y", E)                                              \
    X(SHADING_EVAL, "shading calls: f, pdf = probe", E)                                                      \
    X(SHADING_WEIGHT, "shading calls: weight pdf = f", E)                                                    \
    X(SHADING_REVERSE, "shading calls: reverse pdf", E)

typedef enum mu_law {
#define MU_LAW_NAME(name, title, kind) MU_LAW_##name,
    MU_LAWS(MU_LAW_NAME) MU_LAW_COUNT
#undef MU_LAW_NAME
} mu_law;

typedef struct mu_tally_row {
    size_t count;      /* of comparisons made */
    size_t unresolved; /* of comparisons that could not be made to a useful accuracy */
    double worst;      /* largest error in units of its tolerance, or smallest p */
    double error, tolerance;
    char where[1536];         /* the worst case, as a line for `musurf eval` */
    char unresolved_at[1536]; /* the first one that could not be made */
} mu_tally_row;

typedef struct mu_tally {
    mu_tally_row row[MU_LAW_COUNT];
} mu_tally;

typedef struct mu_case {
    const mu_subject *subject;
    const double *wo, *wm, *wi; /* or NULL */
} mu_case;

void mu_tally_init(mu_tally *tally);
void mu_tally_add(mu_tally *sum, const mu_tally *tally);

/* Not a number counts as infinitely wrong. */
void mu_tally_error(mu_tally *tally, mu_law law, double error, double tolerance, mu_case at);
/* a = b, relatively: within `accuracy`, and `slack` (absolute): what rounding may change in b. Two zeros
 * agree. Where the slack exceeds a tenth of b itself, agreement and disagreement mean as little: beyond
 * reach. */
void mu_tally_equal(mu_tally *tally, mu_law law, double a, double b, double accuracy, double slack,
                    mu_case at);
void mu_tally_p(mu_tally *tally, mu_law law, double p, mu_case at);
void mu_tally_unresolved(mu_tally *tally, mu_law law, mu_case at);

_Bool mu_law_is_statistical(mu_law law);
const char *mu_law_title(mu_law law);
const char *mu_law_name(mu_law law); /* for machines: "masking" */
/* Number of p-values. */
size_t mu_tally_tests(const mu_tally *tally);
_Bool mu_tally_passes(const mu_tally *tally, mu_law law, double level);

#endif
