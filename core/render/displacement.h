/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * displacement.h: a map of the texture square from a picture: T(u,v) = (u,v) + scale d(u,v), d by a picture of two
 * channels, in texture coordinates, v upwards.
 *
 * Between texels d is the uniform cubic B-spline of them: twice differentiable, so that the Jacobian of T, which is exact,
 * has no edges; it reproduces what is linear, and smooths what is not by 1/6 of its second difference.
 */
#ifndef MU_DISPLACEMENT_H
#define MU_DISPLACEMENT_H

#include "core/render/mipmap.h"

typedef struct mu_displacement {
    mu_mipmap picture; /* its finest level alone */
    double scale;
} mu_displacement;

/* [any] J - 1 at (u, v), rows. */
void mu_displacement_at(const mu_displacement *displacement, double u, double v, double change[4]);

#endif
