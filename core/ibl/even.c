/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * even.c: see even.h. Not in the papers.
 *
 * With q = m.xy / m.z of the micronormal, light's solid angle is 4 (wo.m) m.z³ dq: smooth in q whatever the view. What is
 * reflected upwards is a disk, z |q|² - 2 wo.q - z < 0, at whose edge f cos is 0. Rays leave the lobe's mean, in all azimuths of
 * the plane in which the lobe is round, or the disk where that is the smaller, and end at the edge: u[1] is the azimuth, u[0] goes
 * along the ray. Length is asinh of 1, linear within the lobe and logarithmic in its tail; half of the points lie within
 * HALF of it, the more the farther out the closer to the lobe (a Möbius map). So the integrand is smooth, periodic in the
 * azimuth, and 0 at both ends of a ray, for long tails and short ones.
 *
 * Where the mean is itself no micronormal that reflects upwards, as of a tilt that faces away, rays leave from the place of the
 * disk that is nearest, with the lobe's axes as unit; a little inside, lest some have no length.
 *
 * Lattices of Fibonacci numbers of points, the one after the other: errors fall by more than 2 from each to the next (those of
 * 144 points are some 1e-3), so that three steps of which the first is below 8 `enough`, the second below 4 and the third below 2
 * leave `enough`: of two, both are small by chance once in a few hundred views of a narrow tilt.
 */
#include "core/ibl/even.h"

#include <math.h>

#if MU_REAL_BITS == 53

#define TWO_PI 6.28318530717958647692
enum { FIRST = 55, STEPS = 3 };
#define HALF   1.5
#define INSIDE 1.1
/* Smaller ones are mirrors, in any number of digits. */
#define LEAST_ROUGHNESS 1e-12

static double beyond(const double wo[3], const double q[2]) {
    return wo[2] * (q[0] * q[0] + q[1] * q[1]) - 2 * (wo[0] * q[0] + wo[1] * q[1]) - wo[2];
}

/* Where the gradient of the distance squared is l times that of `beyond`. */
static void toward_disk(const double wo[3], const double mean[2], const double spread[2], double l, double q[2]) {
    for (int k = 0; k < 2; k++) {
        const double s2 = spread[k] * spread[k];
        q[k] = (mean[k] + l * s2 * wo[k]) / (1 + l * s2 * wo[2]);
    }
}

static void place_centre(mu_ibl_even *e, const double mean[2]) {
    double low = -200, high = 200; /* ln l: the disk's own middle is at infinity */
    e->centre[0] = mean[0], e->centre[1] = mean[1];
    if (beyond(e->wo, mean) < 0) return;
    while (high - low > 1e-6) {
        const double middle = (low + high) / 2;
        toward_disk(e->wo, mean, e->spread, exp(middle), e->centre);
        *(beyond(e->wo, e->centre) > 0 ? &low : &high) = middle;
    }
    toward_disk(e->wo, mean, e->spread, INSIDE * exp(high), e->centre);
}

void mu_ibl_even_make(const mu_ibl_lobe_d *lobe, const double wo[3], mu_ibl_even *e) {
    const double *t = lobe->turn, *m = lobe->mean;
    *e = (mu_ibl_even){.wo = {t[0] * wo[0] + t[1] * wo[1], t[0] * wo[1] - t[1] * wo[0], wo[2]}, .turn = {t[0], t[1]}};
    double along[2], reach[2], rough[2];
    for (int k = 0; k < 2; k++) {
        rough[k] = fmax(sqrt(2) * lobe->sigma[k], LEAST_ROUGHNESS);
        along[k] = fabs(e->wo[k]) / wo[2];
        reach[k] = fmin(rough[k], 1 + 2 * along[k]);
    }
    /* at most how far the disk of middle (a, b) reaches from 0 along an axis, where that is r away: a + sqrt(a² + 1 + 2 b r) */
    for (int k = 0; k < 2; k++)
        e->spread[k] = fmin(rough[k], 1 + 2 * along[k] + sqrt(2 * reach[!k] * along[!k]));
    const double mean[2] = {-(t[0] * m[0] + t[1] * m[1]), -(t[0] * m[1] - t[1] * m[0])};
    place_centre(e, mean);
}

/* wo mirrored at q, and 4 (wo.m) m.z³; 0: not upwards. */
static double mirrored(const double wo[3], const double q[2], double wi[3]) {
    const double square = 1 + q[0] * q[0] + q[1] * q[1], seen = wo[0] * q[0] + wo[1] * q[1] + wo[2];
    if (!(seen > 0)) return 0;
    const double twice = 2 * seen / square;
    for (int k = 0; k < 3; k++) wi[k] = twice * (k < 2 ? q[k] : 1) - wo[k];
    return wi[2] > 0 ? 4 * seen / (square * square) : 0;
}

