/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* check_plane.c: coordinates on the slope plane; see check_plane.h. */
#include "core/render/check_plane.h"

#include <math.h>
#include <stdlib.h>

#define HALF_PI 1.57079632679489661923

static void transform(const double a[4], const double in[2], double out[2]) {
    const double x = a[0] * in[0] + a[1] * in[1], y = a[2] * in[0] + a[3] * in[1];
    out[0] = x;
    out[1] = y;
}

static _Bool complete(mu_plane *plane) {
    const double *a = plane->to_slope;
    const double scale = fmax(fmax(fabs(a[0]), fabs(a[1])), fmax(fabs(a[2]), fabs(a[3])));
    const double b[4] = {a[0] / scale, a[1] / scale, a[2] / scale, a[3] / scale};
    const double determinant = fabs(fma(b[0], b[3], -b[1] * b[2]) + fma(-b[1], b[2], b[1] * b[2]));
    const double square = b[0] * b[0] + b[1] * b[1] + b[2] * b[2] + b[3] * b[3];
    /* (s1 + s2)^2 = |A|^2 + 2 det, (s1 - s2)^2 = |A|^2 - 2 det */
    const double largest = (sqrt(square + 2 * determinant) + sqrt(fmax(0, square - 2 * determinant))) / 2;
    plane->area = determinant * scale * scale;
    plane->condition = largest * largest / determinant;
    plane->narrowest = determinant / largest * scale;
    return isfinite(plane->condition) && plane->area > 0;
}

_Bool mu_plane_from_transform(mu_plane *plane, const double m[4], const double *tilt, double size,
                              double spread) {
    const double product = m[1] * m[2];
    const double determinant = fma(m[0], m[3], -product) + fma(-m[1], m[2], product);
    *plane = (mu_plane){.to_slope = {m[3] / determinant * size, -m[2] / determinant * size,
                                     -m[1] / determinant * size, m[0] / determinant * size},
                        .from_slope = {m[0] / size, m[2] / size, m[1] / size, m[3] / size},
                        .spread = spread};
    if (tilt) {
        plane->centre[0] = (m[3] * tilt[0] - m[2] * tilt[1]) / determinant;
        plane->centre[1] = (m[0] * tilt[1] - m[1] * tilt[0]) / determinant;
    }
    return determinant != 0 && complete(plane);
}

/* One step of Tyler's fixed point on s: a lower triangle L with s = L s', s' rounder than s. */
static _Bool rounder(const double *s, int count, double lower[3]) {
    double xx = 0, xy = 0, yy = 0;
    for (int i = 0; i < count; i++) {
        const double square = s[2 * i] * s[2 * i] + s[2 * i + 1] * s[2 * i + 1];
        if (!(square > 0)) continue;
        xx += s[2 * i] * s[2 * i] / square;
        xy += s[2 * i] * s[2 * i + 1] / square;
        yy += s[2 * i + 1] * s[2 * i + 1] / square;
    }
    lower[0] = sqrt(2 * xx / count);
    lower[1] = 2 * xy / count / lower[0];
    const double rest = 2 * yy / count - lower[1] * lower[1];
    lower[2] = sqrt(fmax(rest, 1e-14)); /* an almost flat step: the next ones widen it further */
    return lower[0] > 0 && isfinite(lower[1]);
}

