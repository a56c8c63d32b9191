/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_tabulated.c: a histogram of slopes as a distribution: tables that can be worked out by hand, areas by clipped
 * polygons, convergence to the analytic distributions, float against double, extremes.
 */
#include <float.h>

#include "tests/tabulated_fixture.h"

static const double tolerance = 1e-12; /* some hundred double operations */

static double sigma_d(const tabulated_surfaces *s, const double w[3]) {
    const double up[3] = {0, 0, 1};
    mu_closure_d c;
    assert_true(mu_bind_d(s->d, up, NULL, &c));
    return mu_view_d(&c, w).sigma;
}

static double density_d(const tabulated_surfaces *s, const double m[3]) {
    const double up[3] = {0, 0, 1};
    mu_closure_d c;
    assert_true(mu_bind_d(s->d, up, NULL, &c));
    return mu_normal_d(&c, m).D;
}

/* Uniform slopes over a rectangle: P22 = 1/area; from +x at the horizon those of negative slope show; from high above all
 * do, and then sigma = w.(-mean slope, 1). */
static void a_single_cell(void **state) {
    (void)state;
    const double one = 7;
    mu_definition d = tabulated_definition(&one, 1, 1, -0.5, 1.5, -1, 3);
    tabulated_surfaces s = tabulated_make(&d, 0);
    double w[3];
    bsdf_direction(0.999, 1.1, w);
    bsdf_near(sigma_d(&s, w), w[2] - 0.5 * w[0] - 1 * w[1], tolerance);
    /* integral over [-1/2, 0] of -s/2, over [0, 3/2] of s/2, over [-1, 0] of -s/4, over [0, 3] of s/4 */
    bsdf_near(sigma_d(&s, (const double[3]){1, 0, 0}), 0.0625, tolerance);
    bsdf_near(sigma_d(&s, (const double[3]){-1, 0, 0}), 0.5625, tolerance);
    bsdf_near(sigma_d(&s, (const double[3]){0, 1, 0}), 0.125, tolerance);
    bsdf_near(sigma_d(&s, (const double[3]){0, -1, 0}), 1.125, tolerance);
    for (int i = 0; i < 64; i++) {
        double m[3];
        bsdf_direction(0.2 + 0.0123 * i, i, m);
        const double x = -m[0] / m[2], y = -m[1] / m[2];
        const int inside = x > -0.5 && x < 1.5 && y > -1 && y < 3;
        bsdf_near(density_d(&s, m), inside ? 1 / (8 * pow(m[2], 4)) : 0, tolerance);
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
        bsdf_near(sigma_d(&s, w), 0.25 * fmax(0, w[2] + 2 * w[0]) + 0.75 * fmax(0, w[2] - 0.5 * w[0]), 1e-11);
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
            assert_true(fabs(sigma_d(&s, w) - expected) <= tolerance * (1 + expected));
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
                const double mass = density_d(&s, m) * pow(cosine, 4) * area; /* P22, Eq. (4) */
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

/* exp(-s²/alpha²) over a cell, over its range, exactly. */
static double gaussian_mass(double low, double high, double alpha) {
    return (erf(high / alpha) - erf(low / alpha)) / 2;
}

/* Beckmann's masses in n x n cells: sigma and G1 converge with order 2 (a uniform cell has 1/12 of its width squared of
 * variance), D with order 1, to the analytic ones. Beyond 1.8 = 6 alpha lies 1e-16. */
static void converges_to_beckmann(void **state) {
    (void)state;
    const double alpha = 0.3, range = 1.8;
    static double weights[256 * 256];
    mu_definition b = bsdf_definition(MU_BECKMANN, alpha, 2, 1.3, 0.5, -0.2, 0.7);
    bsdf analytic;
    const double up[3] = {0, 0, 1};
    bsdf_bind_double(&analytic, &b, up);
    double last[3] = {0};
    for (size_t n = 32; n <= 256; n *= 2) {
        for (size_t i = 0; i < n * n; i++) {
            const double h = 2 * range / (double)n, x = (double)(i % n) * h - range,
                         y = (double)(i / n) * h - range;
            weights[i] = gaussian_mass(x, x + h, alpha) * gaussian_mass(y, y + h, alpha);
        }
        mu_definition d = tabulated_definition(weights, n, n, -range, range, -range, range);
        for (int k = 0; k < 4; k++) d.transform[k] = b.transform[k];
        tabulated_surfaces s = tabulated_make(&d, 0);
        uniform u = {303};
        double worst[3] = {0};
        for (int i = 0; i < 200; i++) {
            double w[3], m[3];
            bsdf_direction(uniform_double(&u), 7 * uniform_double(&u), w);
            bsdf_direction(0.6 + 0.4 * uniform_double(&u), 7 * uniform_double(&u), m);
            const double expected = mu_view_d(&analytic.d, w).sigma, got = sigma_d(&s, w);
            worst[0] = fmax(worst[0], fabs(got - expected));
            worst[1] = fmax(worst[1], fabs(w[2] / got - w[2] / expected));
            worst[2] = fmax(worst[2], fabs(density_d(&s, m) - mu_normal_d(&analytic.d, m).D));
        }
        print_message("beckmann, %zu cells: sigma %.2e, G1 %.2e, D %.2e off\n", n, worst[0], worst[1],
                      worst[2]);
        if (n > 32) {
            for (int k = 0; k < 2; k++) assert_true(fabs(log2(last[k] / worst[k]) - 2) < 0.1);
            assert_true(last[2] / worst[2] > 1.4);
        }
        for (int k = 0; k < 3; k++) last[k] = worst[k];
        tabulated_free(&s);
    }
    /* the cell's variance makes alpha larger by this part, and that moves sigma and G1 by less */
    const double wider = pow(2 * range / 256 / alpha, 2) / 12;
    assert_true(last[0] < wider && last[1] < wider);
}

/* GGX has no end: cells twice as fine and twice as far, what is left beyond them halves (its mean slope goes as 1/range). */
static void converges_to_ggx(void **state) {
    (void)state;
    const double alpha = 0.1;
    static double weights[1024 * 1024];
    const mu_definition b = bsdf_definition(MU_GGX, alpha, 2, 1, 0, 0, 1);
    bsdf analytic;
    const double up[3] = {0, 0, 1};
    bsdf_bind_double(&analytic, &b, up);
    double last = 0;
    for (size_t n = 64; n <= 1024; n *= 4) {
        const double range = alpha * sqrt((double)n), h = 2 * range / (double)n;
        for (size_t i = 0; i < n * n; i++) {
            const double x = ((double)(i % n) + 0.5) * h - range, y = ((double)(i / n) + 0.5) * h - range;
            weights[i] = 1 / pow(alpha * alpha + x * x + y * y, 2);
        }
        mu_definition d = tabulated_definition(weights, n, n, -range, range, -range, range);
        tabulated_surfaces s = tabulated_make(&d, 0);
        double worst = 0;
        uniform u = {304};
        for (int i = 0; i < 100; i++) {
            double w[3];
            bsdf_direction(0.3 * uniform_double(&u), 7 * uniform_double(&u), w);
            worst = fmax(worst, fabs(sigma_d(&s, w) - mu_view_d(&analytic.d, w).sigma));
        }
        print_message("ggx, %zu cells to %g alpha: sigma %.2e off\n", n, range / alpha, worst);
        if (n > 64) assert_true(fabs(last / worst - 2) < 0.3);
        last = worst;
        tabulated_free(&s);
    }
}

/* The float table against the exact area: of smooth histograms 5e-5 (coarse ones; the finer the better), of a few cells in
 * many 5e-3: masking has creases there that are sharper than the table. */
static void float_follows_double(void **state) {
    (void)state;
    static double weights[64 * 64];
    for (int kind = 0; kind < 4; kind++) {
        const size_t n = kind == 0 ? 2 : kind == 1 ? 16 : 64;
        uniform u = {305};
        for (size_t i = 0; i < n * n; i++) {
            const double x = ((double)(i % n) + 0.5) / (double)n - 0.5,
                         y = ((double)(i / n) + 0.5) / (double)n - 0.5;
            weights[i] = kind == 3   ? uniform_double(&u) < 10 / (double)(n * n)
                         : kind == 1 ? uniform_double(&u)
                                     : exp(-30 * (x * x + y * y));
        }
        const mu_definition d = tabulated_definition(weights, n, n, -1, 1, -1.2, 1.2);
        tabulated_surfaces s = tabulated_make(&d, 1);
        mu_closure_f c;
        assert_true(mu_bind_f(s.f, (const float[3]){0, 0, 1}, NULL, &c));
        double worst = 0, worst_d = 0;
        for (int i = 0; i < 5000; i++) {
            double w[3];
            bsdf_direction(i % 9 ? uniform_double(&u) : 0, i % 7 ? 7 * uniform_double(&u) : i * TEST_PI / 14,
                           w);
            const float v[3] = {(float)w[0], (float)w[1], (float)w[2]};
            for (int k = 0; k < 3; k++) w[k] = (double)v[k];
            const double expected = sigma_d(&s, w), got = (double)mu_view_f(&c, v).sigma;
            assert_true(got >= 0);
            worst = fmax(worst, fabs(got - expected) / expected);
            const double D = density_d(&s, w), Df = (double)mu_normal_f(&c, v).D;
            if (i % 7 && fabs(Df - D) > 1e-5 * D) worst_d++; /* another cell; along the axes, edges are met */
        }
        print_message("%zu cells: sigma in float %.1e off; D of another cell %g in 5000\n", n, worst,
                      worst_d);
        assert_true(worst < (kind == 3 ? 5e-3 : 5e-5));
        assert_true(worst_d <= 5);
        tabulated_free(&s);
    }
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
                                       cmocka_unit_test(converges_to_beckmann),
                                       cmocka_unit_test(converges_to_ggx),
                                       cmocka_unit_test(float_follows_double),
                                       cmocka_unit_test(extremes_stay_finite),
                                       cmocka_unit_test(blur_widens_the_narrow_axis_only),
                                       cmocka_unit_test(refuses_what_is_no_histogram)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