/* asinh of what is not negative: of what is small, no digits are lost in the logarithm. */
static double length_of(double end) {
    return end < 1e-3 ? end - end * end * end / 6 : log(end + sqrt(end * end + 1));
}

double mu_ibl_even_direction(const mu_ibl_even *e, const double u[2], double wi[3]) {
    return mu_ibl_even_along(e, u[0], (const double[2]){cos(TWO_PI * u[1]), sin(TWO_PI * u[1])}, wi);
}

double mu_ibl_even_along(const mu_ibl_even *e, double u, const double ray[2], double wi[3]) {
    const double by[2] = {e->spread[0] * ray[0], e->spread[1] * ray[1]}, *at = e->centre, z = e->wo[2];
    const double a = z * (by[0] * by[0] + by[1] * by[1]), c = beyond(e->wo, at),
                 b = z * (at[0] * by[0] + at[1] * by[1]) - (e->wo[0] * by[0] + e->wo[1] * by[1]);
    const double root = sqrt(fmax(b * b - a * c, 0)), end = b < 0 ? (root - b) / a : -c / (b + root);
    if (!(end > 0)) return 0;
    const double length = length_of(end), pull = fmax(length / HALF - 2, 0), part = 1 / (1 + pull * (1 - u));
    const double e1 = exp(length * u * part), e2 = 1 / e1, r = (e1 - e2) / 2;
    const double stretch = (e1 + e2) / 2 * length * (1 + pull) * (part * part); /* dr / du */
    const double q[2] = {at[0] + r * by[0], at[1] + r * by[1]};
    double w[3];
    const double angle = mirrored(e->wo, q, w);
    if (!(angle > 0)) return 0;
    wi[0] = e->turn[0] * w[0] - e->turn[1] * w[1], wi[1] = e->turn[1] * w[0] + e->turn[0] * w[1], wi[2] = w[2];
    return TWO_PI * e->spread[0] * e->spread[1] * r * stretch * angle;
}

void mu_ibl_even_by(const mu_ibl_even *even, mu_ibl_fibonacci lattice, const double shift[2], mu_ibl_toward toward, void *context, double mean[EVEN_PARTS]) {
    const double turn = TWO_PI * lattice.before / lattice.count, step[2] = {cos(turn), sin(turn)};
    double ray[2] = {cos(TWO_PI * shift[1]), sin(TWO_PI * shift[1])};
    for (int k = 0; k < EVEN_PARTS; k++) mean[k] = 0;
    for (uint32_t i = 0; i < lattice.count; i++) {
        double u[2], wi[3], value[EVEN_PARTS] = {0};
        mu_ibl_fibonacci_at(lattice, shift, i, u);
        const double weight = mu_ibl_even_along(even, u[0], ray, wi) / lattice.count, next = step[0] * ray[0] - step[1] * ray[1];
        ray[1] = step[1] * ray[0] + step[0] * ray[1], ray[0] = next;
        if (!(weight > 0)) continue;
        toward(context, wi, value);
        for (int k = 0; k < EVEN_PARTS; k++) mean[k] += weight * value[k];
    }
}

double mu_ibl_even_mean(const mu_ibl_even *even, mu_ibl_toward toward, void *context, double enough, size_t most, double mean[EVEN_PARTS]) {
    static const double still[2] = {0, 0};
    mu_ibl_fibonacci lattice = mu_ibl_fibonacci_below(FIRST);
    double steps[STEPS] = {INFINITY, INFINITY, INFINITY}, next[EVEN_PARTS]; /* the last ones */
    for (size_t calls = 0;; lattice = (mu_ibl_fibonacci){lattice.count, lattice.before + lattice.count}) {
        mu_ibl_even_by(even, lattice, still, toward, context, next);
        double step = calls ? 0 : INFINITY;
        for (int k = 0; k < EVEN_PARTS; k++) {
            if (calls) step = fmax(step, fabs(next[k] - mean[k]));
            mean[k] = next[k];
        }
        steps[2] = steps[1], steps[1] = steps[0], steps[0] = step;
        const double error = fmax(fmax(steps[0] / 2, steps[1] / 4), steps[2] / 8);
        calls += lattice.count;
        if (error <= enough || calls + lattice.before + lattice.count > most) return error;
    }
}

#endif
