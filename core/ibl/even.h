/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * even.h: directions of light that stand for all of even light, laid out along a lobe: the mean of f cos times their weights
 * is the directional albedo. Frame of ibl.h; double.
 *
 *     mu_ibl_even even;
 *     mu_ibl_even_make(&lobe, wo, &even);
 *     for (i = 0; i < lattice.count; i++) {
 *         mu_ibl_fibonacci_at(lattice, shift, i, u);
 *         weight = mu_ibl_even_direction(&even, u, wi);
 *         if (weight > 0) albedo += weight * f(wo, wi) * wi[2] / lattice.count;
 *     }
 */
#ifndef MU_IBL_EVEN_H
#define MU_IBL_EVEN_H

#include "core/ibl/ibl.h"
#include "core/ibl/lattice.h"

typedef struct mu_ibl_even {
    double wo[3];     /* in the frame of the lobe's axes */
    double centre[2]; /* m.xy / m.z of the micronormal that rays start from */
    double spread[2]; /* along the axes: 1 of a ray */
    double turn[2];
} mu_ibl_even;

/* wo.z > 0. */
void mu_ibl_even_make(const mu_ibl_lobe_d *lobe, const double wo[3], mu_ibl_even *even);
/* u in [0, 1)². Returns the weight; 0: no direction. */
double mu_ibl_even_direction(const mu_ibl_even *even, const double u[2], double wi[3]);
/* The same of the ray (cos, sin) of its azimuth, which one after the other of a lattice are told by turning alone. */
double mu_ibl_even_along(const mu_ibl_even *even, double u, const double ray[2], double wi[3]);

/* What is asked of a direction of light, wi.z > 0: f cos of up to so many kinds; others are left 0. */
enum { EVEN_PARTS = 4 };
typedef void (*mu_ibl_toward)(void *context, const double wi[3], double value[EVEN_PARTS]);
/* The mean over a shifted lattice. */
void mu_ibl_even_by(const mu_ibl_even *even, mu_ibl_fibonacci lattice, const double shift[2], mu_ibl_toward toward, void *context,
                    double mean[EVEN_PARTS]);
/* The same until it is off by `enough`, or by `most` calls; returns what it is off. */
double mu_ibl_even_mean(const mu_ibl_even *even, mu_ibl_toward toward, void *context, double enough, size_t most, double mean[EVEN_PARTS]);

#endif
