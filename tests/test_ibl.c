/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_ibl.c: core/ibl: the slopes that stand for a material, float against double, many against one, and what the axis
 * promises. Values of the axis: tests/test_ibl_axis.py.
 */
#include "core/ibl/ibl.h"

#include <stdlib.h>
#include <string.h>

#include "tests/bsdf_fixture.h"

/* The share of a surface's slopes within the ellipse of its Sigma, by the midpoint rule in its polar coordinates: P22 = D
 * cos^4 at the micronormal (-s, 1). */
static double share_within(const bsdf *b, const mu_ibl_slopes *s) {
    enum { RINGS = 400, SPOKES = 128 };
    const mu_ibl_lobe_d l = mu_ibl_lobe_of_d(s);
    double sum = 0;
    for (int i = 0; i < RINGS; i++)
        for (int j = 0; j < SPOKES; j++) {
            const double rho = (i + 0.5) / RINGS, phi = 2 * TEST_PI * (j + 0.5) / SPOKES;
            const double x = rho * l.sigma[0] * cos(phi), y = rho * l.sigma[1] * sin(phi);
            const double slope[2] = {s->mean[0] + l.turn[0] * x - l.turn[1] * y,
                                     s->mean[1] + l.turn[1] * x + l.turn[0] * y};
            const double z = 1 / sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1]);
            const double m[3] = {-slope[0] * z, -slope[1] * z, z};
            sum += mu_normal_d(&b->d, m).D * z * z * z * z * rho;
        }
    return sum * l.sigma[0] * l.sigma[1] * 2 * TEST_PI / RINGS / SPOKES;
}

/* A third, for every distribution under any M and tilt. The rule is exact around the circle; along the radius it is off by
 * f'' h²/24 < 3e-5 for |f''| < 100. */
static void test_a_third_of_the_slopes(void **state) {
    (void)state;
    static const struct {
        mu_ndf ndf;
        double alpha, gamma, exponent;
    } each[] = {{MU_GGX, 0.3, 2, 0},
                {MU_BECKMANN, 0.5, 2, 0},
                {MU_GTR, 0.3, 0.4, 0},
                {MU_GTR, 0.2, 1, 0},
                {MU_GTR, 0.4, 3.3, 0},
                {MU_GTR, 1, 5, 0},
                {MU_STD, 0.3, 1.7, 0},
                {MU_STD, 0.5, 6, 0},
                {MU_PHONG, 0, 2, 20},
                {MU_SHEEN, 0.5, 2, 0},
                {MU_SHEEN, 0.25, 2, 0},
                {MU_DISCRETE_GGX, 0.2, 2, 0},
                {MU_DISCRETE_BECKMANN, 0.2, 2, 0}};
    uniform u = {31};
    const double up[3] = {0.1, 0.2, 0.97};
    for (size_t i = 0; i < sizeof each / sizeof each[0]; i++) {
        mu_definition d = bsdf_definition(each[i].ndf, each[i].alpha, each[i].gamma, 1, 0, 0, 1);
        d.exponent = each[i].exponent;
        if (i % 2) bsdf_random_map(&u, d.transform), d.tilt[0] = 0.05, d.tilt[1] = -0.1;
        bsdf b;
        mu_ibl_slopes s;
        bsdf_bind_double(&b, &d, up);
        assert_true(mu_ibl_slopes_of(&d, &s));
        const double share = share_within(&b, &s);
        if (!(fabs(share - 1.0 / 3) < 3e-5)) fail_msg("distribution %zu: %g of the slopes", i, share);
    }
}

/* A histogram's cells are cut by an 8 x 8 lattice here and by the rule there: a boundary of some 60 of its 1600 cells, of
 * 1/500 of the mass each, known to 1/50 of a cell each and by chance: 60^(1/2) / 500 / 50 < 4e-4. */
