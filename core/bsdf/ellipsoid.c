/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * ellipsoid.c: the ellipsoid distribution (Walter et al. 2014, revised 2016) as GGX of alpha 1 under a transform and a
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

/* M Q for the ellipsoid's own Q = B2^-1, each of whose entries keeps its digits, is rounded to a few 2^-53 of |M| |Q|, and
 * that turns the thin side of an ill-conditioned M by up to S = (|M| |Q|)_00 (|M| |Q|)_11 + (|M| |Q|)_01 (|M| |Q|)_10 over |det M Q| of
 * them. The rounding of M alone does (|M00 M11| + |M01 M10|) / |det M|. With Q lower triangular S is that and 2 |q/s| |M01 M11| /
 * |det M|; with Q upper triangular (turned from the right, which GGX does not notice) 2 (|q| s / (p^2 + q^2)) |M00 M10| / |det M|.
 * As q^2 < p^2 + q^2, the smaller of both is below what M alone does: the better Q at most doubles that. */
static int is_better_lower(double p, double q, double s, const double M[4]) {
    return hypot(p, q) * sqrt(fabs(M[1])) * sqrt(fabs(M[3])) <= fabs(s) * sqrt(fabs(M[0])) * sqrt(fabs(M[2]));
}

int mu_ellipsoid_under(const double A[9], const double M[4], double transform[4], double tilt[2]) {
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
    /* B2 = [p 0; q s], too, by a rotation: p is its determinant over s, no difference of what cancels */
    const double norm = hypot(B[1], B[4]);
    if (norm == 0) return 0;
    int exponent; /* lest the determinant underflow */
    (void)frexp(norm, &exponent);
    const double det = product_difference(B[0], ldexp(B[4], -exponent), ldexp(B[1], -exponent), B[3]);
    const double p = det / ldexp(norm, -exponent) / beta, s = norm / beta,
                 q = (B[0] * (B[1] / norm) + B[3] * (B[4] / norm)) / beta;
    const double b[2] = {tilt[0] - B[6] / beta, tilt[1] - B[7] / beta};
    if (!(fabs(p * s) > 0)) return 0;
    double Q[4] = {1 / p, 0, -q / (p * s), 1 / s};
    if (!is_better_lower(p, q, s, M)) { /* B2 = [r qs/r; 0 ps/r] */
        const double r = hypot(p, q);
        Q[0] = 1 / r, Q[1] = -(q / r) / p, Q[2] = 0, Q[3] = r / (p * s);
    }
    for (int i = 0; i < 4; i++)
        if (!(fabs(Q[i]) <= DBL_MAX)) return 0;
    for (int i = 0; i < 2; i++) tilt[i] = Q[i] * b[0] + Q[2 + i] * b[1]; /* Q^T (t - b) */
    for (int i = 0; i < 4; i++) transform[i] = M[i / 2 * 2] * Q[i % 2] + M[i / 2 * 2 + 1] * Q[2 + i % 2];
    return fabs(tilt[0]) <= DBL_MAX && fabs(tilt[1]) <= DBL_MAX;
}

int mu_ellipsoid(const double A[9], double transform[4], double tilt[2]) {
    const double identity[4] = {1, 0, 0, 1};
    tilt[0] = tilt[1] = 0;
    return mu_ellipsoid_under(A, identity, transform, tilt);
}

#endif
