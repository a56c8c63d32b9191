/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * minimise.h: the minimum of a smooth function of a few numbers, by BFGS (Nocedal & Wright, Numerical Optimization,
 * 2nd ed., algorithm 6.1) with steps of bounded length that are halved until they lead down; and its Hessian, by central
 * differences of the gradient.
 */
#ifndef MU_MINIMISE_H
#define MU_MINIMISE_H

enum { MU_MOST_UNKNOWNS = 8 };

/* The value at x, and its gradient. May be infinite. */
typedef double (*mu_smooth)(void *context, const double *x, double *gradient);

/* x: start, then the best point; returns the value there. `converged`: the gradient fell below `tolerance` in every
 * component. */
double mu_minimise(mu_smooth f, void *context, int n, double *x, double tolerance, _Bool *converged);
/* Symmetric, row by row, n x n. */
void mu_hessian(mu_smooth f, void *context, int n, const double *x, double step, double *out);
/* out = inverse of a symmetric positive definite a; false if it is none. */
_Bool mu_invert(const double *a, int n, double *out);

#endif
