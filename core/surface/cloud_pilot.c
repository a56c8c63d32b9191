/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* cloud_pilot.c: where the slopes lie, from a sample of them; and how far their steepness is correlated. */
#include <math.h>
#include <stdlib.h>

#include "core/surface/cloud.h"

/* Facets spread evenly over the surface: the k-th of `count`, by a Weyl sequence over rows and columns. */
static void facet_of(const mu_slopes *s, uint32_t k, double out[2]) {
    const uint32_t side = mu_slopes_side(s);
    const double x = fmod(0.5 + k * 0.75487766624669276005, 1), y = fmod(0.5 + k * 0.56984029099805326591, 1);
    mu_slope_at(s, (uint32_t)(x * side), (uint32_t)(y * side), (int)(k & 1), out);
}

static int rising(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The symmetric root of [xx xy; xy yy]; false if it is singular to within rounding. */
static _Bool root_of(const double c[3], double out[4]) {
    const double det = c[0] * c[2] - c[1] * c[1], trace = c[0] + c[2];
    if (!(trace > 0 && det > 1e-20 * trace * trace)) return 0;
    const double r = sqrt(det), by = sqrt(trace + 2 * r);
    out[0] = (c[0] + r) / by;
    out[1] = out[2] = c[1] / by;
    out[3] = (c[2] + r) / by;
    return 1;
}

/* Bivariate Student-t of 2 degrees of freedom by iterated weights 4/(2 + d^2), d^2 the Mahalanobis distance: its
 * P22 = (1 + d^2/2)^-2 / 2 pi sqrt(det C) is GGX of A A^T = 2 C. */
static _Bool student(const double *sample, uint32_t count, double centre[2], double c[3]) {
    for (int pass = 0; pass < 60; pass++) {
        double sum[6] = {0};
        const double det = c[0] * c[2] - c[1] * c[1];
        if (!(det > 1e-20 * (c[0] + c[2]) * (c[0] + c[2]))) return 0;
        for (uint32_t k = 0; k < count; k++) {
            const double x = sample[2 * k] - centre[0], y = sample[2 * k + 1] - centre[1];
            const double d2 = (c[2] * x * x - 2 * c[1] * x * y + c[0] * y * y) / det, w = 4 / (2 + d2);
            sum[0] += w, sum[1] += w * x, sum[2] += w * y;
            sum[3] += w * x * x, sum[4] += w * x * y, sum[5] += w * y * y;
        }
        centre[0] += sum[1] / sum[0], centre[1] += sum[2] / sum[0];
        for (int k = 0; k < 3; k++) c[k] = sum[3 + k] / count;
    }
    return 1;
}

/* Quartiles: a start that no tail moves. */
static void start(const double *sample, uint32_t count, double *room, double centre[2], double c[3]) {
    for (int axis = 0; axis < 2; axis++) {
        for (uint32_t k = 0; k < count; k++) room[k] = sample[2 * k + (uint32_t)axis];
        qsort(room, count, sizeof *room, rising);
        const double half = (room[count - 1 - count / 8] - room[count / 8]) / 2;
        centre[axis] = room[count / 2];
        c[2 * axis] = half * half;
    }
    c[1] = 0;
}

static double distance(const mu_cloud *cloud, const double s[2]) {
    const double *m = cloud->shape, det = m[0] * m[3] - m[1] * m[2];
    const double x = s[0] - cloud->centre[0], y = s[1] - cloud->centre[1];
    return hypot((m[3] * x - m[1] * y) / det, (m[0] * y - m[2] * x) / det);
}

/* Of the bounded measure 1/(1 + v^2), between L facets `lag` cells apart along both axes. */
static double correlation_at(const mu_cloud *cloud, const mu_slopes *s, uint32_t lag) {
    const uint32_t side = mu_slopes_side(s), count = 4096;
    double sum[5] = {0};
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t i = (uint32_t)(fmod(0.5 + k * 0.75487766624669276005, 1) * (side - lag)),
                       j = (uint32_t)(fmod(0.5 + k * 0.56984029099805326591, 1) * (side - lag));
        double a[2], b[2];
        mu_slope_at(s, i, j, MU_LOWER, a);
        mu_slope_at(s, k & 1 ? i + lag : i, k & 1 ? j : j + lag, MU_LOWER, b);
        const double p = distance(cloud, a), q = distance(cloud, b), x = 1 / (1 + p * p), y = 1 / (1 + q * q);
        sum[0] += x, sum[1] += y, sum[2] += x * x, sum[3] += y * y, sum[4] += x * y;
    }
    const double n = count, cov = sum[4] / n - sum[0] / n * (sum[1] / n);
    const double vx = sum[2] / n - sum[0] / n * (sum[0] / n), vy = sum[3] / n - sum[1] / n * (sum[1] / n);
    return vx > 0 && vy > 0 ? cov / sqrt(vx * vy) : 0;
}

static double correlation_length(const mu_cloud *cloud, const mu_slopes *s) {
    const uint32_t side = mu_slopes_side(s);
    double before = 1;
    uint32_t last = 0;
    for (uint32_t lag = 1; lag <= side / 2; lag += lag < 16 ? 1 : lag / 8) {
        const double now = correlation_at(cloud, s, lag);
        if (now < exp(-1)) return last + (lag - last) * (before - exp(-1)) / (before - now);
        before = now, last = lag;
    }
    return side;
}

uint32_t mu_cloud_sample(const mu_slopes *s, double *sample) {
    const uint64_t facets = 2 * (uint64_t)mu_slopes_side(s) * mu_slopes_side(s);
    const uint32_t count = facets < MU_SAMPLE ? (uint32_t)facets : MU_SAMPLE;
    for (uint32_t k = 0; k < count; k++) facet_of(s, k, sample + 2 * (size_t)k);
    return count;
}

_Bool mu_cloud_pilot(mu_cloud *cloud, const mu_slopes *s, double keep, const double *sample, uint32_t count) {
    double c[3], *room = malloc(count * sizeof *room);
    if (!room) return 0;
    start(sample, count, room, cloud->centre, c);
    _Bool good = student(sample, count, cloud->centre, c);
    for (int k = 0; k < 3; k++) c[k] *= 2;
    good = good && root_of(c, cloud->shape);
    if (good) {
        for (uint32_t k = 0; k < count; k++) room[k] = distance(cloud, sample + 2 * (size_t)k);
        qsort(room, count, sizeof *room, rising);
        const double place = keep * count;
        cloud->edge = place < count ? room[(uint32_t)place] : 2 * room[count - 1];
        cloud->correlation = correlation_length(cloud, s);
    }
    free(room);
    return good;
}
