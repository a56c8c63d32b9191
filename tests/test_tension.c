/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_tension.c: M of triangles and points against closed forms.
 *
 * Bounds: a triangle's entries of M are sums of products of edges, each with the rounding of positions within 10, 1e-15,
 * over edges of 0.02 and more: 1e-13 times the condition of the triangles and of the map, which the tests keep below 1e3.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/tension/stretch.h"
#include "core/tension/tension.h"
#include "tests/sheet.h"
#include "tests/shapes.h"

#define EXACT 1e-10

static double rows(const mu_affine *a, int i, const double p[3]) {
    return (double)a->row[i][0] * p[0] + (double)a->row[i][1] * p[1] + (double)a->row[i][2] * p[2] +
           (double)a->row[i][3];
}

static void map_points(const mu_affine *a, const double *from, double *to, uint32_t count) {
    for (size_t i = 0; i < count; i++) {
        const double p[3] = {from[3 * i], from[3 * i + 1], from[3 * i + 2]};
        for (int k = 0; k < 3; k++) to[3 * i + (size_t)k] = rows(a, k, p);
    }
}

static void assert_matrix(const double *m, const double *expected, double within) {
    for (int k = 0; k < 4; k++)
        if (!(fabs(m[k] - expected[k]) <= within))
            fail_msg("M = [%.17g %.17g; %.17g %.17g], not [%.17g %.17g; %.17g %.17g]", m[0], m[1], m[2], m[3],
                     expected[0], expected[1], expected[2], expected[3]);
}