static void test_a_third_of_a_histogram(void **state) {
    (void)state;
    enum { N = 40 };
    double histogram[N * N];
    for (int j = 0; j < N; j++)
        for (int i = 0; i < N; i++) {
            const double x = (i + 0.5) / 20 - 1.3, y = (j + 0.5) / 20 - 0.9;
            histogram[j * N + i] = exp(-8 * x * x - 3 * y * y - 4 * x * y);
        }
    mu_definition d = bsdf_definition(MU_TABULATED, 0.3, 2, 1.5, 0.4, -0.2, 0.8);
    d.histogram = histogram, d.histogram_columns = d.histogram_rows = N;
    const double bounds[4] = {-1, 1, -1, 1};
    memcpy(d.histogram_bounds, bounds, sizeof bounds);
    mu_complaint why;
    assert_true(mu_definition_check(&d, &why));
    void *memory = aligned_alloc(64, (mu_surface_bytes_d(&d) + 63) / 64 * 64);
    assert_non_null(memory);
    const double up[3] = {0, 0, 1};
    bsdf b;
    mu_ibl_slopes s;
    assert_true(mu_bind_d(mu_surface_make_d(&d, memory), up, NULL, &b.d));
    assert_true(mu_ibl_slopes_of(&d, &s));
    assert_true(fabs(share_within(&b, &s) - 1.0 / 3) < 4e-4);
    free(memory);
}

/* Sigma = alpha²/2 (M M^T)^-1, and its axes give it back; a mirror has none; others' distributions do not tell. */
static void test_sigma_of_ggx(void **state) {
    (void)state;
    uniform u = {32};
    mu_ibl_slopes s;
    for (int i = 0; i < 100; i++) {
        mu_definition d = bsdf_definition(MU_GGX, 0.1 + uniform_double(&u), 2, 1, 0, 0, 1);
        bsdf_random_map(&u, d.transform);
        assert_true(mu_ibl_slopes_of(&d, &s));
        const double *m = d.transform, a = d.alpha * d.alpha / 2;
        const double square[3] = {m[0] * m[0] + m[1] * m[1], m[0] * m[2] + m[1] * m[3],
                                  m[2] * m[2] + m[3] * m[3]};
        const double size = (square[0] + square[2]) * (s.xx + s.yy);
        /* entries of M M^T Sigma; the determinant is 0.2 at least, entries 2 at most: condition below 1e3 */
        assert_true(fabs(square[0] * s.xx + square[1] * s.xy - a) < 1e-13 * size);
        assert_true(fabs(square[0] * s.xy + square[1] * s.yy) < 1e-13 * size);
        assert_true(fabs(square[1] * s.xy + square[2] * s.yy - a) < 1e-13 * size);
        const mu_ibl_lobe_d l = mu_ibl_lobe_of_d(&s);
        const double c = l.turn[0], n = l.turn[1], p = l.sigma[0] * l.sigma[0], q = l.sigma[1] * l.sigma[1];
        assert_true(fabs(p * c * c + q * n * n - s.xx) < 1e-13 * size);
        assert_true(fabs((p - q) * c * n - s.xy) < 1e-13 * size);
        assert_true(fabs(p * n * n + q * c * c - s.yy) < 1e-13 * size);
        assert_true(l.sigma[0] >= l.sigma[1]);
    }
    mu_definition d = bsdf_definition(MU_FLAT, 0.3, 2, 2, 1, 0, 1);
    assert_true(mu_ibl_slopes_of(&d, &s));
    assert_true(s.xx == 0 && s.xy == 0 && s.yy == 0 && mu_ibl_lobe_of_f(&s).sigma[0] == 0);
    d.ndf = MU_CUSTOM;
    assert_false(mu_ibl_slopes_of(&d, &s));
}

/* Two halves that lean against each other are as rough as their leaning. */
static void test_mixing(void **state) {
    (void)state;
    const mu_ibl_slopes parts[2] = {{{0.3, 0.1}, 0.04, 0.01, 0.09}, {{-0.1, 0.1}, 0.08, -0.01, 0.01}};
    const double shares[2] = {1, 3};
    const mu_ibl_slopes alone = mu_ibl_slopes_mix(1, parts, NULL), even = mu_ibl_slopes_mix(2, parts, NULL),
                        mix = mu_ibl_slopes_mix(2, parts, shares);
    assert_memory_equal(&alone, parts, sizeof alone);
    bsdf_near(even.mean[0], 0.1, 1e-15);
    bsdf_near(even.xx, 0.06 + 0.04, 1e-15);
    assert_true(fabs(even.xy) < 1e-17);
    bsdf_near(even.yy, 0.05, 1e-15);
    bsdf_near(mix.xx, 0.25 * 0.04 + 0.75 * 0.08 + 0.25 * 0.75 * 0.16, 1e-15);
}

