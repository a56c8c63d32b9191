/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * slopes.c: Sigma, the slope covariance that stands for a material, of any distribution under M; and its axes. Slopes
 * (dz/dx, dz/dy); in double but for what is handed to shading.
 *
 * GGX has no covariance; Section 4.1 takes alpha²/2 in its place, so that under M (slopes go with M^-T)
 *     Sigma = alpha²/2 (M M^T)^-1.
 * The ellipse of k = 1 holds a third of its slopes, P(s² <= alpha²/2) = 1/3: that is the confidence region, and it is what
 * the other distributions are matched by: sigma² is the square of the slope that a third of theirs are below (closed forms,
 * from the survival functions), their true variance or not: where that exists it may be all in the tail. A histogram's
 * region has the shape of its true covariance, about its mean, and the size at which it holds a third. Flakes are what they
 * scatter about; a mirror's Sigma is 0.
 */
#include "core/bsdf/singular.h"
#include "core/bsdf/tabulated.h"
#include "core/ibl/ibl.h"

#include "core/bsdf/real.h"

MU(mu_ibl_lobe) MU(mu_ibl_lobe_of)(const mu_ibl_slopes *s) {
    const double half = s->xx / 2 - s->yy / 2, apart = hypot(half, s->xy);
    const double large = s->xx / 2 + s->yy / 2 + apart;
    /* its product with the smaller one is the determinant; scaled, or it would overflow */
    const double small = large > 0 ? product_difference(s->xx / large, s->yy, s->xy / large, s->xy) : 0;
    const double angle = apart > 0 ? atan2(s->xy, half) / 2 : 0;
    return (MU(mu_ibl_lobe)){{R(sqrt(fmax(large, 0))), R(sqrt(fmax(small, 0)))},
                             {R(cos(angle)), R(sin(angle))},
                             {R(s->mean[0]), R(s->mean[1])}};
}

#if MU_REAL_BITS == 53

#define SHARE (1.0 / 3)

/* Of a radially symmetric distribution: the squared slope that a share of all are below; -1 if it is not told. */
static double square_of(const mu_definition *d, double share) {
    const double a = d->alpha * d->alpha;
    switch (d->ndf) {
    case MU_GGX:
    case MU_DISCRETE_GGX:
        return share / (1 - share) * a;
    case MU_BECKMANN:
    case MU_DISCRETE_BECKMANN:
        return -log1p(-share) * a;
    case MU_GTR: { /* q = (x + a) / (1 + x): those above x are (q^e - 1) / (a^e - 1), e = 1 - gamma */
        if (d->alpha == 0 && d->gamma >= 1) return 0;
        if (d->alpha == 1) return share / (1 - share); /* q = 1: GGX */
        const double ln_a = 2 * log(d->alpha), e = 1 - d->gamma, y = e * ln_a;
        /* ln(q/a) and ln q, each where the other would lose digits or overflow (gtr_shape.h) */
        double above = -share * ln_a, below = (1 - share) * ln_a;
        if (e != 0) {
            above = log1p(share * expm1(-y)) / e, below = log1p((1 - share) * expm1(y)) / e;
            if (y > 40) below = above + ln_a;
            if (y < -40) above = below - ln_a;
        }
        return above > 40 ? exp(below) / -expm1(below) : a * expm1(above) / -expm1(below);
    }
    case MU_STD: /* (1 + x/b)^(1 - gamma), b = (gamma - 1) alpha² */
        return (d->gamma - 1) * a * expm1(log1p(-share) / (1 - d->gamma));
    case MU_PHONG: /* (1 + x)^-(n + 2)/2 */
        return expm1(-2 * log1p(-share) / (d->exponent + 2));
    case MU_SHEEN: { /* 1 - (x / (1 + x))^(1 + 1/2r) */
        const double ln = log(share) / (1 + 0.5 / d->alpha);
        return exp(ln) / -expm1(ln);
    }
    case MU_FLAT:
        return 0;
    default:
        return -1;
    }
}

/* The share of a histogram's slopes s with |root^-1 (s - mean)| <= radius: cells cut by the ellipse count by a lattice. */
static double share_within(const mu_definition *d, const double mean[2], const double root[3],
                           double radius) {
    enum { FINE = 8 };
    const double *b = d->histogram_bounds, cell[2] = {(b[1] - b[0]) / (double)d->histogram_columns,
                                                      (b[3] - b[2]) / (double)d->histogram_rows};
    /* from a cell's middle to any of its points, in that norm, at most */
    const double corner =
        hypot(cell[0] / 2 / root[0], (cell[1] / 2 + fabs(root[1]) * cell[0] / 2 / root[0]) / root[2]);
    double within = 0, all = 0;
    for (size_t j = 0; j < d->histogram_rows; j++)
        for (size_t i = 0; i < d->histogram_columns; i++) {
            const double weight = d->histogram[j * d->histogram_columns + i];
            all += weight;
            if (!(weight > 0)) continue;
            const double x = b[0] + ((double)i + 0.5) * cell[0] - mean[0],
                         y = b[2] + ((double)j + 0.5) * cell[1] - mean[1];
            const double across = x / root[0], reach = hypot(across, (y - root[1] * across) / root[2]);
            if (reach + corner <= radius) within += weight;
            if (reach + corner <= radius || reach - corner > radius) continue;
            int hits = 0;
            for (int k = 0; k < FINE * FINE; k++) {
                const double u = (x + ((k % FINE + 0.5) / FINE - 0.5) * cell[0]) / root[0],
                             v = y + ((k / FINE + 0.5) / FINE - 0.5) * cell[1];
                hits += hypot(u, (v - root[1] * u) / root[2]) <= radius;
            }
            within += weight * hits / (FINE * FINE);
        }
    return within / all;
}