/* The part of A between the planes, where `t` and `b` span the one at rest: A t is along the new tangent. */
static void tangent_part(const mu_affine *a, const double t[3], const double b[3], double m[4]) {
    double at[3], ab[3], along = 0, rest = 0, length = 0;
    for (int k = 0; k < 3; k++) {
        const double zero[3] = {0, 0, 0};
        at[k] = rows(a, k, t) - rows(a, k, zero), ab[k] = rows(a, k, b) - rows(a, k, zero);
        length += at[k] * at[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3; k++) along += at[k] * ab[k] / length;
    for (int k = 0; k < 3; k++) {
        const double across = ab[k] - along * at[k] / length;
        rest += across * across;
    }
    m[0] = length, m[1] = along, m[2] = 0, m[3] = sqrt(rest);
}

/* A plane anywhere in space, any triangles, any turned, scaled, mirrored texture, any map: the same M everywhere. */
static void test_affine_maps_of_a_plane(void **state) {
    uniform random = {20261126};
    (void)state;
    for (int trial = 0; trial < 50; trial++) {
        sheet s = sheet_make(7, 5);
        sheet_shake(&s, &random, 0.25);
        const mu_affine place = test_affine(&random, 3), map = test_affine(&random, 3);
        const double angle = test_between(&random, 0, 7), size = test_between(&random, 0.01, 100);
        const double mirror = trial % 2 ? -1 : 1;
        for (size_t i = 0; i < 6 * (size_t)s.triangles;
             i += 2) { /* while the sheet still lies in the plane z = 0 */
            const double x = s.uv[i], y = s.uv[i + 1];
            s.uv[i] = size * (cos(angle) * x - sin(angle) * y),
            s.uv[i + 1] = mirror * size * (sin(angle) * x + cos(angle) * y);
        }
        /* in the sheet, u grows along (cos, -sin); wherever that goes, the tangent goes, and b is on its left */
        map_points(&place, s.rest, s.rest, s.vertices);
        map_points(&map, s.rest, s.deformed, s.vertices);
        const double flat[3] = {cos(angle), -sin(angle), 0}, side[3] = {sin(angle), cos(angle), 0},
                     zero[3] = {0, 0, 0};
        double t[3], b[3], length = 0, along = 0, across = 0, expected[4];
        for (int k = 0; k < 3; k++)
            t[k] = rows(&place, k, flat) - rows(&place, k, zero), length += t[k] * t[k];
        for (int k = 0; k < 3; k++) t[k] /= sqrt(length);
        for (int k = 0; k < 3; k++)
            b[k] = rows(&place, k, side) - rows(&place, k, zero), along += b[k] * t[k];
        for (int k = 0; k < 3; k++) b[k] -= along * t[k], across += b[k] * b[k];
        for (int k = 0; k < 3; k++) b[k] /= sqrt(across);
        tangent_part(&map, t, b, expected);
        mu_tension *tension = sheet_tension(&s);
        for (uint32_t i = 0; i < s.triangles; i++)
            assert_matrix(tension->face + 4 * (size_t)i, expected, EXACT);
        for (uint32_t i = 0; i < tension->points; i++) assert_matrix(tension->point[i].m, expected, EXACT);
        assert_int_equal(tension->points, s.vertices);
        assert_int_equal(tension->counts.uv_mirrored, trial % 2 ? s.triangles : 0);
        mu_tension_free(tension);
        sheet_free(&s);
    }
}

/* However bent, a rigid motion is none; and a surface scaled by 3 has M = 3. */
static void test_rigid_motions(void **state) {
    uniform random = {7};
    (void)state;
    for (int trial = 0; trial < 20; trial++) {
        sheet s = sheet_make(9, 9);
        sheet_shake(&s, &random, 0.3);
        const double scale = trial % 2 ? 3 : 1, expected[4] = {scale, 0, 0, scale};
        const mu_vec3 x = test_direction(&random), z = mu_normalise(mu_cross(x, test_direction(&random)));
        const mu_vec3 y = mu_cross(z, x);
        for (size_t i = 0; i < s.vertices; i++) {
            double p[3];
            sheet_bend(s.rest[3 * i], s.rest[3 * i + 1], p);
            memcpy(s.rest + 3 * i, p, sizeof p);
            for (int k = 0; k < 3; k++)
                s.deformed[3 * i + (size_t)k] =
                    scale * ((double)(&x.x)[k] * p[0] + (double)(&y.x)[k] * p[1] + (double)(&z.x)[k] * p[2]) +
                    5;
        }
        mu_tension *tension = sheet_tension(&s);
        /* the axes are floats: orthonormal to 2^-22 */
        for (uint32_t i = 0; i < s.triangles; i++)
            assert_matrix(tension->face + 4 * (size_t)i, expected, 1e-6 * scale);
        for (uint32_t i = 0; i < tension->points; i++)
            assert_matrix(tension->point[i].m, expected, 1e-6 * scale);
        assert_int_equal(tension->counts.inverted, 0);
        mu_tension_free(tension);
        sheet_free(&s);
    }
}

/* The cylinder of radius 1 round z, u along the angle: inflated to r, stretched by s, twisted by k per unit of z. */
static double twist(uint32_t around, uint32_t up, double r, double stretch, double k, _Bool closed_form) {
    const double pi = acos(-1.0), smooth[4] = {r, r * k, 0, stretch}, h = 2.0 / up;
    sheet s = sheet_make(around, up);
    double worst = 0;
    for (size_t i = 0; i < s.vertices; i++) {
        const double angle = 2 * pi * s.rest[3 * i], z = 2 * s.rest[3 * i + 1], turned = angle + k * z;
        const double rest[3] = {cos(angle), sin(angle), z},
                     deformed[3] = {r * cos(turned), r * sin(turned), stretch * z};
        memcpy(s.rest + 3 * i, rest, sizeof rest);
        memcpy(s.deformed + 3 * i, deformed, sizeof deformed);
    }
    mu_tension *tension = sheet_tension(&s);
    if (closed_form) { /* edges are chords: the one up turns by k h, and is seen from the middle of the one around */
        const double chord = 2 * r * sin(k * h / 2), along = chord * cos(k * h / 2 - pi / around);
        const double across = sqrt(chord * chord + stretch * stretch * h * h - along * along);
        const double facet[4] = {r, along / h, 0, across / h};
        for (uint32_t i = 0; i < s.triangles; i += 2)
            assert_matrix(tension->face + 4 * (size_t)i, facet, EXACT);
    }
    for (uint32_t i = 0; i < tension->points; i++)
        for (int c = 0; c < 4; c++) worst = fmax(worst, fabs(tension->point[i].m[c] - smooth[c]));
    mu_tension_free(tension);
    sheet_free(&s);
    return worst;
}

static void test_cylinder(void **state) {
    (void)state;
    assert_true(twist(24, 12, 1.75, 1, 0, 1) < EXACT); /* inflated: the facets' M is the smooth one */
    assert_true(twist(24, 12, 0.5, 2, 0, 1) < EXACT);
    const double coarse = twist(24, 12, 1.5, 1.25, 0.7, 1), middle = twist(48, 24, 1.5, 1.25, 0.7, 1),
                 fine = twist(96, 48, 1.5, 1.25, 0.7, 1);
    print_message("twisted cylinder: off by %.3g, %.3g, %.3g; ratios %.2f, %.2f\n", coarse, middle, fine,
                  coarse / middle, middle / fine);
    /* second order: 4, less what the next order adds, at most half at these sizes and a quarter of that at the next */
    assert_true(coarse / middle > 3.5 && coarse / middle < 4.5 && middle / fine > 3.8 && middle / fine < 4.2);
}

/* Worst errors: of points inside, of points on the edge, of triangles at their middle. */
static void bend_errors(uint32_t n, double shaken, double worst[3]) {
    uniform random = {20261126 + n};
    sheet s = sheet_make(n, n);
    double exact[4];
    _Bool *outside = calloc(s.vertices, sizeof *outside);
    assert_non_null(outside);
    for (size_t i = 0; i < s.vertices; i++)
        outside[i] = i % (n + 1) == 0 || i % (n + 1) == n || i / (n + 1) == 0 || i / (n + 1) == n;
    if (shaken > 0) sheet_shake(&s, &random, shaken);
    for (size_t i = 0; i < s.vertices; i++) sheet_bend(s.rest[3 * i], s.rest[3 * i + 1], s.deformed + 3 * i);
    mu_tension *tension = sheet_tension(&s);
    worst[0] = worst[1] = worst[2] = 0;
    for (uint32_t i = 0; i < tension->points; i++) {
        const double *p = s.rest + 3 * (size_t)tension->point[i].vertex;
        sheet_bend_map(p[0], p[1], exact);
        for (int c = 0; c < 4; c++) {
            double *most = &worst[outside[tension->point[i].vertex]];
            *most = fmax(*most, fabs(tension->point[i].m[c] - exact[c]));
        }
    }
    for (size_t t = 0; t < s.triangles; t++) {
        double middle[2] = {0, 0};
        for (size_t k = 0; k < 3; k++)
            for (size_t c = 0; c < 2; c++) middle[c] += s.rest[3 * (size_t)s.corner[3 * t + k] + c] / 3;
        sheet_bend_map(middle[0], middle[1], exact);
        for (size_t c = 0; c < 4; c++) worst[2] = fmax(worst[2], fabs(tension->face[4 * t + c] - exact[c]));
    }
    mu_tension_free(tension);
    sheet_free(&s);
    free(outside);
}

/* Halving triangles divides errors of second order by 4, of first by 2, less what the next order adds; the worst of ever
 * more shaken vertices grows besides. Three halvings from 16 to 128: 64 or 8, of which a factor of 2 is left to that. */
static void test_halving_triangles(void **state) {
    static const double shaken[2] = {0, 0.25};
    (void)state;
    for (int kind = 0; kind < 2; kind++) {
        double error[4][3];
        for (uint32_t k = 0; k < 4; k++) {
            bend_errors(16u << k, shaken[kind], error[k]);
            print_message("%3u^2%s: points inside %.3g, on the edge %.3g, triangles %.3g\n", 16u << k,
                          kind ? ", shaken" : "", error[k][0], error[k][1], error[k][2]);
        }
        for (int c = 0; c < 3; c++) {
            const double gained = error[0][c] / error[3][c];
            assert_true(c < 2 ? gained > 32 : gained > 4 && gained < 16);
        }
    }
}

/* A tube that bends, swells and twists along its shaken vertices; u runs round it and jumps from 1 to 0 at a seam. */
static void tube_at(double u, double v, double p[3], double q[3]) {
    const double angle = 2 * acos(-1.0) * u, turned = angle + 0.6 * v * v,
                 r = 1 + 0.3 * sin(2 * v) * cos(angle);
    p[0] = cos(angle), p[1] = sin(angle), p[2] = 2 * v;
    q[0] = r * cos(turned) + 0.4 * v * v, q[1] = r * sin(turned), q[2] = 2.5 * v + 0.2 * cos(angle);
}

/* Its M, by differences of eighth of a thousandth on both sides: within 1e-6 of the exact one. */
static void tube_map(double u, double v, double m[4]) {
    const double step = 1.0 / 8192;
    double edge[2][2][3], metric[2][3] = {{0, 0, 0}, {0, 0, 0}}, r[2][3];
    for (int c = 0; c < 2; c++) {
        double p[2][3], q[2][3];
        for (int side = 0; side < 2; side++)
            tube_at(u + (c ? 0 : side - 0.5) * step, v + (c ? side - 0.5 : 0) * step, p[side], q[side]);
        for (int k = 0; k < 3; k++)
            edge[0][c][k] = (p[1][k] - p[0][k]) / step, edge[1][c][k] = (q[1][k] - q[0][k]) / step;
    }
    for (int which = 0; which < 2; which++) {
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 3; c++)
                metric[which][c] += edge[which][c / 2][k] * edge[which][(c + 1) / 2][k];
        r[which][0] = sqrt(metric[which][0]), r[which][1] = metric[which][1] / r[which][0];
        r[which][2] = sqrt(metric[which][2] - r[which][1] * r[which][1]);
    }
    m[0] = r[1][0] / r[0][0], m[2] = 0, m[3] = r[1][2] / r[0][2];
    m[1] = (r[1][1] - m[0] * r[0][1]) / r[0][2];
}

