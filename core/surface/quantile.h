/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * quantile.h: how steep a share of an isotropic microsurface is.
 *
 * The magnitude r = tan theta of a slope drawn per unit macro area has the density 2 pi r P22(r) = 2 pi r D cos^4;
 * P(r) is its integral and Q(u) the inverse. Closed forms, written from the densities and apart from core/bsdf, so that
 * surfaces made with them test the material:
 *   beckmann  1 - exp(-r^2/a^2)                 ggx  r^2/(r^2 + a^2)
 *   gtr       (w^(1-g) - a^(2-2g)) / (1 - a^(2-2g)), w = (r^2 + a^2)/(1 + r^2); g = 1: ln(w/a^2)/ln(1/a^2)
 *   std       1 - (b/(b + r^2))^(g-1), b = (g-1) a^2
 *   phong     1 - cos^(e+2) theta               sheen  sin^(2+1/a) theta
 */
#ifndef MU_QUANTILE_H
#define MU_QUANTILE_H

typedef enum mu_slope_kind {
    MU_SLOPE_BECKMANN,
    MU_SLOPE_GGX,
    MU_SLOPE_GTR,
    MU_SLOPE_STD,
    MU_SLOPE_PHONG,
    MU_SLOPE_SHEEN
} mu_slope_kind;

typedef struct mu_slope_law {
    mu_slope_kind kind;
    double alpha;    /* > 0; gtr: < 1; phong does not use it */
    double gamma;    /* gtr: >= 0; std: > 1 (a finite mean of r asks for > 3/2) */
    double exponent; /* phong: >= 0 */
} mu_slope_law;

/* Names in the order of mu_slope_kind, then NULL: the material's own. */
const char *const *mu_slope_names(void);
/* What is wrong with the parameters, or NULL. */
const char *mu_slope_trouble(const mu_slope_law *law);
/* The slope that a share u of the surface stays below, 0 <= u < 1. */
double mu_slope_quantile(const mu_slope_law *law, double u);
/* The share of the surface whose slope stays below r >= 0. */
double mu_slope_share(const mu_slope_law *law, double r);

#endif
