/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * stretch.c: logarithm and exponential of a 2x2 metric in closed form, and the axes of a deformation.
 *
 * With C = M^T M, p = tr C / 2, C - p = [d o; o -d], q = hypot(d, o), the eigenvalues are p +- q and
 *     log C = log(det C) / 2 + atanh(q / p) / q [d o; o -d],
 * where atanh(q / p) = log((p + q) / sqrt(det C)), which loses nothing where C is all but singular. Entries of M
 * should be within 1e+-150, for C is squares of them.
 */
#include "core/tension/stretch.h"

#include <math.h>

#include "core/bsdf/singular.h"

mu_stretch_log mu_stretch_log_of(const double m[4]) {
    const double xx = m[0] * m[0] + m[2] * m[2], yy = m[1] * m[1] + m[3] * m[3];
    const double o = m[0] * m[1] + m[2] * m[3], d = (xx - yy) / 2, p = (xx + yy) / 2, q = hypot(d, o);
    const double det = product_difference(m[0], m[3], m[1], m[2]), length = sqrt(xx);
    /* the first loses digits where q is near p, the second where q is small */
    const double spread = q < p / 2 ? atanh(q / p) : log((p + q) / det);
    const double scale = q > 0 ? spread / q / 2 : 0, mean = log(det) / 2;
    return (mu_stretch_log){mean + scale * d, scale * o, mean - scale * d, m[0] / length, m[2] / length};
}

void mu_stretch_matrix(const mu_stretch_log *log, double m[4]) {
    const double mean = (log->xx + log->yy) / 2, d = (log->xx - log->yy) / 2, o = log->xy, q = hypot(d, o);
    /* C = e^(2 mean) (cosh 2q + sinh(2q) / q [d o; o -d]); its corner xx without the difference of large numbers */
    const double sine = q > 0 ? d / q : 0, cosine = q > 0 ? o / q : 0;
    const double plus = sine < 0 ? cosine * cosine / (1 - sine) : 1 + sine;
    const double minus = sine > 0 ? cosine * cosine / (1 + sine) : 1 - sine;
    const double xx = q > 0 ? (exp(2 * q) * plus + exp(-2 * q) * minus) / 2 : 1;
    const double first =
        sqrt(xx); /* T / e^mean = [first, second / first; 0, 1 / first]: its determinant is 1 */
    const double second = sinh(2 * q) * cosine, size = exp(mean);
    const double t[3] = {size * first, size * second / first, size / first};
    const double length = hypot(log->turn_x, log->turn_y);
    const double cos_turn = length > 1e-6 ? log->turn_x / length : 1,
                 sin_turn = length > 1e-6 ? log->turn_y / length : 0;
    m[0] = cos_turn * t[0], m[1] = cos_turn * t[1] - sin_turn * t[2];
    m[2] = sin_turn * t[0], m[3] = sin_turn * t[1] + cos_turn * t[2];
}

static double half_turn(double angle) {
    const double pi = acos(-1.0), reduced = remainder(angle, pi);
    return reduced > -pi / 2 ? reduced : reduced + pi;
}

mu_stretch_axes mu_stretch_axes_of(const double m[4]) {
    const singular s = singular_of(m);
    return (mu_stretch_axes){.most = s.large,
                             .least = s.small,
                             .rest = half_turn(-(s.sum - s.difference) / 2),
                             .deformed = half_turn((s.sum + s.difference) / 2),
                             .rotation = s.sum,
                             .area = s.large * s.small};
}
