/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * quadric.h: the tangents of both surfaces at a place, of second order.
 *
 * Over the tangent plane at rest, with coordinates s, the surface at rest is p = s + h(s) n, the deformed one q(s), the
 * texture v(s). Each is fitted by a polynomial of degree two through the place, by least squares over the vertices of a
 * patch weighted by 1 / distance^2: where all are smooth, what the fit leaves out is of third order in the size of the
 * triangles, and slopes, having one order less, are wrong in the second, wherever the vertices lie. (A triangle's own
 * slopes are those of degree one: wrong in the first.)
 */
#ifndef MU_TENSION_QUADRIC_H
#define MU_TENSION_QUADRIC_H

#include "core/tension/patch.h"

typedef struct mu_plane {
    double n[3], s1[3], s2[3]; /* orthonormal, right-handed */
} mu_plane;

enum { MU_QUADRIC_H, MU_QUADRIC_Q, MU_QUADRIC_V = 4, MU_QUADRIC_VALUES, MU_QUADRIC_TERMS = 5 };

typedef struct mu_quadric { /* normal equations; terms s1, s2, s1^2, s1 s2, s2^2 */
    double a[MU_QUADRIC_TERMS][MU_QUADRIC_TERMS], b[MU_QUADRIC_VALUES][MU_QUADRIC_TERMS];
} mu_quadric;

/* Over the last patch of the ground, around one of its corners. uvs: 6 per triangle as in the input, or NULL: no v. */
void mu_quadric_fit(mu_ground *ground, const mu_plane *plane, uint32_t centre, const double *uvs,
                    mu_quadric *fit);
/* Derivatives by s1 and s2, of degree 2 or 1. False where the vertices do not tell: all but on one conic, or line, so
 * that what the fit leaves out would be carried into the slopes 1 / sqrt(least) fold. */
_Bool mu_quadric_slopes(const mu_quadric *fit, int degree, double least, double slope[MU_QUADRIC_VALUES][2]);

/* `least` for patches of one ring: below, two are better. And for those, which are what there is: on one side of a border
 * s^2 is not far from a multiple of s. */
#define MU_QUADRIC_NEAR 0.04
#define MU_QUADRIC_WIDE 0.001

#endif
