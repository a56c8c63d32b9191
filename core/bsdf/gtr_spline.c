/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * gtr_spline.c: generalised Trowbridge-Reitz with the paper's approximate masking (Appendix A), a baseline for comparison:
 * the average visibility S = G1 by the natural cubic spline in gamma through S_0 to S_4, Eq. (35) to (39). Exact at the
 * integers; between them the spline oscillates, below 0 and above 1 where S climbs steeply. Not in the paper: S is kept
 * within [S_0, 1], in which the exact one lies.
 *
 * With A_k = z Lambda_k, S_k = z / (z + A_k), and c_k the weights of the spline at gamma, which sum to 1,
 *     S = z T,  1 - S = H,  T = sum c_k / (z + A_k),  H = sum c_k A_k / (z + A_k),  z Lambda = H / T:
 * no 0/0 at the horizon and no 1 - 1 at the normal. The A_k are the paper's closed forms freed of cancellation.
 */
#include "core/bsdf/gtr_shape.h"

enum { TAILS = 5 };

/* A_0 to A_4 for slope tan = r/z; one of both is 1, and neither is above. `first` is (1 - alpha²) / -2 ln alpha. */
static inline void integer_tails(real alpha, real first, real r, real z, real A[TAILS]) {
    const real a = alpha * alpha, b = (1 - alpha) * (1 + alpha), flat = alpha * r;
    const real root_0 = sqrt(z * z + r * r), root = larger(sqrt(z * z + flat * flat), REAL_MIN);
    const real c = z / root, c2 = c * c, q = square(flat / root), apart = r * r / (root + root_0);
    const real y = b * apart / (z + root);
    const real l2 = root * q / (2 * (1 + c)), l3 = root * q * q / (8 * (c2 + q / 2 + c));
    const real poly = c2 * c2 + R(1.5) * c2 * q + R(0.375) * q * q + c;
    const real l4 = root * q * q * q * (8 * c2 + 9 * q) / (128 * poly);
    A[0] = r * r / (2 * (z + root_0));
    A[1] = first * apart * (1 - z / (z + root) * (y > 0 ? log1p(y) / y : 1));
    A[2] = l2;
    A[3] = (2 * a * l2 + b * l3) / (1 + a);
    A[4] = (3 * a * a * l2 + 3 * a * b * l3 + b * b * l4) / (1 + a + a * a);
}

static inline real z_lambda(const base *b, const real w[3]) {
    const real *g = b->shape, *c = b->table;
    const real r = sqrt(flat_square(w)) / g[GTR_UNIT], size = larger(r, w[2]);
    if (!(r > 0)) return 0;
    real A[TAILS], H = 0, T = 0;
    integer_tails(g[GTR_ALPHA], c[TAILS], r / size, w[2] / size, A);
    for (int k = 0; k < TAILS; k++) {
        const real over_sigma = c[k] / (w[2] / size + A[k]);
        H += A[k] * over_sigma, T += over_sigma;
    }
    const real longest = w[2] / size + A[0]; /* sigma_0 */
    return size * (H <= 0 ? 0 : T * longest <= 1 ? A[0] : H / T);
}

/* What each knot 0 ... 4 weighs at gamma: y'' at the inner knots solves (1 4 1) y'' = 6 (1 -2 1) y, and is 0 at the outer. */
static void natural_spline(double gamma, double c[TAILS]) {
    static const double inverse[3][3] = {
        {15, -4, 1}, {-4, 16, -4}, {1, -4, 15}}; /* of (4 1; 1 4 1; 1 4), times 56 */
    const int k = gamma >= 3 ? 3 : (int)gamma;
    const double t = gamma - k, bend[2] = {(1 - t) * t * (t - 2) / 6, t * (t - 1) * (t + 1) / 6};
    for (int i = 0; i < TAILS; i++) c[i] = i == k ? 1 - t : i == k + 1 ? t : 0;
    for (int end = 0; end < 2; end++) {
        const int row = k + end - 1;
        for (int j = 0; row >= 0 && row < 3 && j < 3; j++) {
            const double w = bend[end] * inverse[row][j] * 6 / 56;
            c[j] += w, c[j + 1] -= 2 * w, c[j + 2] += w;
        }
    }
}

/* The five weights, and `first` of integer_tails. */
static size_t table_bytes(const mu_definition *d) {
    (void)d;
    return (TAILS + 1) * sizeof(real);
}

static double prepare(base *b, const mu_definition *d, void *table) {
    const double unit = shape_prepare(b, d);
    real *weights = table;
    double c[TAILS];
    natural_spline(d->gamma, c);
    for (int k = 0; k < TAILS; k++) weights[k] = R(c[k]);
    weights[TAILS] = R((1 - d->alpha) * (1 + d->alpha) / (-2 * log(d->alpha)));
    b->table = table;
    return unit;
}

enum { TRAITS = PICKS };

#define DISTRIBUTION gtr_spline
#include "core/bsdf/transformed.h"