/* Worst error along the seam, and in `apart` how much the two sides of it differ. */
static double seam_error(uint32_t n, double *apart) {
    uniform random = {5 + n};
    sheet s = sheet_make(n, n);
    double worst = 0, exact[4], (*left)[4] = calloc(n + 1, sizeof *left),
           (*right)[4] = calloc(n + 1, sizeof *right);
    assert_true(left && right);
    sheet_shake(&s, &random, 0.25);
    for (size_t j = 0; j <= n; j++) { /* the last column is the first */
        double *first = s.rest + 3 * j * (n + 1), *last = first + 3 * (size_t)n;
        last[0] = first[0] + 1, last[1] = first[1];
    }
    for (size_t i = 0; i < 3 * (size_t)s.triangles; i++)
        memcpy(s.uv + 2 * i, s.rest + 3 * (size_t)s.corner[i], 2 * sizeof *s.uv);
    for (size_t i = 0; i < s.vertices; i++) {
        const double u = s.rest[3 * i], v = s.rest[3 * i + 1];
        const size_t first = i % (n + 1) == n ? i - n : i; /* bit for bit at one place */
        if (first == i)
            tube_at(u, v, s.rest + 3 * i, s.deformed + 3 * i);
        else
            memcpy(s.rest + 3 * i, s.rest + 3 * first, 3 * sizeof *s.rest),
                memcpy(s.deformed + 3 * i, s.deformed + 3 * first, 3 * sizeof *s.rest);
    }
    mu_tension *tension = sheet_tension(&s);
    for (size_t t = 0; t < s.triangles; t++)
        for (size_t k = 0; k < 3; k++) {
            const size_t at = 3 * t + k, vertex = s.corner[at], column = vertex % (n + 1);
            const double *m = tension->point[tension->corner[at]].m;
            if (column != 0 && column != n) continue;
            memcpy(column ? right[vertex / (n + 1)] : left[vertex / (n + 1)], m, sizeof *left);
            tube_map(s.uv[2 * at], s.uv[2 * at + 1], exact);
            for (int c = 0; c < 4; c++) worst = fmax(worst, fabs(m[c] - exact[c]));
        }
    *apart = 0;
    for (uint32_t j = 0; j <= n; j++)
        for (int c = 0; c < 4; c++) *apart = fmax(*apart, fabs(left[j][c] - right[j][c]));
    mu_tension_free(tension);
    sheet_free(&s);
    free(left);
    free(right);
    return worst;
}