static double median_radius(double *s, int count, double *far) {
    /* Radii by histogram of their logarithms: enough for a size. */
    int bins[4096] = {0}, seen = 0;
    double median = 1;
    *far = 1;
    for (int i = 0; i < count; i++) {
        const double t = log(hypot(s[2 * i], s[2 * i + 1])) * 16 + 2048;
        bins[t > 0 ? (t < 4095 ? (int)t : 4095) : 0]++;
    }
    for (int b = 0; b < 4096; b++) {
        if (2 * seen < count) median = exp((b - 2048 + .5) / 16);
        if (20 * seen < 19 * count) *far = exp((b - 2048 + .5) / 16);
        seen += bins[b];
    }
    return median;
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Of x (axis 0) or y (axis 1). */
static double median_of(const double *slopes, int count, int axis, double *scratch) {
    for (int i = 0; i < count; i++) scratch[i] = slopes[2 * i + axis];
    qsort(scratch, (size_t)count, sizeof *scratch, ascending);
    return scratch[count / 2];
}

/* s = B (p - centre), all of them */
static void pull_back(const double b[4], const double *slopes, int count, const double centre[2], double *s) {
    for (int i = 0; i < count; i++) {
        const double p[2] = {slopes[2 * i] - centre[0], slopes[2 * i + 1] - centre[1]};
        transform(b, p, s + 2 * i);
    }
}

/* Tyler's fixed point about `centre`. */
static _Bool shape_about(mu_plane *plane, const double *slopes, int count, const double centre[2],
                         double *s) {
    double b[4] = {1, 0, 0, 1}; /* s = B (p - centre) */
    for (int step = 0; step < 60; step++) {
        pull_back(b, slopes, count, centre, s);
        double l[3];
        if (!rounder(s, count, l)) return 0;
        for (int c = 0; c < 2; c++) { /* B := L^-1 B */
            b[c] /= l[0];
            b[2 + c] = (b[2 + c] - l[1] * b[c]) / l[2];
        }
    }
    pull_back(b, slopes, count, centre, s);
    double far;
    const double median = median_radius(s, count, &far);
    const double m[4] = {b[0], b[2], b[1], b[3]}; /* B = M^T */
    return mu_plane_from_transform(plane, m, NULL, median, fmax(0, log(far / median)));
}

_Bool mu_plane_from_slopes(mu_plane *plane, const double *slopes, int count, double *s) {
    double centre[2] = {0, 0};
    if (!shape_about(plane, slopes, count, centre, s)) return 0;
    for (int again = 0; again < 2; again++) { /* the middle is looked for where the distribution is round */
        double from[4], off[2];
        for (int i = 0; i < 4; i++) from[i] = plane->from_slope[i];
        pull_back(from, slopes, count, centre, s);
        double *sorted = malloc((size_t)count * sizeof *sorted);
        if (!sorted) return 0;
        off[0] = median_of(s, count, 0, sorted), off[1] = median_of(s, count, 1, sorted);
        free(sorted);
        if (!(hypot(off[0], off[1]) > 0.2)) break; /* no more than sampling noise */
        double moved[2];
        transform(plane->to_slope, off, moved);
        centre[0] += moved[0], centre[1] += moved[1];
        if (!shape_about(plane, slopes, count, centre, s)) return 0;
    }
    plane->centre[0] = centre[0], plane->centre[1] = centre[1];
    return 1;
}

/* Positive where slope p reflects v upwards. */
static double inside_disc(const double v[3], const double p[2]) {
    return v[2] - v[2] * (p[0] * p[0] + p[1] * p[1]) - 2 * (v[0] * p[0] + v[1] * p[1]);
}

/* 1/r at the region's edge in direction psi. Ends of the plane and of the region are joined smoothly: where
 * they meet, the strip that is lost lies e^-30 beyond everything. */
static double edge(const mu_region *region, double psi) {
    const double u = cos(psi);
    if (region->kind == MU_VISIBLE_SLOPES) return region->far + fmax(0, u) * region->slant;
    if (region->kind == MU_WHOLE_PLANE) return region->far;
    /* v reflects upwards where v_z |p|^2 + 2 v_xy . p - v_z < 0: a disc around -v_xy/v_z; on the ray p = q + r e from
     * the origin q, where the left side is -d < 0: 1/r = b + sqrt(b^2 + v_z |e|^2 / d), b = (v_xy + v_z q) . e / d. */
    const double s[2] = {region->axis[0] * u - region->axis[1] * sin(psi),
                         region->axis[1] * u + region->axis[0] * sin(psi)};
    double e[2];
    transform(region->plane->to_slope, s, e);
    const double *v = region->view, *q = region->origin, d = inside_disc(v, q);
    const double b = ((v[0] + v[2] * q[0]) * e[0] + (v[1] + v[2] * q[1]) * e[1]) / d;
    const double square = v[2] * (e[0] * e[0] + e[1] * e[1]) / d, root = sqrt(b * b + square);
    return region->far + (b > 0 ? b + root : square / (root - b));
}

mu_region mu_region_make(const mu_plane *plane, mu_region_kind kind, const double view[3]) {
    const double *a = plane->to_slope;
    mu_region region = {.plane = plane, .kind = kind, .view = {view[0], view[1], view[2]}, .axis = {1, 0}};
    const double *c = plane->centre, seen = view[2] - view[0] * c[0] - view[1] * c[1];
    const _Bool inside = kind == MU_WHOLE_PLANE      ? 1
                         : kind == MU_VISIBLE_SLOPES ? seen > 0
                                                     : inside_disc(view, c) > 0;
    if (inside) region.origin[0] = c[0], region.origin[1] = c[1];
    region.height = inside && kind != MU_WHOLE_PLANE ? seen : view[2];
    const double kx = (a[0] * view[0] + a[2] * view[1]) / region.height,
                 ky = (a[1] * view[0] + a[3] * view[1]) / region.height;
    region.slant = hypot(kx, ky);
    if (region.slant > 0) {
        region.axis[0] = kx / region.slant;
        region.axis[1] = ky / region.slant;
    }
    region.far = exp(-30 - plane->spread);
    double nearest = 0;
    for (int i = 0; i < 64; i++) nearest = fmax(nearest, edge(&region, HALF_PI * i / 16));
    region.low = fmin(-16, -log(nearest) - 25);
    return region;
}

/* y in [0,1] to the half turn around the axis, [1,2] to the other one, slower towards the ends of each, where
 * the edge of the visible slopes runs off to infinity. */
static double turn(double y, double *derivative) {
    const double half = y < 1 ? 0 : 2, z = 2 * (y < 1 ? y : y - 1) - 1;
    *derivative = HALF_PI * 3 * (1 - z) * (1 + z);
    return HALF_PI * (half + z * (3 - z * z) / 2);
}

double mu_region_point(const mu_region *region, double x, double y, double m[3]) {
    double dpsi;
    const double psi = turn(y, &dpsi), high = -log(edge(region, psi));
    const double t = region->low + x * (high - region->low), r = exp(t);
    const double c = cos(psi), s = sin(psi), *axis = region->axis;
    const double at[2] = {r * (axis[0] * c - axis[1] * s), r * (axis[1] * c + axis[0] * s)};
    double p[2];
    transform(region->plane->to_slope, at, p);
    p[0] += region->origin[0], p[1] += region->origin[1];
    m[2] = 1 / sqrt(1 + p[0] * p[0] + p[1] * p[1]);
    m[0] = -p[0] * m[2];
    m[1] = -p[1] * m[2];
    return region->plane->area * r * r * (high - region->low) * dpsi;
}

_Bool mu_region_locate(const mu_region *region, const double m[3], double *x, double *y) {
    if (!(m[2] > 0)) return 0;
    const double p[2] = {-m[0] / m[2] - region->origin[0], -m[1] / m[2] - region->origin[1]};
    double s[2];
    transform(region->plane->from_slope, p, s);
    const double along = s[0] * region->axis[0] + s[1] * region->axis[1];
    const double aside = s[1] * region->axis[0] - s[0] * region->axis[1];
    double psi = atan2(aside, along);
    const _Bool ahead = fabs(psi) <= HALF_PI;
    const double g = (ahead ? psi : psi > 0 ? psi - 2 * HALF_PI : psi + 2 * HALF_PI) / HALF_PI;
    const double z = 2 * sin(asin(fmax(-1, fmin(1, g))) / 3); /* z (3 - z^2) / 2 = g */
    *y = (1 + z) / 2 + (ahead ? 0 : 1);
    const double t = log(hypot(along, aside)), high = -log(edge(region, psi));
    *x = (t - region->low) / (high - region->low);
    if (*x < 0) *x = 0;
    return *x <= 1;
}
