/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * lobe_return.h: what the lobe of a compensated closure makes of a unit of lost light: the mean of lost cos / (pi A pdf) over draws
 * of its own, at the points of a lattice (lobe_return.c). 1 is right. *off, unless NULL, is by how much two halves of the draws differ.
 */
#ifndef TESTS_LOBE_RETURN_H
#define TESTS_LOBE_RETURN_H

#include "core/bsdf/musurf.h"

double lobe_return(const mu_closure_f *c, int draws, double *off);

#endif
