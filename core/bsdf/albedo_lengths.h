/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_lengths.h: how long the slopes of a distribution are, in slope units: tails of P22 t dt, and of that times t, from which
 * what a view sees along an azimuth is mixed (albedo_quadrature.c), whatever the map. Made once for all views
 * (albedo_lengths.c).
 */
#ifndef MU_ALBEDO_LENGTHS_H
#define MU_ALBEDO_LENGTHS_H

#include "core/bsdf/musurf.h"

enum { ALBEDO_LENGTHS = 320 };

typedef struct albedo_length {
    double x;           /* ln t */
    double mass, reach; /* per x: P22 t², P22 t³ */
    double beyond[2];   /* integrals of both from here on */
} albedo_length;

typedef struct albedo_lengths {
    int count;
    albedo_length at[ALBEDO_LENGTHS];
} albedo_lengths;

/* Those of a closure's distribution. `core` is the least length where slopes crowd, in slope units, at most 1. */
void mu_albedo_lengths_of(const mu_closure_f *c, double core, albedo_lengths *out);

/* What is mixed: so much of either. */
typedef struct length_mix {
    double mass, reach;
} length_mix;
/* The mixture's integral from t on, and the step that t is in. */
double mu_albedo_beyond(const albedo_lengths *l, length_mix mix, double t, int *step);
/* t from which on it is `beyond`; and by what ln t changes with that, *rate, as it is interpolated: above 0. *step is that of a
 * lesser t, and of this one then: lengths are asked for in ascending order. */
double mu_albedo_length(const albedo_lengths *l, length_mix mix, double beyond, int *step, double *rate);

#endif
