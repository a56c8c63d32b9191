/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * gtr.h: what the files of GTR share. P22 = c/pi (1+x)^(gamma-2) (x+a)^(-gamma), x the squared slope, a =
 * alpha².
 *
 * For 0 < gamma < 2 it is a mixture of GGX of roughness² u in [a, 1] (not in the paper). With L = -ln alpha, d
 * = 1 - gamma and s in R:  u(s) = alpha (alpha + e^s) / (1 + alpha e^s), weight ~ e^(d s) / ((1 + e^(-s-L))
 * (1 + e^(s-L))).
 */
#ifndef MU_GTR_H
#define MU_GTR_H

#include "core/bsdf/distribution.h"

/* z Lambda at slope tan = r/z, exact but for about `digits` decimal digits (9 or 16); gtr_smith.c. */
double mu_gtr_z_lambda(double alpha, double gamma, double r, double z, int digits);
/* (gamma - 1) ln(a) / expm1(...) (1 - a) / -ln(a): pi a P22(0), 1 for gamma = 2; no 0/0 anywhere. */
double mu_gtr_peak(double alpha, double gamma);
/* c, for P22 = c/pi x^-2 and Q = c/x far out. */
double mu_gtr_tail(double alpha, double gamma);

/* The float table (smith.h) of z Lambda / that of unit GGX, with slopes in `unit`. */
void mu_gtr_table_build(float *table, int octaves, double alpha, double gamma, double unit);

/* Slots of base.shape */
enum {
    GTR_SCALE,   /* C:  D = C (n2 / ref)² (other / ref)^exponent,                   */
    GTR_REF,     /* b:  ref = z² + b r²,                                           */
    GTR_OTHER_Z, /* other = OTHER_Z z² + UNIT² r² ...                              */
    GTR_UNIT,
    GTR_EXPONENT,
    GTR_D, /* 1 - gamma */
    GTR_L, /* -ln alpha */
    GTR_ALPHA,
    GTR_GAMMA,
    GTR_BOUND, /* gamma >= 2: the largest D / GGX; else 0 */
    GTR_TURN,  /* gamma >= 2: the squared slope at which it is largest */
    GTR_LEFT,  /* gamma < 2: masses of the envelope's pieces, gtr_mixture.h */
    GTR_MIDDLE,
    GTR_MIDDLE_ROOT,
    GTR_MIDDLE_SQUARE,
    GTR_RIGHT,
    GTR_TABLE_R2, /* r² of the table per r²; */
    GTR_OCTAVES,
    GTR_TO_FIRST, /* 2^octaves: stretches the piece at 0 to [0, 1] */
    GTR_SHAPE
};

#endif
