/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_tabulated_limits.c: finer and finer histograms of an analytic distribution become that distribution, at the rate
 * that a piecewise constant density has; the float table follows the exact area.
 */
#include "tests/tabulated_fixture.h"

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
            const double expected = mu_view_d(&analytic.d, w).sigma, got = tabulated_sigma_d(&s, w);
            worst[0] = fmax(worst[0], fabs(got - expected));
            worst[1] = fmax(worst[1], fabs(w[2] / got - w[2] / expected));
            worst[2] = fmax(worst[2], fabs(tabulated_density_d(&s, m) - mu_normal_d(&analytic.d, m).D));
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
            worst = fmax(worst, fabs(tabulated_sigma_d(&s, w) - mu_view_d(&analytic.d, w).sigma));
        }
        print_message("ggx, %zu cells to %g alpha: sigma %.2e off\n", n, range / alpha, worst);
        if (n > 64) assert_true(fabs(last / worst - 2) < 0.3);
        last = worst;
        tabulated_free(&s);
    }
}

/* The float table against the exact area: of smooth histograms 5e-5 (coarse ones; the finer the better). Of a few cells in many,
 * which are summed one by one, 2e-6: some 16 roundings, of k.p and of what it cancels. Of cells that each are just not heavy, m =
 * 1/64: off a crease of slope m |p|, |p| <= 3, cubics of step h = 2 pi/256 are by m |p| h/8 in each of both directions, 3e-4 of
 * w.z + |v|, of which sigma is 0.3 at least: 1e-3. */
static void float_follows_double(void **state) {
    (void)state;
    static double weights[64 * 64];
    for (int kind = 0; kind < 5; kind++) {
        const size_t n = kind == 0 ? 2 : kind == 1 ? 16 : 64;
        uniform u = {305};
        for (size_t i = 0; i < n * n; i++) {
            const double x = ((double)(i % n) + 0.5) / (double)n - 0.5,
                         y = ((double)(i / n) + 0.5) / (double)n - 0.5;
            weights[i] = kind == 4   ? uniform_double(&u) < 100 / (double)(n * n)
                         : kind == 3 ? uniform_double(&u) < 10 / (double)(n * n)
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
            const double expected = tabulated_sigma_d(&s, w), got = (double)mu_view_f(&c, v).sigma;
            assert_true(got >= 0);
            worst = fmax(worst, fabs(got - expected) / expected);
            const double D = tabulated_density_d(&s, w), Df = (double)mu_normal_f(&c, v).D;
            if (i % 7 && fabs(Df - D) > 1e-5 * D) worst_d++; /* another cell; along the axes, edges are met */
        }
        print_message("%zu cells: sigma in float %.1e off; D of another cell %g in 5000\n", n, worst,
                      worst_d);
        assert_true(worst < (kind == 4 ? 1e-3 : kind == 3 ? 2e-6 : 5e-5));
        assert_true(worst_d <= 5);
        tabulated_free(&s);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(converges_to_beckmann),
                                       cmocka_unit_test(converges_to_ggx),
                                       cmocka_unit_test(float_follows_double)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