typedef struct question {
    mu_ibl_lobe_d lobe;
    double wo[3];
} question;

static question any_question(uniform *u) {
    const double a = pow(0.05 + 0.95 * uniform_double(u), 2), e = 1.8 * uniform_double(u) - 0.9,
                 angle = 7 * uniform_double(u);
    question q = {{{a * (1 + e), a * (1 - e)}, {cos(angle), sin(angle)}, {0, 0}}, {0, 0, 0}};
    bsdf_direction(uniform_double(u), 7 * uniform_double(u), q.wo);
    return q;
}

static double reflected_z(const double m[3], const double o[3]) {
    return 2 * (m[0] * o[0] + m[1] * o[1] + m[2] * o[2]) * m[2] - o[2];
}

/* The clamped axis and its samples reflect above the horizon (but for samples of a lobe that is wider than its axis is long),
 * to within the rounding of a product of unit vectors; the samples are even about the middle. */
static void test_above_the_horizon(void **state) {
    (void)state;
    uniform u = {33};
    int cut = 0;
    for (int i = 0; i < 20000; i++) {
        const question q = any_question(&u);
        const mu_ibl_settings_d s = {0.5 + uniform_double(&u), 2.3, 5,
                                     i % 2 ? MU_IBL_PRINTED : MU_IBL_SYMMETRIC};
        mu_ibl_axis_d a;
        mu_ibl_axis_make_d(&q.lobe, q.wo, &s, &a);
        for (int end = 0; end < 2; end++) assert_true(reflected_z(a.far_clamped[end], q.wo) > -1e-15);
        cut += a.tau[0] > 0 || a.tau[1] < 1;
        double m[5][3];
        for (size_t j = 0; j < 5; j++) {
            mu_ibl_axis_sample_d(&a, 5, j, m[j]);
            if (a.zeta >= 0) assert_true(reflected_z(m[j], q.wo) > -1e-15);
        }
        double alone[3];
        mu_ibl_axis_sample_d(&a, 1, 0, alone);
        for (int k = 0; k < 3; k++) assert_true(fabs(alone[k] - m[2][k]) < 1e-15);
        assert_true(a.t[0] > -TEST_PI / 2 && a.t[0] <= TEST_PI / 2 && a.t[1] > -TEST_PI / 2 &&
                    a.t[1] <= TEST_PI / 2);
    }
    assert_true(cut > 2000);
}

/* Of lobes and views that determine their axis: 24 roundings of 2^-24 (see tests/test_ibl_axis.py) times a condition that the
 * choice keeps below 100. */
static void test_float(void **state) {
    (void)state;
    uniform u = {34};
    const mu_ibl_settings_d s = mu_ibl_settings_default_d();
    const mu_ibl_settings_f sf = mu_ibl_settings_default_f();
    for (int i = 0; i < 5000; i++) {
        question q = any_question(&u);
        q.lobe.sigma[1] = q.lobe.sigma[0] / (3 + 3 * uniform_double(&u));
        bsdf_direction(0.7 + 0.3 * uniform_double(&u), 7 * uniform_double(&u), q.wo);
        const mu_ibl_lobe_f lobe = {{(float)q.lobe.sigma[0], (float)q.lobe.sigma[1]},
                                    {(float)q.lobe.turn[0], (float)q.lobe.turn[1]}, {0, 0}};
        const float wo[3] = {(float)q.wo[0], (float)q.wo[1], (float)q.wo[2]};
        mu_ibl_axis_d a;
        mu_ibl_axis_f f;
        mu_ibl_axis_make_d(&q.lobe, q.wo, &s, &a);
        mu_ibl_axis_make_f(&lobe, wo, &sf, &f);
        const double within = 24 * 0x1p-24 * 100;
        /* t near pi/2 may come out near -pi/2, and the points with it exchanged */
        const double flip = cos((double)f.t[1] - a.t[1]) < 0 ? -1 : 1;
        for (int k = 0; k < 3; k++)
            assert_true(fabs((double)f.far[0][k] - (k < 2 ? flip : 1) * a.far[0][k]) < within);
        assert_true(fabs((double)f.width - a.width) < within);
        assert_true(fabs((double)f.length - a.length) < within);
        assert_true(fabs((double)f.radius - a.radius) < within);
    }
}

