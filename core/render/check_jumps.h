/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * check_jumps.h: integrals of functions that jump along curves nobody has told of, over a rectangle.
 *
 * Gauss and Kronrod agree that nothing is there where a corner passes between their nodes. A Fibonacci lattice has no large
 * gaps and no direction that curves are likely to follow. Of its N points, those whose cell (1/N of the area) the curves cross
 * are some 2 sqrt(N), each wrong by up to the range of the function with a standard deviation of 1/sqrt(12): the
 * integral's is sqrt(2 sqrt(N) / 12) / N = 0.41 N^-3/4 of range times area. N^-3/4 of it, 2.4 of these, is the error told;
 * where a second lattice, moved by half a step, disagrees by more, that.
 */
#ifndef MU_CHECK_JUMPS_H
#define MU_CHECK_JUMPS_H

#include "core/render/check_quadrature.h"

/* Part 0 of the integrand over [x0,x1] x [y0,y1]. A rectangle much wider than `fine` (of x) is taken in pieces that double in
 * width from both ends on, since what it has may be a sliver there. */
void mu_integrate_jumps(mu_integrand integrand, void *context, const double x[2], const double y[2],
                        double fine, double *value, double *error);

#endif
