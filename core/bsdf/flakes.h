/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * flakes.h: finitely many mirror-like flakes in a footprint, the count behind the discrete distributions (Jakob et al.
 * 2014, "Discrete stochastic microfacet models"; Atanasov and Koylazov 2016, "A practical stochastic algorithm for
 * rendering mirror-like flakes").
 *
 * Flakes are points (u, v, p, q): a position in the plane, `density` of them per unit area, and a normal with p =
 * P(slope² <= X), the distribution's radial CDF, and q = azimuth / 2 pi. In p and q every distribution is uniform on
 * [0,1)², so a footprint of area A and a box of normals of size V hold N A V flakes in the mean, and
 *     D_discrete(m) = D(m) K / E[K],
 * with K the flakes in footprint and box around m, has the mean D exactly.
 *
 * Doubles whatever `real` is, so that float and double see the same flakes. No state: the flakes are a hash of the seed.
 */
#ifndef MU_FLAKES_H
#define MU_FLAKES_H

#include <stdint.h>

typedef struct mu_flakes {
    double density; /* N, per unit area of (u, v) */
    double side;    /* of the (u, v) cells, each of which has rings² flakes: one of each kind of normal */
    double rings;   /* of the disk of normals, a power of two */
    uint64_t seed;
} mu_flakes;

/* A box of normals: p[0] <= p < p[1], and q within q_width above q, modulo 1. */
typedef struct mu_flake_normals {
    double p[2], q, q_width;
} mu_flake_normals;

/* What was counted. thinning 0: all flakes, and counts of disjoint regions add up exactly. thinning t: an independent
 * set of 4^-t times as many stands for them, and `expected` is of that set. */
typedef struct mu_flake_tally {
    double count, expected;
    int thinning;
} mu_flake_tally;

/* `cone` is the half-angle tau of the cones that will be asked for, in the space of the distribution (below). It only
 * shapes the cells: other cones are right too, at another cost. Not a positive finite density: no discreteness. */
mu_flakes mu_flakes_make(double density, double cone, uint64_t seed);

/* P(slope² <= X) of the distributions with slopes in units of alpha. */
typedef double mu_flake_cdf(double slope2);
double mu_flake_cdf_ggx(double slope2);
double mu_flake_cdf_beckmann(double slope2);

/* The box for the cone of half-angle tau around m, both in the distribution's own space (m = M^T wm, any length).
 *
 * It is the sector of polar angles theta +- tau, theta that of m, cut off at 0 and pi/2, whose azimuths, centred at m's,
 * are as many as make its solid angle the cone's, 2 pi (1 - cos tau), or all. So it is exact for every tau while theta +
 * tau <= pi/2, turns continuously into the cap around the pole, and contains m; p[1] - p[0] is 2^-40 at least.
 *
 * A cone of half-angle t about wm, after M, has about the same share of the flakes as the one of tau = t sqrt(D_M(wm) wm.z
 * / (D(m) m.z)) here (unit m and wm): for M = 1/alpha and wm = z that is t / alpha. */
mu_flake_normals mu_flake_cone(mu_flake_cdf *cdf, const double m[3], double tau);

/* footprint: u, v of the centre and the two half-axes of a parallelogram: u0, v0, u1, v1. It is taken as it is, but for
 * being no narrower anywhere than a flake, 1/sqrt(N): a smaller or empty one grows to that. */
mu_flake_tally mu_flake_count(const mu_flakes *flakes, const double footprint[6],
                              const mu_flake_normals *box);

/* K / E[K], never negative, of mean exactly 1; 1 where infinitely many flakes are indistinguishable or the footprint is not finite. */
double mu_flake_ratio(const mu_flakes *flakes, const double footprint[6], const mu_flake_normals *box);

#endif
