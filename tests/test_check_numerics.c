/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_check_numerics.c: the instruments of `musurf check`, tested before they test anything: against mpmath,
 * known answers and closed forms; and the whole harness against a right material and wrong ones
 * (double_ggx.h).
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "core/render/check_chi2.h"
#include "core/render/check_probability.h"
#include "core/render/check_quadrature.h"
#include "core/render/check_random.h"
#include "core/render/check_tests.h"
#include "core/render/philox.h"
#include "tests/double_ggx.h"
#include "tests/significance.h"

static void near(double got, double expected, double relative, const char *what, double a, double b) {
    if (!(fabs(got - expected) <= relative * fabs(expected)))
        fail_msg("%s(%g, %g) = %.17g, not %.17g", what, a, b, got, expected);
}

/* mpmath 1.3, mp.dps = 30: nstr(gammainc(a, x, inf, regularized=True), 17) */
static void incomplete_gamma_agrees_with_mpmath(void **state) {
    (void)state;
    static const double table[][3] = {
        {0.5, 0.1, 0.65472084601857702},     {0.5, 3, 0.01430587843542964},
        {1, 1, 0.36787944117144232},         {2.5, 2.5, 0.41588018699550792},
        {10, 3, 0.99889751186988452},        {10, 25, 0.00022147663824878358},
        {50, 50, 0.48119168452795672},       {199.5, 150, 0.99993359153503723},
        {199.5, 260, 4.1276308412921332e-5}, {500, 400, 0.99999918906189212},
        {500, 650, 3.8897364994868525e-10},  {1000, 1100, 0.0010593232539299773},
        {0.5, 400, 5.3958656116079009e-176}, {100, 300, 1.4110215102111521e-41}};
    for (size_t i = 0; i < sizeof table / sizeof *table;
         i++) /* a log x is rounded: a few hundred epsilon at a = 1000 */
        near(mu_gamma_q(table[i][0], table[i][1]), table[i][2], 1e-12, "Q", table[i][0], table[i][1]);
    assert_true(mu_gamma_q(3, 0) == 1);
    assert_true(mu_gamma_q(3, INFINITY) == 0);
    assert_true(isnan(mu_gamma_q(3, NAN)));
    near(mu_chi2_p(6, 2), exp(-3), 1e-14, "chi2", 6, 2);
    near(mu_sidak(0.01, 4096), significance_level(), 1e-12, "sidak", 0.01, 4096);
}

