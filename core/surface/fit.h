/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * fit.h: the distribution and the map M that explain the facets of a heightfield best, how sure that is, and how well
 * it explains them; or why nothing does.
 *
 * Every candidate (candidate.h) is fitted by maximum censored likelihood (likelihood.h) to all facets and to each of two
 * folds. Neighbouring facets are alike, so errors are those of a misspecified independence likelihood: the sandwich
 * H^-1 J H^-1 / N, with H the curvature and J the scatter of the scores summed over square blocks of many correlation
 * lengths (White 1982; Varin, Reid & Firth 2011, "An overview of composite likelihood methods"). tr(H^-1 J)/p is how
 * many facets count as one; candidates are compared by the Bayesian criterion of the likelihood divided by that, and by
 * the likelihood of the fold not used. What a candidate leaves unexplained is measured on the fold not used, in shares
 * of bins of equal mass, and set against the scatter of these shares over the blocks. A candidate explains the surface
 * if the total variation over none of three partitions exceeds the tolerance by more than twice what scatter alone does.
 */
#ifndef MU_FIT_H
#define MU_FIT_H

#include "core/surface/likelihood.h"

enum { MU_SHARES = 20, MU_JOINT_RINGS = 5, MU_JOINT_SECTORS = 8, MU_HARMONICS = 6 };
enum { MU_JOINT = MU_JOINT_RINGS * MU_JOINT_SECTORS, MU_REASON = 320 };

/* Shares of `bins` bins, each 1/bins under the fit. */
typedef struct mu_partition {
    uint32_t bins;
    double share[MU_JOINT], error[MU_JOINT];
    double rms;       /* relative, of the shares from 1/bins */
    double variation; /* total variation: half the sum of |share - 1/bins| */
    double noise;     /* of it, what scatter alone makes: half the sum of sqrt(2/pi) error */
} mu_partition;

typedef struct mu_residual {
    mu_partition steepness, azimuth, joint; /* azimuth from the axis of alpha_x, in the frame of u */
    double kolmogorov; /* largest difference of the shares below a steepness, at 1000 places */
    double facets;
} mu_residual;

typedef struct mu_fitted {
    const mu_candidate *candidate;
    double parameters[MU_MOST_PARAMETERS];
    mu_told told, error;     /* error: standard errors; NaN where there is none */
    double isotropic, level; /* probability of as large an anisotropy, mean slope, by chance (Wald) */
    double likelihood;       /* ln, sum over facets */
    double held_out;         /* ln, mean per facet of the fold not used */
    double alike;            /* facets that count as one */
    double criterion;        /* Bayesian, smaller is better */
    mu_residual residual;
    _Bool converged, at_end, explains;
} mu_fitted;

typedef enum mu_verdict { MU_FIT_EXPLAINED, MU_FIT_FLAT, MU_FIT_REFUSED, MU_FIT_NO_MEMORY } mu_verdict;

typedef struct mu_fit {
    /* in */
    double keep;      /* share of facets within the edge; beyond, they are only counted */
    double tolerance; /* of total variation */
    /* out */
    mu_verdict verdict;
    char reason[MU_REASON]; /* of a refusal */
    double facets, effective,
        correlation; /* effective: independent ones; correlation length in cells; NaN: unknown */
    double step;     /* of the heights; 0 if they have none */
    uint32_t blocks; /* a side */
    int count;       /* of candidates, best first */
    mu_fitted fitted[MU_CANDIDATES];
} mu_fit;

void mu_fit_slopes(mu_fit *fit, const mu_slopes *s);

/* Parts of it. */
/* Why no fit is to be tried, from a sample of heights and slopes: false, and verdict and reason are set. */
_Bool mu_fit_examine(mu_fit *fit, const mu_slopes *s, const double *sample, uint32_t count);
/* Errors, `alike`, the tests, from scores left by a call at the parameters. */
_Bool mu_fit_errors(mu_fitted *fitted, mu_likelihood *l, uint32_t blocks);
/* Facets of either fold against the parameters fitted to the other. */
_Bool mu_fit_residual(mu_fitted *fitted, const double (*halves)[MU_MOST_PARAMETERS], const mu_cloud *cloud,
                      const mu_slopes *s, uint32_t blocks, mu_likelihood *l);
/* What the residual of the best candidate shows. */
void mu_fit_blame(const mu_fitted *fitted, double tolerance, char reason[MU_REASON]);

#endif
