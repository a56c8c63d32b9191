/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * extrema.h: the boundary's closest and farthest points, Appendix A. All in the frame of U, V and the normal.
 *
 * The boundary has the slopes (rx cos t, ry sin t). With p(t) = o.x rx cos t + o.y ry sin t the alignment of Eq. (7) is
 *     d(t) = 2 (o.z² - p²) / (1 + rx² cos² t + ry² sin² t) + o.x² + o.y² - o.z²,
 * in x = hx cos t, y = hy sin t, hx = hypot(1, rx), hy = hypot(1, ry), a quotient of quadratic forms:
 *     (p² - o.z² (cos² t + sin² t)) / (x² + y²),
 *     p = a x + b y,  a = o.x rx / hx,  b = o.y ry / hy,
 * whose extrema are the eigenvectors of [a² - (o.z/hx)², a b; a b, b² - (o.z/hy)²]. The difference of its diagonal is
 * a² - b² + c, c = o.z² (rx² - ry²) / (hx hy)²: phi1 of the paper over (hx hy)². With s = hypot(a² - b² + c, 2 a b) the
 * farthest has (x, y) along (a² - b² + c + s, 2 a b), or along (2 a b, s - a² + b² - c) where that sum would cancel, and the
 * closest along (-y, x). No case needs its own formula: the paper's phi2 = 0 is a b = 0. Only the ratios of a, b and sqrt |c|
 * matter, so they are scaled to 1 at most: nothing overflows, and what underflows is nothing beside the rest. All zero, or an
 * equal pair of eigenvalues: all points are equally far.
 *
 * p, by which the view meets the points, is written without the cancellation that makes it 0 at the closest where the view
 * is along the horizon (c = 0): of the first form a (s + a² + b² + c) at the farthest and, at the closest,
 *     b (s - a² - b² + c) = 4 c a² b / (s + a² + b² - c),
 * of the second the same with a and b exchanged and -c for c.
 */
#ifndef MU_IBL_EXTREMA_H
#define MU_IBL_EXTREMA_H

#include "core/ibl/length.h"

typedef struct extremum {
    real cosine,
        sine; /* of t in (-pi/2, pi/2]: not by way of t, which near pi/2 would lose the cosine's digits */
    real p;
} extremum;

/* The t of x = hx cos t, y = hy sin t, any multiple of them, with p = a x + b y. */
static inline extremum extremum_at(real x, real y, real p, real hx, real hy) {
    const real wide = larger(hx, hy), c = x * (hy / wide), s = y * (hx / wide);
    const real turn = c < 0 || (c == 0 && s < 0) ? -1 : 1, length = turn * length2(c, s);
    return (extremum){c / length + 0, s / length, p / length * smaller(hx, hy)}; /* -0 becomes 0 */
}

/* s - u + c at s² - (u - c)² = 4 c a², u = a² + b²: see above. */
static inline real small_root(real s, real u, real c, real a) {
    return u > c ? 4 * c * a * a / (s + (u - c)) : s + (c - u);
}

static inline void extrema_of(const real r[2], const real o[3], extremum *nearest, extremum *farthest) {
    const real hx = length2(R(1), r[0]), hy = length2(R(1), r[1]), apart = r[0] - r[1];
    real a = o[0] * (r[0] / hx), b = o[1] * (r[1] / hy);
    real root_c = sqrt(fabs(apart) / hx / hy) * sqrt((r[0] / hx + r[1] / hx) / hy) * o[2];
    const real largest = larger(larger(fabs(a), fabs(b)), root_c);
    if (largest > 0) a /= largest, b /= largest, root_c /= largest;
    const real c = apart < 0 ? -(root_c * root_c) : root_c * root_c, difference = (a - b) * (a + b) + c,
               product = 2 * a * b;
    const real s = length2(difference, product), u = a * a + b * b;
    /* the form to take, without branches: several views go at a time. s = 0: Appendix A, t0 = pi/2, t1 = t0 + pi/2 */
    const _Bool first = difference >= 0, none = s == 0;
    const real A = first ? a : b, B = first ? b : a, C = first ? c : -c,
               sum = none ? 1 : fabs(difference) + s;
    const real far = A * (none ? 1 : s + (u + C)) * largest,
               near = B * (none ? 1 : small_root(s, u, C, A)) * largest;
    *farthest = extremum_at(first ? sum : product, first ? product : sum, far, hx, hy);
    *nearest = extremum_at(first ? -product : -sum, first ? sum : product, first ? near : -near, hx, hy);
}

#endif
