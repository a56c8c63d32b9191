/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * linear_map.c: preparing M, in double whatever the precision of shading: it is done once per hit at most.
 *
 * With M = 2^e M' (entries of M' at most 1), s the slope unit and delta = sqrt(|det M|) / s:
 *   normals     M^T m / s times delta^(-1/2), so that D_M(m) = D(u): see linear_map.h;
 *   directions  s M^-1 v = adj(M') v / (delta |det M'|^(1/2)) times sign(det), and times view_z, a power of
 * two that brings the entries near 1. An explicit inverse is never formed.
 */
#include "core/bsdf/linear_map.h"

#include "core/bsdf/singular.h"
#include <stdint.h>
#include <string.h>

/* Beyond these delta, D at its peak (or beside it) is no number of this precision any more: it saturates. */
#if MU_REAL_BITS == 24
#define DELTA_MAX 0x1p100
#define VIEW_MAX  0x1p60
#else
#define DELTA_MAX 0x1p500
#define VIEW_MAX  0x1p400
#endif

/* frexp and ldexp without their calls, which would be half of this file's time. `x` is positive and finite;
 * `e` from -1022 to 1023. */
static int exponent_of(double x) {
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    int e = (int)(bits >> 52) - 1022;
    if (x < DBL_MIN) (void)frexp(x, &e);
    return e;
}
static double power_of_two(int e) {
    const uint64_t bits = (uint64_t)(e + 1023) << 52;
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}
/* Exact but for a result that is subnormal; 0 or infinite beyond. */
static double scaled(double x, int e) {
    return x * power_of_two(e / 2) * power_of_two(e - e / 2);
}

static double clamp(double x, double low, double high) {
    return x < low ? low : x > high ? high : x;
}

/* M' and its signed determinant; 0 if M is not finite, or singular. */
static double reduce(const double m[4], double reduced[4], int *exponent) {
    double largest = 0;
    for (int i = 0; i < 4; i++) largest = fabs(m[i]) > largest ? fabs(m[i]) : largest;
    if (!(largest > 0 && largest <= DBL_MAX) || isnan(m[0] + m[1] + m[2] + m[3])) return 0;
    *exponent = exponent_of(largest);
    for (int i = 0; i < 4; i++) reduced[i] = scaled(m[i], -*exponent);
    const double det = product_difference(reduced[0], reduced[3], reduced[1], reduced[2]);
    return fabs(det) < 1e-30 ? 0 : det;
}

#if MU_REAL_BITS == 53
double mu_transform_determinant(const double transform[4]) {
    double reduced[4];
    int exponent = 0;
    const double det = reduce(transform, reduced, &exponent);
    return det == 0 ? 0 : fmin(fmax(ldexp(fabs(det), 2 * exponent), DBL_MIN), DBL_MAX);
}

int mu_transform_is_similarity(const double m[4]) {
    return (m[0] == m[3] && m[1] == -m[2]) || (m[0] == -m[3] && m[1] == m[2]);
}
#endif

int MU(map_make)(map *out, const double m[4], const double tilt[2], double unit) {
    double r[4];
    int exponent = 0;
    const double det = reduce(m, r, &exponent);
    if (det == 0) return 0;
    const double root = sqrt(fabs(det));
    const double delta = clamp(scaled(root / unit, exponent), 1 / DELTA_MAX, DELTA_MAX);

    const double root_delta = sqrt(delta), normal = root_delta / root;
    const double dropped = MUTANT(1, sqrt(delta * unit), 1); /* u too long by |det M|^(1/4) */
    const double b = MUTANT(7, r[1], r[2]), c = MUTANT(7, r[2], r[1]);
    out->normal[0] = R(r[0] * normal * dropped); /* M^T: rows [a b], [c d] */
    out->normal[1] = R(b * normal * dropped);
    out->normal[2] = R(c * normal * dropped);
    out->normal[3] = R(r[3] * normal * dropped);
    out->normal_z = R(dropped / root_delta);

    const double shrink = delta * root;
    const double scale = power_of_two(exponent_of(clamp(shrink, 1 / VIEW_MAX, VIEW_MAX)));
    const double view = scale / shrink * (det < 0 ? -1 : 1);
    out->view[0] = R(MUTANT(2, r[0], r[3]) * view); /* adj M: rows [d -c], [-b a] */
    out->view[1] = R(MUTANT(2, r[1], -r[1]) * view);
    out->view[2] = R(MUTANT(2, r[2], -r[2]) * view);
    out->view[3] = R(MUTANT(2, r[3], r[0]) * view);
    out->view_z = R(scale);
    for (int i = 0; i < 2; i++) out->tilt[i] = R(MUTANT(10, -tilt[i], tilt[i]) / unit);
    return 1;
}

int MU(map_widen)(map *m, double base, double alpha) {
    /* V = base s M^-1: its singular values are the slope roughnesses */
    const double z = (double)m->view_z / base;
    const double rows[4] = {(double)m->view[0] / z, (double)m->view[1] / z, (double)m->view[2] / z,
                            (double)m->view[3] / z};
    const singular v = singular_of(rows);
    if (fabs(v.small) >= alpha) return 0;
    double wider[4], inverse[4];
    singular_matrix(&v, fmax(v.large, alpha), copysign(alpha, v.small), wider, inverse);
    /* the tilt acts before M: t V has to stay as M changes to V'^-1 */
    const double t[2] = {(double)m->tilt[0], (double)m->tilt[1]},
                 mean[2] = {(t[0] * rows[0] + t[1] * rows[2]) / base,
                            (t[0] * rows[1] + t[1] * rows[3]) / base};
    const double tilt[2] = {mean[0] * inverse[0] + mean[1] * inverse[2],
                            mean[0] * inverse[1] + mean[1] * inverse[3]};
    return MU(map_make)(m, inverse, tilt, 1);
}

/* V = sqrt(2) L^T s M^-1 in place of s M^-1; the tilt is measured against it. */
void MU(map_stand_for)(map *m, const double root[3]) {
    const double x = sqrt(2) * root[0], y = sqrt(2) * root[1], z = sqrt(2) * root[2];
    for (int i = 0; i < 2; i++) {
        const double first = (double)m->view[i], second = (double)m->view[2 + i];
        m->view[i] = R(x * first + y * second);
        m->view[2 + i] = R(z * second);
    }
    const double tilt = (double)m->tilt[0] / x;
    m->tilt[1] = R(((double)m->tilt[1] - y * tilt) / z);
    m->tilt[0] = R(tilt);
}