static void test_batch(void **state) {
    (void)state;
    enum { COUNT = 100 };
    uniform u = {35};
    mu_ibl_lobe_d lobes[COUNT];
    double wo[4 * COUNT];
    mu_ibl_axis_d many[COUNT], one;
    const mu_ibl_settings_d s = mu_ibl_settings_default_d();
    for (int i = 0; i < COUNT; i++) {
        const question q = any_question(&u);
        lobes[i] = q.lobe;
        memcpy(wo + 4 * i, q.wo, sizeof q.wo);
    }
    for (size_t lobe_stride = 0; lobe_stride < 2; lobe_stride++)
        for (size_t stride = 0; stride < 5; stride += 4) {
            memset(many, 0, sizeof many);
            mu_ibl_axis_batch_d(COUNT, lobes, lobe_stride, wo, stride, &s, many);
            for (size_t i = 0; i < COUNT; i++) {
                memset(&one, 0, sizeof one);
                mu_ibl_axis_make_d(lobes + i * lobe_stride, wo + i * stride, &s, &one);
                assert_memory_equal(&one, many + i, sizeof one);
            }
        }
}

/* Views of one lobe several at a time: the same arithmetic, for samples, number by number. */
static void test_axes(void **state) {
    (void)state;
    uniform u = {36};
    mu_ibl_axes_d many;
    int cut = 0;
    for (int run = 0; run < 200; run++) {
        mu_ibl_settings_d s = mu_ibl_settings_default_d();
        const mu_ibl_lobe_d lobe = any_question(&u).lobe;
        double wo[3][MU_IBL_AXES];
        s.shift = run % 2 ? MU_IBL_PRINTED : MU_IBL_SYMMETRIC;
        for (int i = 0; i < MU_IBL_AXES; i++) {
            const question q = any_question(&u);
            for (int k = 0; k < 3; k++) wo[k][i] = q.wo[k];
        }
        mu_ibl_axes_make_d(&lobe, wo, &s, &many);
        for (int i = 0; i < MU_IBL_AXES; i++) {
            mu_ibl_axis_d one;
            mu_ibl_axis_make_for_samples_d(&lobe, (const double[3]){wo[0][i], wo[1][i], wo[2][i]}, &s, &one);
            cut += one.delta != 0;
            assert_true(many.radius[i] == one.radius);
            for (int k = 0; k < 2; k++)
                assert_true(many.along[k][i] == one.along[k] && many.middle[k][i] == one.middle[k] && many.reach[k][i] == one.reach[k]);
        }
    }
    assert_true(cut > 100 && cut < 200 * MU_IBL_AXES - 100); /* both kinds were among them */
}

static void test_level(void **state) {
    (void)state;
    assert_true(mu_ibl_level_d(0, 9) == 0 && mu_ibl_level_d(0.25, 9) == 4 && mu_ibl_level_d(1, 9) == 8);
    assert_true(mu_ibl_level_d(1.7, 9) == 8 && mu_ibl_level_d(0.3, 1) == 0 && mu_ibl_level_f(1, 3) == 2);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_third_of_the_slopes),
        cmocka_unit_test(test_a_third_of_a_histogram),
        cmocka_unit_test(test_sigma_of_ggx),
        cmocka_unit_test(test_mixing),
        cmocka_unit_test(test_above_the_horizon),
        cmocka_unit_test(test_float),
        cmocka_unit_test(test_batch),
        cmocka_unit_test(test_axes),
        cmocka_unit_test(test_level),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
