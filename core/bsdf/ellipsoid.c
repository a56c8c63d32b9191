/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * ellipsoid.c: the ellipsoid distribution (Walter et al. 2014-2016, "seed 001") as GGX of alpha 1 under a transform and a
 * tilt. In double.
 *
 * Eq. (1), D = 1 / (pi |det A| |A n| |A^-T m|^4), depends on A up to rotations from the left and scale. With A = Q B, B
 * lower block triangular, B = beta [B2 0; b^T 1], the position map B^-1 is [M 0; t^T 1] of linear_map.h with
 *     M = B2^-1,   t = -M^T b,
 * and |det M| / |L^T m|^4 / pi is Eq. (1). Exact visible-normal sampling of a tilted GGX by spherical caps takes the
 * place of Section 4.1: the same density (33), by other means.
 */
#include "core/bsdf/real.h"
#include "core/bsdf/singular.h"

#if MU_REAL_BITS == 53

void mu_ellipsoid_matrix(const double alpha[2], const double theta[3], double A[9]) {
    const double cx = cos(theta[0]), sx = sin(theta[0]), cy = cos(theta[1]), sy = sin(theta[1]),
                 cz = cos(theta[2]), sz = sin(theta[2]);
    /* Eq. (3): R = Rx Ry Rz */
    const double R[9] = {cy * cz,
                         -cy * sz,
                         sy,
                         cx * sz + sx * sy * cz,
                         cx * cz - sx * sy * sz,
                         -sx * cy,
                         sx * sz - cx * sy * cz,
                         sx * cz + cx * sy * sz,
                         cx * cy};
    for (int i = 0; i < 9; i++)
        A[i] = (i < 3 ? alpha[0] : i < 6 ? alpha[1] : 1) * R[i]; /* Eq. (2): A = S R */
}

/* Reflects all columns so that the last is (0, 0, beta) (Householder). The row with the largest share of it is taken for the
 * last: what the others take on is then of their own size, and a row of little roughness keeps its digits. */
static void eliminate(double A[9]) {
    int pivot = 2;
    for (int i = 0; i < 2; i++) pivot = fabs(A[3 * i + 2]) > fabs(A[3 * pivot + 2]) ? i : pivot;
    for (int k = 0; k < 3; k++) {
        const double row = A[3 * pivot + k];
        A[3 * pivot + k] = A[6 + k], A[6 + k] = row;
    }
    const double norm = hypot(hypot(A[2], A[5]), A[8]);
    if (norm == 0) return;
    const double v[3] = {A[2], A[5], A[8] + copysign(norm, A[8])},
                 v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    for (int k = 0; k < 3; k++) {
        const double dot = v[0] * A[k] + v[1] * A[3 + k] + v[2] * A[6 + k];
        for (int i = 0; i < 3; i++) A[3 * i + k] -= 2 * dot / v2 * v[i];
    }
}

int mu_ellipsoid(const double A[9], double transform[4], double tilt[2]) {
    double B[9], largest = 0;
    for (int i = 0; i < 9; i++) {
        if (!(fabs(A[i]) <= DBL_MAX)) return 0;
        largest = fmax(largest, fabs(A[i]));
    }
    if (largest == 0) return 0;
    for (int i = 0; i < 9; i++) B[i] = A[i] / largest;
    eliminate(B);
    const double beta = B[8];
    if (beta == 0) return 0;
    /* B2 lower triangular, too, by a rotation: p is its determinant over s, no difference of what cancels */
    const double norm = hypot(B[1], B[4]);
    if (norm == 0) return 0;
    int exponent; /* lest the determinant underflow */
    (void)frexp(norm, &exponent);
    const double det = product_difference(B[0], ldexp(B[4], -exponent), ldexp(B[1], -exponent), B[3]);
    const double p = det / ldexp(norm, -exponent) / beta, s = norm / beta,
                 q = (B[0] * (B[1] / norm) + B[3] * (B[4] / norm)) / beta, b[2] = {B[6] / beta, B[7] / beta};
    if (!(fabs(p * s) > 0)) return 0;
    transform[0] = 1 / p, transform[1] = 0; /* B2 = [p 0; q s] */
    transform[2] = -q / (p * s), transform[3] = 1 / s;
    tilt[0] = -(transform[0] * b[0] + transform[2] * b[1]); /* t = -M^T b */
    tilt[1] = -(transform[1] * b[0] + transform[3] * b[1]);
    for (int i = 0; i < 4; i++)
        if (!(fabs(transform[i]) <= DBL_MAX)) return 0;
    return fabs(tilt[0]) <= DBL_MAX && fabs(tilt[1]) <= DBL_MAX;
}

#endif
