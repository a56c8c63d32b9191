/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_sample.c: samplers and evaluation tell one story; extremes stay finite; the mirror is a mirror.
 */
#include <float.h>
#include <string.h>

#include "tests/bsdf_fixture.h"

static const struct {
    mu_ndf ndf;
    double alpha, gamma;
} bases[] = {
    {MU_GGX, 0.3, 2}, {MU_BECKMANN, 0.2, 2}, {MU_GTR, 0.2, 0.3}, {MU_GTR, 0.05, 1.7}, {MU_GTR, 0.3, 4.5}};
enum { BASES = sizeof bases / sizeof bases[0] };

/* weight pdf = f cos, weight at most F = 1 by visible normals, and eval at the sampled wi says the same f and
 * pdf. 1e-12 is rounding; eval works from the rounded wi, which D of a narrow lobe multiplies by up to 1 /
 * (alpha cond). */
static void weight_times_pdf_is_f_cos(void **state) {
    (void)state;
    uniform u = {11};
    bsdf b;
    for (int i = 0; i < 2000; i++) {
        const int k = i % BASES;
        double m[4], wo[3];
        bsdf_random_map(&u, m);
        bsdf_direction(0.01 + 0.99 * uniform_double(&u), 7 * uniform_double(&u), wo);
        mu_definition d =
            bsdf_definition(bases[k].ndf, bases[k].alpha, bases[k].gamma, m[0], m[1], m[2], m[3]);
        d.sampler = i % 2 ? MU_SAMPLE_VISIBLE : MU_SAMPLE_NDF;
        bsdf_bind_double(&b, &d, wo);
        const double v[3] = {uniform_double(&u), uniform_double(&u), uniform_double(&u)};
        mu_sample_d s;
        mu_value_d e;
        mu_sample_wi_d(&b.d, v, &s);
        if (s.rejected) {
            assert_true(s.pdf == 0 && s.weight[0] == 0);
            continue;
        }
        bsdf_near(s.weight[0] * s.pdf, s.f[0] * s.wi[2], 1e-12);
        if (d.sampler == MU_SAMPLE_VISIBLE) assert_true(s.weight[0] <= 1);
        mu_eval_d(&b.d, s.wi, &e);
        bsdf_near(e.f[0], s.f[0], 1e-8);
        bsdf_near(e.pdf, s.pdf, 1e-8);
        bsdf_near(e.pdf_reverse, s.pdf_reverse, 1e-8);
    }
}

/* The mean of the weight is the albedo, whichever sampler draws: their difference within 5 standard errors of
 * 2e4 draws would be a coincidence of 6e-7; BASES comparisons. */
static void samplers_agree_on_the_albedo(void **state) {
    (void)state;
    uniform u = {12};
    bsdf b;
    for (int k = 0; k < BASES; k++) {
        const double wo[3] = {0.6, 0.3, sqrt(1 - 0.45)};
        const mu_definition d =
            bsdf_definition(bases[k].ndf, bases[k].alpha, bases[k].gamma, 1, 0.5, -0.2, 0.7);
        bsdf_bind_double(&b, &d, wo);
        double mean[2] = {0}, variance[2] = {0};
        const int n = 20000;
        for (int i = 0; i < 2 * n; i++) {
            const double v[3] = {uniform_double(&u), uniform_double(&u), uniform_double(&u)};
            mu_sample_d s;
            mu_sample_with_d(&b.d, i % 2 ? MU_SAMPLE_VISIBLE : MU_SAMPLE_NDF, v, &s);
            mean[i % 2] += s.weight[0] / n;
            variance[i % 2] += s.weight[0] * s.weight[0] / n;
        }
        const double error = sqrt((variance[0] - mean[0] * mean[0] + variance[1] - mean[1] * mean[1]) / n);
        assert_true(fabs(mean[0] - mean[1]) < 5 * error);
    }
}

