/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * cells.h: what of even light leaves a histogram's random walk after its first facet (cells.c), for walks.c; in both precisions.
 */
#ifndef MU_IBL_CELLS_H
#define MU_IBL_CELLS_H

#include "core/bsdf/distribution.h"

enum { CELL_PARTS = 4 };

/* With F in r, g, b; and for F = 1. `along`: 1 + Lambda_o, cliffs included. */
void MU(mu_ibl_cells_once)(const closure *c, double along, double allowed, double rgb[CELL_PARTS]);
/* Lambda_i of a walk, cliffs included (walks.c). i.z > 0. */
double MU(mu_ibl_walk_lambda)(const closure *c, const real i[3]);

#endif
