/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_tabulated.c: a histogram of slopes as a distribution: tables that can be worked out by hand, areas by clipped
 * polygons, equal surfaces, extremes.
 */
#include <float.h>

#include "tests/tabulated_fixture.h"

static const double tolerance = 1e-12; /* some hundred double operations */

/* Uniform slopes over a rectangle: P22 = 1/area; from +x at the horizon those of negative slope show; from high above all
 * do, and then sigma = w.(-mean slope, 1). */
static void a_single_cell(void **state) {
    (void)state;
    const double one = 7;
    mu_definition d = tabulated_definition(&one, 1, 1, -0.5, 1.5, -1, 3);
    tabulated_surfaces s = tabulated_make(&d, 0);
    double w[3];
    bsdf_direction(0.999, 1.1, w);
    bsdf_near(tabulated_sigma_d(&s, w), w[2] - 0.5 * w[0] - 1 * w[1], tolerance);
    /* integral over [-1/2, 0] of -s/2, over [0, 3/2] of s/2, over [-1, 0] of -s/4, over [0, 3] of s/4 */
    bsdf_near(tabulated_sigma_d(&s, (const double[3]){1, 0, 0}), 0.0625, tolerance);
    bsdf_near(tabulated_sigma_d(&s, (const double[3]){-1, 0, 0}), 0.5625, tolerance);
    bsdf_near(tabulated_sigma_d(&s, (const double[3]){0, 1, 0}), 0.125, tolerance);
    bsdf_near(tabulated_sigma_d(&s, (const double[3]){0, -1, 0}), 1.125, tolerance);
    for (int i = 0; i < 64; i++) {
        double m[3];
        bsdf_direction(0.2 + 0.0123 * i, i, m);
        const double x = -m[0] / m[2], y = -m[1] / m[2];
        const int inside = x > -0.5 && x < 1.5 && y > -1 && y < 3;
        bsdf_near(tabulated_density_d(&s, m), inside ? 1 / (8 * pow(m[2], 4)) : 0, tolerance);
    }
    tabulated_free(&s);
}

/* A roof of two slopes, 1 part of slope -2, 3 of slope 0.5: sigma(w) = sum of p max(0, w.z - s w.x) where w cuts no cell. */
static void an_uneven_roof(void **state) {
    (void)state;
    enum { N = 1001 }; /* cells around -2, ..., 2 in steps of 0.004 */
    static double weights[N];
    const double step = 0.004;
    weights[0] = 1, weights[500 + 125] = 3;
    mu_definition d = tabulated_definition(weights, N, 1, -500.5 * step, 500.5 * step, -step, step);
    tabulated_surfaces s = tabulated_make(&d, 0);
    for (int i = 1; i < 100; i++) {
        const double angle = i * TEST_PI / 100, w[3] = {cos(angle), 0, sin(angle)};
        if (fabs(w[2] + 2 * w[0]) < 0.01 || fabs(w[2] - 0.5 * w[0]) < 0.01) continue; /* cuts a cell */
        bsdf_near(tabulated_sigma_d(&s, w),
                  0.25 * fmax(0, w[2] + 2 * w[0]) + 0.75 * fmax(0, w[2] - 0.5 * w[0]), 1e-11);
    }
    tabulated_free(&s);
}

static void random_table(uniform *u, double *weights, size_t n, double empty) {
    for (size_t i = 0; i < n; i++) weights[i] = uniform_double(u) < empty ? 0 : uniform_double(u);
    weights[n / 2] += 0.5;
}

/* sigma under any M and tilt, and D: against polygons. D cos is constant over a part of a cell, so that its midpoints
 * integrate it exactly. */