/* Float against double at the same float inputs: 1e-4 where the arithmetic, not the input, is to blame. */
static void float_follows_double(void **state) {
    (void)state;
    uniform u = {13};
    bsdf b;
    for (int i = 0; i < 500; i++) {
        const int k = i % BASES;
        double m[4], w[2][3];
        float wf[2][3];
        bsdf_random_map(&u, m);
        for (int j = 0; j < 2; j++) {
            bsdf_direction(0.05 + 0.95 * uniform_double(&u), 7 * uniform_double(&u), w[j]);
            for (int c = 0; c < 3; c++) wf[j][c] = (float)w[j][c], w[j][c] = (double)wf[j][c];
        }
        const mu_definition d =
            bsdf_definition(bases[k].ndf, bases[k].alpha, bases[k].gamma, m[0], m[1], m[2], m[3]);
        bsdf_bind(&b, &d, w[0]);
        mu_value_d x;
        mu_value_f y;
        mu_eval_d(&b.d, w[1], &x);
        mu_eval_f(&b.f, wf[1], &y);
        if (x.f[0] < 1e-30) continue; /* Beckmann's tail: below float, or denormal there */
        bsdf_near((double)y.f[0], x.f[0], 1e-4);
        bsdf_near((double)y.pdf, x.pdf, 1e-4);
    }
}

static double choose(uniform *u, const double *values, size_t count) {
    return values[(size_t)(uniform_double(u) * (double)count)];
}

#define CHOOSE(u, values) choose(u, values, sizeof(values) / sizeof(values)[0])
#define FINITE(x, most)   assert_true((double)(x) >= 0 && (double)(x) <= (double)(most))

/* Nothing is NaN, infinite or negative at the ends of every range, in either precision. */
static void extremes_stay_finite(void **state) {
    (void)state;
    static const double alphas[] = {0x1p-30, 1e-7, 1e-4, 0.3, 1 - 1e-7, 1};
    static const double gammas[] = {0,        1e-300, 1e-9,     1 - 1e-9, 1,    1 + 1e-9,
                                    2 - 1e-9, 2,      2 + 1e-9, 10,       1000, 1e300};
    static const double cosines[] = {1, 0.5, 1e-3, 1e-9, 1e-20, 1e-38};
    static const double scales[] = {1e-30, 1e-12, 1e-4, 1, 1e4, 1e12, 1e30};
    uniform u = {14};
    bsdf b;
    for (int i = 0; i < 300; i++) {
        double m[4], w[3][3];
        float wi[3];
        bsdf_random_map(&u, m);
        const double scale = CHOOSE(&u, scales);
        if (i % 4 == 0) m[0] = m[1] = m[2] = 1, m[3] = 1 + 1e-8;
        const mu_definition d = bsdf_definition((mu_ndf)(i % 3), CHOOSE(&u, alphas), CHOOSE(&u, gammas),
                                                scale * m[0], scale * m[1], scale * m[2], scale * m[3]);
        for (int j = 0; j < 3; j++) bsdf_direction(CHOOSE(&u, cosines), 7 * uniform_double(&u), w[j]);
        if (i % 5 == 0) w[1][0] = -w[0][0], w[1][1] = -w[0][1];
        bsdf_bind(&b, &d, w[0]);
        mu_value_d x;
        mu_value_f y;
        mu_sample_f s;
        for (int c = 0; c < 3; c++) wi[c] = (float)w[1][c];
        mu_eval_d(&b.d, w[1], &x);
        mu_eval_f(&b.f, wi, &y);
        FINITE(x.f[0], DBL_MAX);
        FINITE(x.pdf, DBL_MAX);
        FINITE(y.f[0], FLT_MAX);
        FINITE(y.pdf, FLT_MAX);
        FINITE(y.pdf_reverse, FLT_MAX);
        const mu_normal_values_d n = mu_normal_d(&b.d, w[2]);
        FINITE(n.D, DBL_MAX);
        FINITE(n.G1, 1 + 1e-15);
        FINITE(n.Dv, DBL_MAX);
        const float v[3] = {i % 2 ? 0 : 1 - 0x1p-24f, uniform_float(&u), i % 3 ? 0 : 1 - 0x1p-24f};
        mu_sample_with_f(&b.f, i % 2 ? MU_SAMPLE_VISIBLE : MU_SAMPLE_NDF, v, &s);
        FINITE(s.weight[0], FLT_MAX);
        FINITE(s.pdf, FLT_MAX);
        FINITE(fabsf(s.wi[0]), 1.0001);
    }
}

/* Nothing of a surface this smooth falls below the horizon, to be folded: no rounding of a half-vector between two directions
 * that are all but opposite may say that something did. 1e-5: what float makes of G2 / G1. */
