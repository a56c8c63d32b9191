/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * reflectance.h: what share of unpolarised light a facet reflects, by the cosine between the light and its normal.
 *
 * Dielectrics and conductors from the complex amplitudes of Fresnel's equations, Schlick's approximation (1994) as it
 * stands: written apart from core/bsdf, as quantile.h is, so that explicit surfaces test the material.
 */
#ifndef MU_REFLECTANCE_H
#define MU_REFLECTANCE_H

typedef enum mu_reflectance_kind {
    MU_REFLECTS_ALL,
    MU_REFLECTS_SCHLICK,
    MU_REFLECTS_INDEX /* n + i k, relative to the medium above */
} mu_reflectance_kind;

typedef struct mu_reflectance {
    mu_reflectance_kind kind;
    int channels;      /* 1 or 3 colours */
    double a[3], b[3]; /* Schlick: reflectance at normal incidence; index: n and k */
} mu_reflectance;

double mu_reflectance_at(const mu_reflectance *r, int channel, double cosine);

#endif