/* The lower triangle of a histogram's matched covariance, by bisection of its size. */
static void matched_histogram(const mu_definition *d, double mean[2], double root[3]) {
    double covariance[3];
    mu_tabulated_moments(d, mean, covariance);
    root[0] = sqrt(covariance[0]), root[1] = covariance[1] / root[0];
    root[2] = sqrt(fmax(covariance[2] - root[1] * root[1], DBL_EPSILON * covariance[2]));
    double low = 0, high = 2; /* Chebyshev: within 2 deviations of a plane's slopes are a half at least */
    while (high - low > 1e-6 * high) {
        const double middle = (low + high) / 2;
        *(share_within(d, mean, root, middle) < SHARE ? &low : &high) = middle;
    }
    for (int k = 0; k < 3; k++) root[k] *= high;
}

/* Of slopes with the mean `mean` and the covariance root root^T, root lower triangular. */
static mu_ibl_slopes under(const double mean[2], const double root[3], const double transform[4]) {
    double same[4], inverse[4];
    const singular m = singular_of(transform);
    singular_matrix(&m, m.large, m.small, same, inverse);
    /* slopes go with M^-T: columns of K = M^-T root, Sigma = K K^T */
    const double first[2] = {inverse[0] * root[0] + inverse[2] * root[1],
                             inverse[1] * root[0] + inverse[3] * root[1]},
                 second[2] = {inverse[2] * root[2], inverse[3] * root[2]};
    return (mu_ibl_slopes){
        {inverse[0] * mean[0] + inverse[2] * mean[1], inverse[1] * mean[0] + inverse[3] * mean[1]},
        first[0] * first[0] + second[0] * second[0],
        first[0] * first[1] + second[0] * second[1],
        first[1] * first[1] + second[1] * second[1]};
}

double mu_ibl_tail_of(const mu_definition *d, double share) {
    const double own = d->ndf == MU_TABULATED ? -1 : square_of(d, SHARE);
    if (!(own > 0)) return 1;
    const double within = fmin(fmax(share, 1e-6), 1 - 1e-6); /* GGX's: share / (1 - share) of alpha², own is half that */
    return fmin(fmax(sqrt(square_of(d, within) / (2 * own) * ((1 - within) / within)), 1e-3), 1e3);
}

int mu_ibl_slopes_of(const mu_definition *d, mu_ibl_slopes *out) {
    double mean[2] = {0, 0}, root[3] = {0, 0, 0};
    if (d->ndf == MU_TABULATED) {
        matched_histogram(d, mean, root);
    } else {
        const double square = square_of(d, SHARE);
        if (square < 0) return 0;
        root[0] = root[2] = sqrt(square);
    }
    const double whole[2] = {d->tilt[0] + mean[0], d->tilt[1] + mean[1]};
    *out = under(whole, root, d->transform);
    return 1;
}

mu_ibl_slopes mu_ibl_slopes_under(const mu_ibl_slopes *s, const double transform[4]) {
    double root[3] = {sqrt(fmax(s->xx, 0)), 0, 0};
    root[1] = root[0] > 0 ? s->xy / root[0] : 0;
    root[2] = sqrt(fmax(s->yy - root[1] * root[1], 0));
    return under(s->mean, root, transform);
}

mu_ibl_slopes mu_ibl_slopes_mix(size_t count, const mu_ibl_slopes *parts, const double *shares) {
    double all = 0;
    mu_ibl_slopes mix = {{0, 0}, 0, 0, 0};
    for (size_t i = 0; i < count; i++) all += shares ? shares[i] : 1;
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 2; k++) mix.mean[k] += (shares ? shares[i] : 1) / all * parts[i].mean[k];
    for (size_t i = 0; i < count; i++) { /* about the mean of all: no difference of large squares */
        const double w = (shares ? shares[i] : 1) / all, x = parts[i].mean[0] - mix.mean[0],
                     y = parts[i].mean[1] - mix.mean[1];
        mix.xx += w * (parts[i].xx + x * x), mix.xy += w * (parts[i].xy + x * y);
        mix.yy += w * (parts[i].yy + y * y);
    }
    return mix;
}

#endif
