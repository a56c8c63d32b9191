/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_refraction.h: Snell's law and the densities of what it makes, from the textbook and apart from the core: Walter
 * et al. 2007, "Microfacet models for refraction through rough surfaces", Eq. (16), (17), (21). All directions point
 * away from the surface; eta = n_i / n_o.
 */
#ifndef MU_CHECK_REFRACTION_H
#define MU_CHECK_REFRACTION_H

/* The direction into which micronormal m refracts wo, and its solid angle per solid angle of m. False: total
 * reflection, m turned away, or the other side is not reached. */
_Bool mu_refracted(double eta, const double wo[3], const double m[3], double wi[3], double *spread);

/* How far eta wi + wo is from m's line, in units of its length: 0 by Snell's law. */
double mu_refraction_error(double eta, const double wo[3], const double wi[3], const double m[3]);

/* f / ((1 - F) D G2): (wo.m)(wi.m) / (wo.z wi.z (wo.m + eta wi.m)^2), with absolute values; radiance. */
double mu_refraction_factor(double eta, const double wo[3], const double wi[3], const double m[3]);

/* The micronormal between them: +-(wo + eta wi), up. False if there is none that faces wo. */
_Bool mu_refraction_normal(double eta, const double wo[3], const double wi[3], double m[3]);

#endif