static void areas_by_polygons(void **state) {
    (void)state;
    uniform u = {301};
    for (int k = 0; k < 60; k++) {
        double weights[8 * 8];
        const size_t columns = 1 + uniform_bits(&u) % 8, rows = 1 + uniform_bits(&u) % 8;
        random_table(&u, weights, columns * rows, 0.4);
        mu_definition d =
            tabulated_definition(weights, columns, rows, -1 - uniform_double(&u), 0.2 + uniform_double(&u),
                                 -uniform_double(&u), 0.1 + 2 * uniform_double(&u));
        if (k % 4) bsdf_random_map(&u, d.transform);
        if (k % 3) d.tilt[0] = uniform_double(&u) - 0.5, d.tilt[1] = uniform_double(&u) - 0.5;
        tabulated_surfaces s = tabulated_make(&d, 0);
        for (int i = 0; i < 20; i++) {
            double w[3];
            bsdf_direction(i % 5 ? uniform_double(&u) : 0, 7 * uniform_double(&u), w);
            const double expected = tabulated_sigma(&d, w);
            assert_true(fabs(tabulated_sigma_d(&s, w) - expected) <= tolerance * (1 + expected));
        }
        double sum = 0, area = 0;
        for (size_t row = 0; row < rows; row++)
            for (size_t column = 0; column < columns; column++) {
                const double *b = d.histogram_bounds;
                const double slope[2] = {b[0] + ((double)column + 0.5) * (b[1] - b[0]) / (double)columns,
                                         b[2] + ((double)row + 0.5) * (b[3] - b[2]) / (double)rows};
                double moved[2];
                tabulated_move(&d, slope, moved);
                const double cosine = 1 / sqrt(1 + moved[0] * moved[0] + moved[1] * moved[1]);
                const double m[3] = {-moved[0] * cosine, -moved[1] * cosine, cosine};
                area = (b[1] - b[0]) / (double)columns * (b[3] - b[2]) / (double)rows /
                       fabs(d.transform[0] * d.transform[3] - d.transform[1] * d.transform[2]);
                const double mass = tabulated_density_d(&s, m) * pow(cosine, 4) * area; /* P22, Eq. (4) */
                double total = 0;
                for (size_t i = 0; i < columns * rows; i++) total += weights[i];
                bsdf_near(mass, weights[row * columns + column] / total, 1e-11);
                sum += mass;
            }
        bsdf_near(sum, 1, tolerance);
        tabulated_free(&s);
    }
}

/* Slopes shifted are a tilt, slopes scaled a transform, columns turned round a mirror. */
static void equal_surfaces_are_equal(void **state) {
    (void)state;
    uniform u = {302};
    double weights[30], turned[30];
    random_table(&u, weights, 30, 0.3);
    for (int j = 0; j < 5; j++)
        for (int i = 0; i < 6; i++) turned[6 * j + i] = weights[6 * j + 5 - i];
    const mu_definition a = tabulated_definition(weights, 6, 5, -0.7, 1.1, -0.8, 0.4);
    mu_definition shifted = tabulated_definition(weights, 6, 5, -0.4, 1.4, -1.0, 0.2);
    shifted.tilt[0] = -0.3, shifted.tilt[1] = 0.2;
    mu_definition scaled = tabulated_definition(weights, 6, 5, -1.4, 2.2, -0.2, 0.1);
    scaled.transform[0] = 2, scaled.transform[3] = 0.25;
    mu_definition mirrored = tabulated_definition(turned, 6, 5, -1.1, 0.7, -0.8, 0.4);
    mirrored.transform[0] = -1;
    const mu_definition others[] = {shifted, scaled, mirrored};
    tabulated_surfaces s = tabulated_make(&a, 0);
    for (int k = 0; k < 3; k++) {
        tabulated_surfaces t = tabulated_make(&others[k], 0);
        for (int i = 0; i < 50; i++) {
            double wo[3], wi[3];
            mu_closure_d c, e;
            mu_value_d x, y;
            bsdf_direction(0.02 + 0.98 * uniform_double(&u), 7 * uniform_double(&u), wo);
            bsdf_direction(0.02 + 0.98 * uniform_double(&u), 7 * uniform_double(&u), wi);
            assert_true(mu_bind_d(s.d, wo, NULL, &c) && mu_bind_d(t.d, wo, NULL, &e));
            mu_eval_d(&c, wi, &x), mu_eval_d(&e, wi, &y);
            bsdf_near(y.f[0], x.f[0], 1e-11);
            bsdf_near(y.pdf, x.pdf, 1e-11);
            bsdf_near(mu_view_d(&e, wi).sigma, mu_view_d(&c, wi).sigma, 1e-11);
        }
        tabulated_free(&t);
    }
    tabulated_free(&s);
}

