/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * singular.h: the singular values and rotations of a 2x2 matrix (two rows), in double.
 *
 *     m = R(left) diag(large, small) R(right),  R(t) = [cos t, -sin t; sin t, cos t],  large >= |small|,
 *
 * small < 0 for a mirror. With q, r = (large +- small) / 2 the matrix is q R(sum) + r R(difference) diag(1, -1),
 * sum = left + right, difference = left - right, whose four coordinates are sums and differences of the entries
 * (Blinn 1996, "Consider the lowly 2x2 matrix", IEEE CG&A 16(2)). small = q - r would lose as many digits as the
 * matrix is ill-conditioned; det / large loses none.
 */
#ifndef MU_SINGULAR_H
#define MU_SINGULAR_H

#include <math.h>

typedef struct singular {
    double large, small;
    double sum, difference;
} singular;

/* a d - b c to within 1.5 units in the last place, however much cancels (Kahan). */
static inline double product_difference(double a, double d, double b, double c) {
    const double bc = b * c;
    return fma(a, d, -bc) + fma(-b, c, bc);
}

/* `m` is finite and not zero. */
static inline singular singular_of(const double m[4]) {
    const double e = (m[0] + m[3]) / 2, f = (m[0] - m[3]) / 2, g = (m[2] + m[1]) / 2, h = (m[2] - m[1]) / 2;
    const double large = hypot(e, h) + hypot(f, g);
    int exponent; /* det / 2^exponent: det itself may overflow */
    const double scaled = frexp(large, &exponent);
    const double det = product_difference(ldexp(m[0], -exponent), m[3], ldexp(m[1], -exponent), m[2]);
    return (singular){large, det / scaled, atan2(h, e), atan2(g, f)};
}

/* The matrix that has the rotations of `s`, and these singular values; and the inverse of that. */
static inline void singular_matrix(const singular *s, double large, double small, double m[4],
                                   double inverse[4]) {
    const double q = (large + small) / 2, r = (large - small) / 2, det = large * small;
    const double e = q * cos(s->sum), h = q * sin(s->sum), f = r * cos(s->difference),
                 g = r * sin(s->difference);
    m[0] = e + f, m[1] = g - h, m[2] = g + h, m[3] = e - f;
    inverse[0] = m[3] / det, inverse[1] = -m[1] / det, inverse[2] = -m[2] / det, inverse[3] = m[0] / det;
}

#endif