/* The seam of a texture that goes on smoothly is none: M is the same on both sides, and as exact as elsewhere. */
static void test_seam(void **state) {
    double error[3], apart;
    (void)state;
    for (uint32_t k = 0; k < 3; k++) {
        error[k] = seam_error(24u << k, &apart);
        print_message("seam of a shaken tube, %2u^2: off by %.3g; its sides apart by %.3g\n", 24u << k,
                      error[k], apart);
        assert_true(apart < 1e-12);
    }
    assert_true(error[0] / error[2] > 8); /* second order: 16, of which a factor of 2 is left as above */
}

/* log and back, and axes. A determinant is as uncertain as rounding the entries makes it: 1e-15 times the condition. */
static void test_stretch(void **state) {
    uniform random = {99};
    (void)state;
    for (int trial = 0; trial < 2000; trial++) {
        double m[4], back[4], size = 0;
        const double a = exp(test_between(&random, -14, 14)), d = exp(test_between(&random, -14, 14));
        const double turn = test_between(&random, -3.1, 3.1), c = test_between(&random, -2, 2) * fmax(a, d);
        m[0] = cos(turn) * a, m[1] = cos(turn) * c - sin(turn) * d;
        m[2] = sin(turn) * a, m[3] = sin(turn) * c + cos(turn) * d;
        const mu_stretch_log u = mu_stretch_log_of(m);
        mu_stretch_matrix(&u, back);
        for (int k = 0; k < 4; k++) size = fmax(size, fabs(m[k]));
        for (int k = 0; k < 4; k++) assert_true(fabs(back[k] - m[k]) <= 1e-12 * size);
        const mu_stretch_axes axes = mu_stretch_axes_of(m);
        const double ca = cos(axes.rest), sa = sin(axes.rest), rounding = 1e-15 * axes.most / axes.least;
        assert_true(rounding < 0.1 && axes.most >= axes.least && axes.least > 0);
        assert_true(back[0] * back[3] - back[1] * back[2] > 0);
        assert_true(fabs(u.xx + u.yy - log(a * d)) < rounding + 1e-14);
        assert_true(fabs(axes.area / (a * d) - 1) < rounding);
        /* where the most stretched direction goes, and by how much */
        const double first[2] = {m[0] * ca + m[1] * sa, m[2] * ca + m[3] * sa};
        assert_true(fabs(hypot(first[0], first[1]) - axes.most) <= 1e-14 * axes.most);
        assert_true(fabs(remainder(atan2(first[1], first[0]) - axes.deformed, acos(-1.0))) < 1e-14);
        /* R(rotation)^T M = U is symmetric, and positive as its trace is */
        const double cr = cos(axes.rotation), sr = sin(axes.rotation);
        assert_true(fabs(cr * m[1] + sr * m[3] - (cr * m[2] - sr * m[0])) <= 1e-14 * size);
        assert_true(cr * m[0] + sr * m[2] + cr * m[3] - sr * m[1] > 0);
    }
}