#define FINITE(x, most) assert_true((double)(x) >= 0 && (double)(x) <= (double)(most))

/* One cell in a million, one row, one column, bounds of any size, slopes that all lean one way: nothing is NaN, infinite or
 * negative, in either precision, seen from anywhere. */
static void extremes_stay_finite(void **state) {
    (void)state;
    static double weights[1024 * 1024];
    static const size_t sides[][2] = {{1, 1}, {1024, 1}, {1, 1024}, {2, 2}, {1024, 1024}, {37, 5}};
    static const double scales[] = {1e-20, 1e-6, 1, 1e6, 1e20};
    static const double cosines[] = {1, 0.5, 1e-3, 1e-9, 1e-20};
    uniform u = {306};
    for (int k = 0; k < 36; k++) {
        const size_t columns = sides[k % 6][0], rows = sides[k % 6][1], n = columns * rows;
        if (n > 100000 && k >= 6) continue; /* once */
        for (size_t i = 0; i < n; i++) weights[i] = k % 2 ? 0 : k % 3 ? uniform_double(&u) : 1e308;
        weights[uniform_bits(&u) % n] = k % 4 ? 1e-300 : 1;
        const double sx = scales[uniform_bits(&u) % 5], sy = scales[uniform_bits(&u) % 5],
                     shift = k % 5 ? -0.5 : 3;
        mu_definition d = tabulated_definition(weights, columns, rows, shift * sx, (1 + shift) * sx,
                                               shift * sy, (1 + shift) * sy);
        bsdf_random_map(&u, d.transform);
        if (k % 7 == 0) d.transmission = 1, d.fresnel = MU_FRESNEL_DIELECTRIC;
        tabulated_surfaces s = tabulated_make(&d, 1);
        for (int i = 0; i < 60; i++) {
            double wo[3], wi[3];
            bsdf_direction(cosines[uniform_bits(&u) % 5], 7 * uniform_double(&u), wo);
            bsdf_direction(cosines[uniform_bits(&u) % 5], 7 * uniform_double(&u), wi);
            if (i % 5 == 0) wi[0] = -wo[0], wi[1] = -wo[1];
            const float of[3] = {(float)wo[0], (float)wo[1], (float)wo[2]},
                        wf[3] = {(float)wi[0], (float)wi[1], (float)wi[2]};
            mu_closure_d c;
            mu_closure_f f;
            mu_value_d x;
            mu_value_f y;
            assert_true(mu_bind_d(s.d, wo, NULL, &c) && mu_bind_f(s.f, of, NULL, &f));
            mu_eval_d(&c, wi, &x), mu_eval_f(&f, wf, &y);
            FINITE(x.f[0], DBL_MAX);
            FINITE(x.pdf, DBL_MAX);
            FINITE(y.f[0], FLT_MAX);
            FINITE(y.pdf, FLT_MAX);
            FINITE(mu_view_d(&c, wi).sigma, DBL_MAX);
            FINITE(mu_view_f(&f, wf).sigma, FLT_MAX);
            FINITE(mu_normal_d(&c, wi).Dv, DBL_MAX);
            FINITE(mu_normal_f(&f, wf).Dv, FLT_MAX);
            const double v[3] = {i % 2 ? 0 : 1 - 0x1p-53, uniform_double(&u), i % 3 ? 0 : 1 - 0x1p-53};
            const float vf[3] = {i % 2 ? 0 : 1 - 0x1p-24f, uniform_float(&u), i % 3 ? 0 : 1 - 0x1p-24f};
            const mu_sampler sampler = i % 2 || d.transmission ? MU_SAMPLE_VISIBLE : MU_SAMPLE_NDF;
            mu_sample_d a;
            mu_sample_f b;
            mu_sample_with_d(&c, sampler, v, &a), mu_sample_with_f(&f, sampler, vf, &b);
            FINITE(a.weight[0], DBL_MAX);
            FINITE(a.pdf, DBL_MAX);
            FINITE(b.weight[0], FLT_MAX);
            FINITE(b.pdf, FLT_MAX);
            FINITE(fabs(a.wi[0]), 1.0001);
            FINITE(fabsf(b.wi[0]), 1.0001);
        }
        tabulated_free(&s);
    }
}

