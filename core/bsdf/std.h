/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* std.h: what the files of the Student-t distribution share. */
#ifndef MU_STD_H
#define MU_STD_H

/* sigma at the horizon, in slope units: Gamma(gamma - 3/2) sqrt(gamma - 1) / (2 sqrt(pi) Gamma(gamma - 1)). */
double mu_std_horizon(double gamma);
/* int_0^1 (1 + (z / u r)²)^-p du: from 0 (z >> r) to 1 (z = 0). */
double mu_std_integral(double p, double r, double z);
/* The float table (smith.h) of that integral over (1 + (z/r)²)^-p, which takes its steep part away. */
void mu_std_table_build(float *table, int octaves, double gamma);

/* Slots of base.shape */
enum { STD_GAMMA, STD_B, STD_P, STD_HORIZON, STD_BOUND, STD_OCTAVES, STD_TO_FIRST };

#endif