static void folding_knows_what_is_smooth(void **state) {
    (void)state;
    uniform u = {17};
    for (int i = 0; i < 4000; i++) {
        double wo[3];
        bsdf b;
        mu_sample_f s;
        mu_definition d = bsdf_definition(MU_BECKMANN, 0.3, 2, 1e6, 0, 0, i % 2 ? 1e6 : 1e12);
        bsdf_direction((double[]){1e-3, 1e-2}[i / 2 % 2], 7 * uniform_double(&u), wo);
        d.sampler = MU_SAMPLE_FOLDED;
        bsdf_bind(&b, &d, wo);
        mu_sample_wi_f(&b.f, (const float[]){uniform_float(&u), uniform_float(&u), uniform_float(&u)}, &s);
        assert_true(!s.rejected && s.weight[0] > 1 - 1e-5f);
    }
}

static void alpha_zero_is_a_mirror(void **state) {
    (void)state;
    bsdf b;
    const double wo[3] = {0.48, 0.6, 0.64}, wi[3] = {-0.48, -0.6, 0.64}, v[3] = {0.2, 0.3, 0.4};
    const mu_definition d = bsdf_definition(MU_GTR, 0, 1.7, 1, 2, 0, 1);
    mu_value_d e;
    mu_sample_d s;
    bsdf_bind_double(&b, &d, wo);
    mu_eval_d(&b.d, wi, &e);
    assert_true(e.f[0] == 0 && e.pdf == 0);
    mu_sample_wi_d(&b.d, v, &s);
    assert_true(s.delta && !s.rejected && s.weight[0] == 1 && s.pdf == 1);
    for (int k = 0; k < 3; k++) assert_true(s.wi[k] == wi[k]);
    assert_false(mu_bind_d(b.d.surface, (const double[3]){1, 0, 0}, NULL, &b.d));
    assert_false(mu_bind_d(b.d.surface, (const double[3]){0, 0, -1}, NULL, &b.d));
}

/* Blurred, a surface is GGX whose roughness matrix has no singular value below the bound: seen along both
 * axes. */
static void blur_widens_the_narrow_axis_only(void **state) {
    (void)state;
    bsdf b, expected;
    const double wo[3] = {0.48, 0.6, 0.64};
    const mu_definition d = bsdf_definition(MU_GGX, 0.2, 2, 10, 0, 0, -0.5); /* alpha 0.02 and 0.4 */
    const mu_definition e = bsdf_definition(MU_GGX, 0.2, 2, 2, 0, 0, -0.5);  /* alpha 0.1 and 0.4 */
    bsdf_bind_double(&b, &d, wo), bsdf_bind_double(&expected, &e, wo);
    mu_blur_d(&b.d, 0.1);
    for (int i = 0; i < 10; i++) {
        mu_value_d x, y;
        double wi[3];
        bsdf_direction(0.1 + 0.08 * i, i, wi);
        mu_eval_d(&b.d, wi, &x), mu_eval_d(&expected.d, wi, &y);
        bsdf_near(x.f[0], y.f[0], 1e-12);
        bsdf_near(x.pdf, y.pdf, 1e-12);
    }
}

/* A narrow lobe with a long tail has the width of its alpha to blur, on either side of gamma = 1. */
static void blur_knows_gtr_by_its_alpha(void **state) {
    (void)state;
    const double wo[3] = {0.48, 0.6, 0.64}, wi[3] = {-0.3, -0.5, 0.8124038404635961};
    const mu_definition e = bsdf_definition(MU_GGX, 0.1, 2, 1, 0, 0, 1);
    for (double gamma = 0.1; gamma < 4; gamma += 0.3) {
        bsdf b, expected;
        mu_value_d x, y;
        const mu_definition d = bsdf_definition(MU_GTR, 0.01, gamma, 1, 0, 0, 1);
        bsdf_bind_double(&b, &d, wo), bsdf_bind_double(&expected, &e, wo);
        mu_blur_d(&b.d, 0.1), mu_eval_d(&b.d, wi, &x);
        mu_eval_d(&expected.d, wi, &y);
        bsdf_near(x.f[0], y.f[0], 1e-12);
        mu_blur_d(&b.d, 0.05), mu_eval_d(&b.d, wi, &y); /* it is wide enough by now */
        assert_true(x.f[0] == y.f[0]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weight_times_pdf_is_f_cos),   cmocka_unit_test(samplers_agree_on_the_albedo),
        cmocka_unit_test(float_follows_double),        cmocka_unit_test(extremes_stay_finite),
        cmocka_unit_test(alpha_zero_is_a_mirror),      cmocka_unit_test(blur_widens_the_narrow_axis_only),
        cmocka_unit_test(blur_knows_gtr_by_its_alpha), cmocka_unit_test(folding_knows_what_is_smooth)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