/* Blurred, it is GGX of its own covariance, twice that being alpha², and of the bound at least: seen along both axes. */
static void blur_widens_the_narrow_axis_only(void **state) {
    (void)state;
    const double one = 1, half = sqrt(1.5); /* a cell's variance is a third of its half width squared */
    mu_definition d =
        tabulated_definition(&one, 1, 1, -0.02 * half, 0.02 * half, 0.1 - 0.4 * half, 0.1 + 0.4 * half);
    mu_definition e = bsdf_definition(MU_GGX, 0.1, 2, 1, 0, 0, 0.25);
    e.tilt[1] = 0.1 * 0.25; /* before the map that makes 0.4 of 0.1 */
    tabulated_surfaces s = tabulated_make(&d, 0);
    bsdf expected;
    mu_closure_d c;
    const double wo[3] = {0.48, 0.6, 0.64};
    bsdf_bind_double(&expected, &e, wo);
    assert_true(mu_bind_d(s.d, wo, NULL, &c));
    const mu_closure_d before = c;
    mu_blur_d(&c, 0.01); /* it is wide enough */
    assert_ptr_equal(c.kernel, before.kernel);
    assert_true(c.map.view[0] == before.map.view[0] && c.map.tilt[1] == before.map.tilt[1]);
    for (int i = 0; i < 10; i++) {
        mu_closure_d wide = c;
        mu_value_d x, y;
        double wi[3];
        mu_blur_d(&wide, 0.1);
        bsdf_direction(0.1 + 0.08 * i, i, wi);
        mu_eval_d(&wide, wi, &x), mu_eval_d(&expected.d, wi, &y);
        bsdf_near(x.f[0], y.f[0], tolerance);
        bsdf_near(x.pdf, y.pdf, tolerance);
    }
    tabulated_free(&s);
}

static void refuses_what_is_no_histogram(void **state) {
    (void)state;
    mu_complaint why;
    const double good[4] = {1, 2, 3, 4}, negative[4] = {1, 2, -3, 4}, nan[4] = {1, 2, NAN, 4},
                 infinite[4] = {1, INFINITY, 3, 4}, none[4] = {0};
    const mu_definition bad[] = {tabulated_definition(NULL, 2, 2, -1, 1, -1, 1),
                                 tabulated_definition(negative, 2, 2, -1, 1, -1, 1),
                                 tabulated_definition(nan, 2, 2, -1, 1, -1, 1),
                                 tabulated_definition(infinite, 2, 2, -1, 1, -1, 1),
                                 tabulated_definition(none, 2, 2, -1, 1, -1, 1),
                                 tabulated_definition(good, 0, 2, -1, 1, -1, 1),
                                 tabulated_definition(good, 2, 1025, -1, 1, -1, 1),
                                 tabulated_definition(good, 2, 2, 1, -1, -1, 1),
                                 tabulated_definition(good, 2, 2, -1, 1, 1, 1),
                                 tabulated_definition(good, 2, 2, -1, NAN, -1, 1),
                                 tabulated_definition(good, 2, 2, -1, 1, 1, 1 + 1e-13)};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_false(mu_definition_check(&bad[i], &why));
        assert_string_equal(why.field, "histogram");
        assert_true(why.text[0]);
    }
    const mu_definition fine = tabulated_definition(good, 2, 2, -1, 1, -1, 1);
    assert_true(mu_definition_check(&fine, &why));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_single_cell),
                                       cmocka_unit_test(an_uneven_roof),
                                       cmocka_unit_test(areas_by_polygons),
                                       cmocka_unit_test(equal_surfaces_are_equal),
                                       cmocka_unit_test(extremes_stay_finite),
                                       cmocka_unit_test(blur_widens_the_narrow_axis_only),
                                       cmocka_unit_test(refuses_what_is_no_histogram)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
