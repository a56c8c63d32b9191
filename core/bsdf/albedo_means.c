/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_means.c: averages of what is lost, over all M of the point: what a lobe needs besides the albedos of both directions, which
 * are integrated (albedo_open.c). Not in the papers.
 *
 * A turn of the world changes no average. So with L L^T the second moments of slopes about 0, in slope units, they depend on
 *     L^T V = Q diag(a, b) R,   V = s M^-1,
 * through a >= b, of which world slopes have the root mean squares along the axes, and the angle of Q, which says what slopes are spread along a:
 * of what is level and isotropic not even through that. Slopes L^-1 p have the second moments 1, however far the mean is from 0, or
 * steep a histogram: nothing is narrow in the angle. It is that of a line, to pi; where the mean is all that tells azimuths apart, they
 * are mirrored at it. Where a = b it does not matter.
 *
 * Nodes: log2 a = middle + wide sinh x, x at even steps, for all that happens happens about slopes of 1; ln(a/b) to 8
 * halvings below the lesser of a and 1, where b is 0, denser toward a = b. Polynomials of third degree through four nodes along both.
 * What is lost grows with the mean slope in the world, which has a cusp where it lies along the smoother axis, and with k a^p: averages are told as
 * parts of both, k and p measured. From there on it changes as the sine of the angle grows to b/a, and to k a^(p-1): it is told by
 * asinh(sine / hypot(b/a, k a^(p-1))), in a polynomial through Chebyshev's nodes, of either sign if these are not mirrored. Below
 * the first node averages go on by their power of a, and beyond the last as they are. ln of averages; how many that takes, and what is
 * off, is measured by tests/bench_compensation.c.
 */
#include "core/bsdf/albedo_maker.h"
#include "core/bsdf/albedo_set.h"
#include "core/bsdf/distribution.h"
#include "core/bsdf/singular.h"

#if MU_REAL_BITS == 24

enum { SHAPES = ALBEDO_MEANS_SHAPES, NODES = 4, KINDS = ALBEDO_MEANS_KINDS };
static const double first = -2.3, last = 2.3; /* x */
static const double smooth = 8, soft = 2;     /* halvings of b; log2 a within which 1 takes over from a */

static double rough_at(const albedo_means *m, double x) {
    return m->middle + m->wide * sinh(x);
}
/* log2(a/b) at most. */
static double shapes_to(double rough) {
    return smooth + (rough + hypot(rough, soft)) / 2;
}

/* t of which t + t^3 is 2 x (Cardano). */
static double shape_at(double x) {
    const double root = sqrt(x * x + 1.0 / 27);
    return cbrt(root + x) - cbrt(root - x);
}

/* Of n > 1 nodes, as from_cusp tells angles. */
static double angle_at(int n, int j) {
    return (1 - cos(PI * j / (n - 1))) / 2;
}
/* Of either sign of the angle; 0 and the last are of both. */
static int nodes_of(const albedo_means *m) {
    return m->even ? m->angles : m->angles / 2 + 1;
}
/* The sine of an angle from where the mean slope lies along the smoother axis, from 0 to 1; and back. */
static double cusp(const albedo_means *m, double a, double b) {
    return m->mean[0] != 0 || m->mean[1] != 0
               ? fmin(fmax(hypot(b / a, m->spread * pow(a, m->power - 1)), 1e-12), 1)
               : 1;
}
static double from_cusp(double sine, double cusp) {
    return asinh(sine / cusp) / asinh(1 / cusp);
}
static double to_sine(double t, double cusp) {
    return fmin(cusp * sinh(t * asinh(1 / cusp)), 1);
}

/* Third degree through four nodes of n. Returns the first. */
static int stencil(double t, int n, double weight[NODES]) {
    int i = (int)floor(t) - 1;
    if (i > n - NODES) i = n - NODES;
    if (i < 0) i = 0;
    const double x = t - i - 1;
    weight[0] = -x * (x - 1) * (x - 2) / 6, weight[1] = (x + 1) * (x - 1) * (x - 2) / 2;
    weight[2] = -(x + 1) * x * (x - 2) / 2, weight[3] = (x + 1) * x * (x - 1) / 6;
    return i;
}

/* Between angles: the polynomial through Chebyshev's nodes of that sign, barycentric (Berrut & Trefethen 2004). */
static void weigh_angles(const albedo_means *m, double at, double weight[ALBEDO_MEANS_ANGLES]) {
    const int n = nodes_of(m);
    double sum = 0;
    for (int k = 0; k < m->angles; k++) weight[k] = m->angles == 1;
    for (int turn = 0; turn < 2 && n > 1; turn++)
        for (int j = 0; j < n; j++) {
            const double off = fabs(at) - angle_at(n, j);
            const double w =
                (j % 2 ? -1 : 1) * (j == 0 || j == n - 1 ? 0.5 : 1) / (fabs(off) > 1e-9 ? off : 1e-9);
            if (turn)
                weight[at < 0 && j > 0 && j < n - 1 ? n + j - 1 : j] = w / sum;
            else
                sum += w;
        }
}

/* Sums over angles and shapes at a roughness. */
static void sum_rough(const albedo_means *m, int rough, int shape, const double by_shape[NODES],
                      const double by_angle[ALBEDO_MEANS_ANGLES], double sums[KINDS]) {
    for (int kind = 0; kind < KINDS; kind++) sums[kind] = 0;
    for (int j = 0; j < NODES; j++)
        for (int k = 0; k < m->angles; k++) {
            const float *const v = m->value + albedo_means_node(m, rough, shape + j, k);
            for (int kind = 0; kind < KINDS; kind++)
                sums[kind] += by_shape[j] * by_angle[k] * (double)v[kind];
        }
}