/* Random123's known answers (kat_vectors) for philox4x32 with 10 rounds. */
static void philox_gives_its_known_answers(void **state) {
    (void)state;
    static const uint32_t counters[3][4] = {
        {0, 0, 0, 0},
        {0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff},
        {0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
    };
    static const uint32_t keys[3][2] = {{0, 0}, {0xffffffff, 0xffffffff}, {0xa4093822, 0x299f31d0}};
    static const uint32_t answers[3][4] = {
        {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8},
        {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd},
        {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1},
    };
    for (int i = 0; i < 3; i++) {
        uint32_t out[4];
        mu_philox(counters[i], keys[i], out);
        for (int k = 0; k < 4; k++) assert_int_equal(out[k], answers[i][k]);
    }
    mu_stream random = mu_stream_make(1, 2);
    double sum = 0;
    for (int i = 0; i < 100000; i++) {
        const double u = mu_stream_uniform(&random);
        assert_true(u >= 0 && u < 1);
        sum += u;
    }
    assert_true(p_of_z((sum / 1e5 - 0.5) * sqrt(12e5)) > significance_level());
}

static void monomial(void *context, double x, double y, double value[MU_PARTS]) {
    const double *power = context;
    value[0] = pow(x, power[0]) * pow(y, power[1]);
}

static void kronrod_rules_are_exact_for_polynomials(void **state) {
    (void)state;
    static const int degree[] = {[MU_KRONROD_7] = 10, [MU_KRONROD_15] = 22};
    for (mu_rule rule = MU_KRONROD_7; rule <= MU_KRONROD_15; rule++)
        for (int a = 0; a <= degree[rule]; a++) {
            double power[2] = {a, degree[rule] - a};
            const mu_quadrature q = {.integrand = monomial,
                                     .context = power,
                                     .parts = 1,
                                     .target = {1e30},
                                     .panel_limit = 1,
                                     .rule = rule};
            const mu_integral one = mu_integrate(&q, (const double[2]){0, 2}, 1, (const double[2]){0, 3}, 1);
            near(one.value[0], pow(2, power[0] + 1) / (power[0] + 1) * pow(3, power[1] + 1) / (power[1] + 1),
                 1e-14, "monomial", power[0], power[1]);
        }
}

/* A peak of width 1/50 off centre, a ridge with an edge, and a singular corner. */
static void hard(void *context, double x, double y, double value[MU_PARTS]) {
    (void)context;
    const double s = (x - 0.3) * 50, t = (y - 0.7) * 50;
    value[0] = exp(-s * s / 2 - t * t / 2);
    value[1] = fabs(x - 0.4) * y;
    value[2] = 1 / sqrt(x);
}

static void adaptive_quadrature_meets_closed_forms(void **state) {
    (void)state;
    const mu_quadrature q = {.integrand = hard,
                             .parts = 3,
                             .target = {1e-12, 1e-10, 1e-8},
                             .panel_limit = 4000,
                             .rule = MU_KRONROD_15};
    const mu_integral integral = mu_integrate(&q, (const double[2]){0, 1}, 4, (const double[2]){0, 1}, 4);
    const double expected[3] = {6.283185307179586477 / 2500, (0.08 + 0.18) / 2, 2};
    assert_true(integral.resolved);
    for (size_t k = 0; k < 3; k++) {
        if (!(fabs(integral.value[k] - expected[k]) <= q.target[k]))
            fail_msg("part %zu: %.17g, not %.17g", k, integral.value[k], expected[k]);
        assert_true(integral.error[k] <= q.target[k]);
    }
}

static void unresolved_integrals_say_so(void **state) {
    (void)state;
    const mu_quadrature q = {.integrand = hard,
                             .parts = 3,
                             .target = {1e-30, 1e-12, 1e-12},
                             .panel_limit = 40,
                             .rule = MU_KRONROD_15};
    assert_false(mu_integrate(&q, (const double[2]){0, 1}, 4, (const double[2]){0, 1}, 4).resolved);
}

/* locate undoes point, for every region, at ordinary and extreme maps. */
static void regions_map_there_and_back(void **state) {
    (void)state;
    static const double maps[][4] = {
        {1, 0, 0, 1}, {1, 2, 0, 1}, {-3, .5, .2, 4}, {1e12, 0, 0, 1e12}, {1e-4, 0, 3e-5, 1e-4}};
    mu_stream random = mu_stream_make(7, 0);
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        mu_plane plane;
        assert_true(mu_plane_from_transform(&plane, maps[i], NULL, 0.05, 2));
        for (mu_region_kind kind = MU_WHOLE_PLANE; kind <= MU_REFLECTING_SLOPES; kind++) {
            const double view[3] = {0.36, 0.48, 0.8};
            const mu_region region = mu_region_make(&plane, kind, view);
            for (int n = 0; n < 100; n++) {
                const double x = mu_stream_uniform(&random), y = 2 * mu_stream_uniform(&random);
                double m[3], gx, gy;
                assert_true(mu_region_point(&region, x, y, m) > 0);
                const double facing = view[0] * m[0] + view[1] * m[1] + view[2] * m[2];
                if (kind != MU_WHOLE_PLANE) assert_true(facing > 0);
                if (kind == MU_REFLECTING_SLOPES) assert_true(2 * facing * m[2] > view[2] * (1 - 1e-12));
                if (x > 0.9) continue; /* at slopes of e^30 the normal forgets its z */
                assert_true(mu_region_locate(&region, m, &gx, &gy));
                assert_true(fabs(gx - x) < 1e-6 && fabs(gy - y) < 1e-6);
            }
        }
    }
}

static void singular_maps_are_refused(void **state) {
    (void)state;
    mu_plane plane;
    assert_false(mu_plane_from_transform(&plane, (const double[4]){1, 2, 2, 4}, NULL, 1, 0));
}

/* Tyler's estimate from samples of a stretched and sheared distribution with heavy tails. */
static void planes_are_found_from_samples(void **state) {
    (void)state;
    enum { COUNT = 2000 };
    double slopes[2 * COUNT], scratch[2 * COUNT];
    mu_stream random = mu_stream_make(11, 0);
    for (int i = 0; i < COUNT; i++) {
        const double u = mu_stream_uniform(&random), phi = 6.283185307179586 * mu_stream_uniform(&random);
        const double r = 0.1 * sqrt(u / (1 - u)), x = r * cos(phi), y = r * sin(phi);
        slopes[2 * i] = 1e6 * x + 3 * y;
        slopes[2 * i + 1] = 2e6 * x + 7 * y;
    }
    mu_plane plane;
    assert_true(mu_plane_from_slopes(&plane, slopes, COUNT, scratch));
    double xx = 0, xy = 0, yy = 0; /* signs of the pulled-back slopes: round within sampling noise */
    for (int i = 0; i < COUNT; i++) {
        const double *f = plane.from_slope, *p = slopes + 2 * i;
        const double x = f[0] * p[0] + f[1] * p[1], y = f[2] * p[0] + f[3] * p[1], s = x * x + y * y;
        xx += x * x / s / COUNT;
        xy += x * y / s / COUNT;
        yy += y * y / s / COUNT;
    }
    assert_true(fabs(xx - 0.5) < 1e-3 && fabs(yy - 0.5) < 1e-3 && fabs(xy) < 1e-3);
    assert_true(fabs(plane.area / (0.1 * 0.1 * 1e6) - 1) <
                0.2); /* det of the map times the squared median radius */
}

