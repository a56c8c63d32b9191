/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * polar_albedo.h: the directional albedo of a closure of single scattering, by a quadrature that is not the library's (polar_albedo.c).
 * `core` is where its slopes crowd, in slope units: gtr's alpha, else 1. *off is by how much it thinks that it is off.
 */
#ifndef TESTS_POLAR_ALBEDO_H
#define TESTS_POLAR_ALBEDO_H

#include "core/bsdf/musurf.h"

double polar_albedo(const mu_closure_f *c, double core, double allowed, double *off);

#endif
