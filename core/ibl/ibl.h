/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * ibl.h: where a glossy material looks into its environment: the major axis of its lobe, and samples along it.
 *
 * Cocco, Zanni and Chermain 2024, "Anisotropic specular image-based lighting based on BRDF major axis sampling"; equation
 * and appendix numbers of this room are theirs. Frame: right-handed, +z the macrosurface normal; directions are unit
 * vectors away from the surface. A micronormal m has the slope s = -m.xy / m.z. Three spaces: slopes; micronormals; and
 * the reflected directions 2 (m.wo) m - wo, in which distances are chords of the unit sphere.
 *
 *     mu_ibl_slopes s;
 *     if (!mu_ibl_slopes_of(&definition, &s)) ...          // of a custom distribution nobody knows them
 *     mu_ibl_lobe_f lobe = mu_ibl_lobe_of_f(&s);           // or of a mean of such s: they may be averaged
 *     mu_ibl_settings_f settings = mu_ibl_settings_default_f();
 *     mu_ibl_axis_f axis;
 *     mu_ibl_axis_make_f(&lobe, wo, &settings, &axis);     // once per hit
 *     for (size_t j = 0; j < settings.samples; j++) mu_ibl_axis_sample_f(&axis, settings.samples, j, m);
 *
 * Functions ..._f compute in float, ..._d in double. All that comes out is finite whatever finite comes in: roughness 0,
 * a view along the horizon, and slopes that no number holds. Nothing is allocated; any thread may call anything.
 */
#ifndef MU_IBL_H
#define MU_IBL_H

#include <stddef.h>

#include "core/bsdf/musurf.h"

/* Moments of slopes: their mean, and Sigma, the covariance that stands for the distribution (slopes.c). */
typedef struct mu_ibl_slopes {
    double mean[2];
    double xx, xy, yy;
} mu_ibl_slopes;

/* Those of a checked definition under its M. 0 for MU_CUSTOM, which does not tell them. */
int mu_ibl_slopes_of(const mu_definition *definition, mu_ibl_slopes *out);
/* The slope within which a share of all are, of a checked definition before M, over that of GGX of the same Sigma: its
 * tail, from share to share. 1 where there is none, or nothing radially symmetric. */
double mu_ibl_tail_of(const mu_definition *definition, double share);
/* Those of a surface with these under a further M (rows): slopes go with M^-T. */
mu_ibl_slopes mu_ibl_slopes_under(const mu_ibl_slopes *slopes, const double transform[4]);
/* Those of a surface that consists of `count` others in these shares (any positive numbers; NULL: alike): linear in Sigma
 * plus the products of the means (Section 4.1). */
mu_ibl_slopes mu_ibl_slopes_mix(size_t count, const mu_ibl_slopes *parts, const double *shares);

/* How Appendix C moves the closest points where the axis is cut: as printed, which moves both to one side and jumps where
 * both ends are cut; or by what the two ends lose in sum, which is the same where one end is cut alone. */
typedef enum mu_ibl_shift { MU_IBL_SYMMETRIC, MU_IBL_PRINTED } mu_ibl_shift;

/* Views at a time of mu_ibl_axes_make: what is alike is worked out for several at once. */
enum { MU_IBL_AXES = 16 };

#define MU_REAL       float
#define MU_SUFFIX(id) id##_f
#include "core/ibl/ibl_real.h"
#undef MU_REAL
#undef MU_SUFFIX
#define MU_REAL       double
#define MU_SUFFIX(id) id##_d
#include "core/ibl/ibl_real.h"
#undef MU_REAL
#undef MU_SUFFIX

/* What the axis is made for, of GGX: P22 of slopes (x, y); D cos of micronormals; f cos, with F = 1 and height-correlated
 * shadowing, of reflected directions; per unit of slope squared, or per steradian. 0 if it is none that numbers hold: a sigma
 * of 0, a view along the horizon. */
typedef enum mu_ibl_space { MU_IBL_SLOPES, MU_IBL_NORMALS, MU_IBL_REFLECTED } mu_ibl_space;
int mu_ibl_density(const mu_ibl_lobe_d *lobe, const double wo[3], mu_ibl_space space, size_t count,
                   const double *points, double *out);

#endif