static void test_mean_of_opposites_is_none(void **state) {
    const double large[4] = {2, 0, 0, 0.5}, small[4] = {0.5, 0, 0, 2}, one[4] = {1, 0, 0, 1};
    const mu_stretch_log a = mu_stretch_log_of(large), b = mu_stretch_log_of(small);
    const mu_stretch_log mean = {(a.xx + b.xx) / 2, (a.xy + b.xy) / 2, (a.yy + b.yy) / 2, 1, 0};
    double m[4];
    (void)state;
    mu_stretch_matrix(&mean, m);
    assert_matrix(m, one, 1e-15);
}

static void test_mixing_equal_matrices_is_exact(void **state) {
    const double m[4] = {1.1, -0.3, 0.7, 2.3};
    double mixed[4];
    (void)state;
    mu_tension_mix(m, m, m, 0.3, 0.1, mixed);
    for (int k = 0; k < 4; k++) assert_true(mixed[k] == m[k]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_affine_maps_of_a_plane),
        cmocka_unit_test(test_rigid_motions),
        cmocka_unit_test(test_cylinder),
        cmocka_unit_test(test_halving_triangles),
        cmocka_unit_test(test_seam),
        cmocka_unit_test(test_stretch),
        cmocka_unit_test(test_mean_of_opposites_is_none),
        cmocka_unit_test(test_mixing_equal_matrices_is_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