static const mu_check_effort effort = {
    .target = 1e-9, .panels = 2000, .samples = 200000, .shading_samples = 0, .cells = 600, .points = 32};
static const double steep[3] = {0.99144486137381041, 0, 0.13052619222005157}; /* 82.5 degrees */

static void run(const double_ggx *ggx, const double view[3], uint64_t stream, mu_tally *tally) {
    const mu_subject subject = double_ggx_subject(ggx);
    mu_stream random = mu_stream_make(2026, stream);
    mu_tally_init(tally);
    mu_check_normalisation(&subject, &effort, tally);
    mu_check_visible(&subject, &effort, view, tally);
    const mu_reflected reflected = mu_check_scattered(&subject, &effort, view, tally);
    mu_check_sampler(&subject, &effort, MUSURF_SAMPLE_NDF, view, &reflected, &random, tally);
    mu_check_sampler(&subject, &effort, MUSURF_SAMPLE_VISIBLE, view, &reflected, &random, tally);
    mu_check_points(&subject, &effort, view, &random, tally);
    mu_check_classic(&subject, ggx->ax, ggx->ay, &effort, view, &random, tally);
}

static void a_right_material_passes_everything(void **state) {
    (void)state;
    static const double roughness[][2] = {{0.3, 0.3}, {0.001, 0.001}, {1, 0.02}, {1e-5, 0.5}};
    static const double views[][3] = {
        {0, 0, 1}, {0.36, 0.48, 0.8}, {0.99996192306417128, 0, 0.0087265354983739347}};
    for (uint64_t i = 0; i < 4; i++)
        for (uint64_t k = 0; k < 3; k++) {
            const double_ggx ggx = {.ax = roughness[i][0], .ay = roughness[i][1], .mass = 1};
            mu_tally tally;
            run(&ggx, views[k], 3 * i + k, &tally);
            for (mu_law law = 0; law < MU_LAW_COUNT; law++)
                if (!mu_tally_passes(&tally, law, significance_level()))
                    fail_msg("%s: worst %g, error %g at %s", mu_law_title(law), tally.row[law].worst,
                             tally.row[law].error, tally.row[law].where);
            assert_int_equal(tally.row[MU_LAW_MASKING].unresolved, 0);
            assert_true(tally.row[MU_LAW_MASKING].count == 1 && tally.row[MU_LAW_VISIBLE_SAMPLER].count == 1);
        }
}

static void must_fail(const mu_tally *tally, mu_law law) {
    if (mu_tally_passes(tally, law, significance_level())) fail_msg("%s did not notice", mu_law_title(law));
}

static void one_per_cent_of_mass_is_found(void **state) {
    (void)state;
    const double_ggx ggx = {.ax = 0.2, .ay = 0.05, .mass = 1.01};
    mu_tally tally;
    run(&ggx, steep, 20, &tally);
    must_fail(&tally, MU_LAW_NORMALISATION);
    must_fail(&tally, MU_LAW_MASKING);
    must_fail(&tally, MU_LAW_VISIBLE_NORMALS);
    must_fail(&tally, MU_LAW_PROJECTED_AREA);
    must_fail(&tally, MU_LAW_CLASSIC);
    assert_true(fabs(tally.row[MU_LAW_NORMALISATION].error - 0.01) < 1e-9);
}

static void a_sampler_three_per_cent_wrong_is_found(void **state) {
    (void)state;
    const double_ggx ggx = {.ax = 0.2, .ay = 0.05, .mass = 1, .sampler_bias = 0.03};
    mu_tally tally;
    run(&ggx, steep, 21, &tally);
    must_fail(&tally, MU_LAW_VISIBLE_SAMPLER);
    assert_true(mu_tally_passes(&tally, MU_LAW_NDF_SAMPLER, significance_level()));
}

static void the_pdf_of_the_wrong_sampler_is_found(void **state) {
    (void)state;
    const double_ggx ggx = {.ax = 0.5, .ay = 0.3, .mass = 1, .pdf_of_ndf = 1};
    mu_tally tally;
    run(&ggx, steep, 22, &tally);
    must_fail(&tally, MU_LAW_REJECTION);
    must_fail(&tally, MU_LAW_WEIGHT);
    must_fail(&tally, MU_LAW_NORMAL_PDF);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(incomplete_gamma_agrees_with_mpmath),
        cmocka_unit_test(philox_gives_its_known_answers),
        cmocka_unit_test(kronrod_rules_are_exact_for_polynomials),
        cmocka_unit_test(adaptive_quadrature_meets_closed_forms),
        cmocka_unit_test(unresolved_integrals_say_so),
        cmocka_unit_test(regions_map_there_and_back),
        cmocka_unit_test(singular_maps_are_refused),
        cmocka_unit_test(planes_are_found_from_samples),
        cmocka_unit_test(a_right_material_passes_everything),
        cmocka_unit_test(one_per_cent_of_mass_is_found),
        cmocka_unit_test(a_sampler_three_per_cent_wrong_is_found),
        cmocka_unit_test(the_pdf_of_the_wrong_sampler_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
