/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * stretch.h: a 2x2 deformation M (two rows, det M > 0) taken apart: for averages, and to be looked at.
 *
 * For averages, M = R(turn) T: T upper triangular with a positive diagonal, which is what frames that follow the u
 * direction of the surface give (T keeps e1), and R a rotation, 1 where both meshes have the same texture coordinates.
 * T^T T = M^T M = C, the metric, determines T: it is the transpose of C's Cholesky factor. C is averaged as
 * L = log(C) / 2 = log U, U the right stretch tensor (Hencky's strain; the log-Euclidean mean of Arsigny et al. 2006,
 * "Log-Euclidean metrics for fast and simple calculus on diffusion tensors"). Why so:
 *  - any mean of logarithms is the logarithm of a positive definite C: the result is never singular, while a mean of
 *    matrices can be (of rotations by +90 and -90 degrees it is 0);
 *  - rigid motions have L = 0, bent and turned as the faces may be in space: their mean is exactly 0, M = 1;
 *  - the area change is the geometric mean, and the mean of inverses the inverse of the mean: what is undone is
 *    undone, where the arithmetic mean of 2 and 1/2 is 5/4;
 *  - it turns with the frame, so that no direction of u is preferred.
 */
#ifndef MU_STRETCH_H
#define MU_STRETCH_H

/* What is averaged. */
typedef struct mu_stretch_log {
    double xx, xy, yy;     /* log U */
    double turn_x, turn_y; /* M e1 / |M e1| */
} mu_stretch_log;

/* det M > 0. */
mu_stretch_log mu_stretch_log_of(const double m[4]);
/* The inverse, of any weighted mean; a turn of no direction is none. */
void mu_stretch_matrix(const mu_stretch_log *log, double m[4]);

/* What is shown: M = R(rotation) U, U = s1 a a^T + s2 b b^T. Angles in radians, counter-clockwise from the tangent. */
typedef struct mu_stretch_axes {
    double most, least; /* singular values, s1 >= s2 */
    double rest;        /* of a, along which the rest surface is stretched by s1; in (-pi/2, pi/2] */
    double deformed;    /* of M a: where this direction is afterwards; in (-pi/2, pi/2] */
    double rotation;    /* of the polar decomposition, in (-pi, pi] */
    double area;        /* s1 s2 = det M */
} mu_stretch_axes;

mu_stretch_axes mu_stretch_axes_of(const double m[4]);

#endif