static void look_up(const albedo_means *m, double log_a, double log_ratio, double angle, double out[KINDS]) {
    const double step = (last - first) / (m->rows - 1), x = asinh((log_a - m->middle) / m->wide),
                 t = fmin(fmax((x - first) / step, 0), m->rows - 1), below = log_a - rough_at(m, first);
    const double rough = fmin(fmax(log_a, rough_at(m, first)), rough_at(m, last)),
                 s = shape_at(fmin(log_ratio / shapes_to(rough), 1)) * (SHAPES - 1);
    double by_rough[NODES], by_shape[NODES], by_angle[ALBEDO_MEANS_ANGLES], sums[KINDS];
    const int i = stencil(t, m->rows, by_rough), j = stencil(s, SHAPES, by_shape);
    weigh_angles(m, angle, by_angle);
    for (int kind = 0; kind < KINDS; kind++) out[kind] = 0;
    for (int n = 0; n < NODES; n++) {
        sum_rough(m, i + n, j, by_shape, by_angle, sums);
        for (int kind = 0; kind < KINDS; kind++) out[kind] += by_rough[n] * sums[kind];
    }
    if (!(below < 0)) return;
    double next[KINDS];
    sum_rough(m, 0, j, by_shape, by_angle, sums), sum_rough(m, 1, j, by_shape, by_angle, next);
    for (int kind = 0; kind < 2; kind++)
        out[kind] += below * (next[kind] - sums[kind]) / (rough_at(m, first + step) - rough_at(m, first));
}

/* L^T V. */
static void spread(const albedo_means *m, const double v[4], double out[4]) {
    for (int i = 0; i < 2; i++)
        out[i] = m->root[0] * v[i] + m->root[1] * v[2 + i], out[2 + i] = m->root[2] * v[2 + i];
}

void mu_albedo_means_aim(const albedo_means *m, const albedo_open *open, const double v[4], mu_lobe *out) {
    double wide[4];
    spread(m, v, wide);
    mu_albedo_lay(wide, &out->frame);
    out->count = 0, out->open = out->moved = 1;
    /* V = R(left) diag R(right): M = R(-right) s diag^-1 R(-left) */
    const singular s = singular_of(v);
    const double left = (s.sum + s.difference) / 2, right = (s.sum - s.difference) / 2,
                 x = open->source.surface->unit / s.large, y = open->source.surface->unit / s.small;
    out->turn[0] = (float)cos(right), out->turn[1] = (float)-sin(right);
    out->transform[0] = (float)(x * cos(left)), out->transform[1] = (float)(x * sin(left));
    out->transform[2] = (float)(-y * sin(left)), out->transform[3] = (float)(y * cos(left));
}

void mu_albedo_means_choose(const albedo_means *m, const albedo_open *open, const double v[4], mu_lobe *out) {
    double wide[4], mean[KINDS];
    mu_albedo_means_aim(m, open, v, out);
    spread(m, v, wide);
    const singular s = singular_of(wide);
    const double about = mu_albedo_means_about(m, v);
    const double off = remainder((s.sum + s.difference) / 2 - m->axis - PI / 2, PI),
                 at = from_cusp(fabs(sin(off)), cusp(m, s.large, fabs(s.small)));
    look_up(m, log2(s.large), log2(s.large / fabs(s.small)), off < 0 && !m->even ? -at : at, mean);
    /* what is lost is above 0 everywhere */
    for (int side = 0; side < 2; side++)
        out->average[side] = fminf((float)(about * exp(mean[side])) + ALBEDO_LEAST, 1);
    out->passes[0] = fminf(fmaxf((float)mean[2], 0), 1);
}

double mu_albedo_means_about(const albedo_means *m, const double v[4]) {
    double wide[4];
    spread(m, v, wide);
    const double a = singular_of(wide).large,
                 q = hypot(v[0] * m->mean[0] + v[2] * m->mean[1], v[1] * m->mean[0] + v[3] * m->mean[1]) +
                     m->spread * pow(a, m->power);
    return q / (1 + q);
}

void mu_albedo_means_place(const albedo_means *m, double a, double b, double angle, double v[4]) {
    const double turn = m->axis + angle, c = cos(turn), s = sin(turn),
                 wide[4] = {a * c, -b * s, a * s, b * c};
    for (int i = 0; i < 2; i++) {
        v[2 + i] = wide[2 + i] / m->root[2];
        v[i] = (wide[i] - m->root[1] * v[2 + i]) / m->root[0];
    }
}

int mu_albedo_means_view(const albedo_means *m, int rough, int shape, int angle, double v[4]) {
    const double log_a = rough_at(m, first + (last - first) * rough / (m->rows - 1)), a = exp2(log_a),
                 t = (double)shape / (SHAPES - 1), b = exp2(log_a - shapes_to(log_a) * (t + t * t * t) / 2);
    const int n = nodes_of(m), back = angle >= n;
    const double off =
        asin(m->angles > 1 ? to_sine(angle_at(n, back ? angle - n + 1 : angle), cusp(m, a, b)) : 1);
    mu_albedo_means_place(m, a, b, PI / 2 + (back || m->even ? -off : off), v);
    return shape > 0 && m->angles > 1;
}

#endif
