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

#endif
