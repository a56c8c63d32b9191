/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* sheen.h: what the files of the sheen distribution share. */
#ifndef MU_SHEEN_H
#define MU_SHEEN_H

/* 1 / 2 alpha, of any alpha > 0. */
double mu_sheen_k(double alpha);
/* sigma at the horizon, in units of sqrt(k + 1). */
double mu_sheen_horizon(double k);
/* z Lambda at slope tan = r/z in those units, to about `digits` decimal digits (9 or 16). */
double mu_sheen_z_lambda(double k, double r, double z, int digits);
/* The float table (smith.h) of Lambda over that of unit GGX. */
void mu_sheen_table_build(float *table, int octaves, double k);

/* Slots of base.shape */
enum { SHEEN_K, SHEEN_UNIT, SHEEN_HORIZON, SHEEN_OCTAVES, SHEEN_TO_FIRST };

#endif
