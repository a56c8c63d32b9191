/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * statistics.h: how the facets of a surface are distributed, and how the distributions scatter over surfaces.
 *
 * Histograms count macro area: a facet of a baked heightfield stands over |det M|/2, whatever its slope, so shares of
 * facets are shares of macro area. D is the area of facets per unit macro area and unit solid angle of normals.
 */
#ifndef MU_STATISTICS_H
#define MU_STATISTICS_H

#include "core/surface/heightfield.h"
#include "core/surface/quantile.h"

/* Shares of the steepness of one family (MU_LOWER, MU_UPPER) in `bins` bins that have the mass 1/bins each under the
 * law. M is the identity. */
void mu_slope_shares(const mu_heightfield *f, int upper, const mu_slope_law *law, uint32_t bins,
                     double *shares);
/* The relative rms deviation of these shares from 1/bins; bins <= 256. */
double mu_slope_deviation(const mu_heightfield *f, int upper, const mu_slope_law *law, uint32_t bins);

/* Bins of directions: `rings` of theta from 0 to theta_most, `sectors` of phi from 0 to 2 pi; the bin of a direction w
 * (any length) is ring * sectors + sector, or rings * sectors outside. */
typedef struct mu_directions {
    uint32_t rings, sectors;
    double theta_most; /* at most pi; beyond pi/2 for surfaces that hang over */
} mu_directions;
size_t mu_directions_count(const mu_directions *d);
size_t mu_directions_bin(const mu_directions *d, const double w[3]);
double mu_directions_solid_angle(const mu_directions *d, size_t bin);
/* The integral of cos theta over the bin. */
double mu_directions_projected(const mu_directions *d, size_t bin);

/* D of the surface under M, mean per bin, 1/sr; out[count] is the area outside the bins per unit macro area. */
void mu_normal_density(const mu_heightfield *f, const double m[4], const mu_directions *d, double *out);
/*
 * Dv of the surface under M seen along the unit vector w: per bin the visible projected area over the surface's own,
 * 1/sr. visible[upper] holds the share of each facet that is seen, n * n. out[count] is what falls outside.
 */
void mu_visible_density(const mu_heightfield *f, const double m[4], const double w[3],
                        const double *const visible[2], const mu_directions *d, double *out);

/* Mean and standard error of many numbers over realisations, one realisation after the other (Welford). */
typedef struct mu_spread {
    double count, mean, squares;
} mu_spread;
void mu_spread_add(mu_spread *spread, double value);
double mu_spread_error(const mu_spread *spread); /* of the mean; NaN below two realisations */

#endif
