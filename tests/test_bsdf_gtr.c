/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_gtr.c: GTR against the closed forms of its Smith Lambda at gamma = 0, 1, 2, 3, 4, where no
 * quadrature is involved, and its table in float against double.
 */
#include "tests/bsdf_fixture.h"

static const double alphas[] = {1e-4, 1e-3, 0.0121, 0.1, 0.3, 0.7, 0.95, 1 - 1e-6};
static const double degrees[] = {0.01, 1, 20, 45, 70, 85, 89, 89.9, 89.99, 89.9999};
enum { ALPHAS = sizeof alphas / sizeof alphas[0], DEGREES = sizeof degrees / sizeof degrees[0] };

/* Cancellation-free forms of Eq. (35) to (39), with z = alpha² tan². */
static double closed_form(int gamma, double alpha, double tau) {
    const double a = alpha * alpha, z = a * tau * tau, s = sqrt(1 + z), one_a = (1 - alpha) * (1 + alpha);
    const double l2 = z / (2 * (1 + s)), l3 = z * z / (8 * s * (1 + z / 2 + s));
    const double p = 1 + 1.5 * z + 0.375 * z * z;
    const double l4 = z * z * z * (0.125 + 9 * z / 64) / (2 * s * s * s * (p + s * s * s));
    if (gamma == 0) return tau * tau / (2 * (1 + sqrt(1 + tau * tau)));
    if (gamma == 1) {
        const double big_a = s, big_b = sqrt(1 + tau * tau), d = one_a * tau * tau / (big_a + big_b);
        return (d - log1p(d / (1 + big_a))) / (-2 * log(alpha));
    }
    if (gamma == 2) return l2;
    if (gamma == 3) return (2 * a * l2 + one_a * l3) / (1 + a);
    return (3 * a * a * l2 + 3 * a * one_a * l3 + one_a * one_a * l4) / (1 + a + a * a);
}

/* Relative 2e-12: at gamma = 1, D - log1p(D...) loses up to tau² for small tau; elsewhere the closed forms
 * are good to a few units in the last place, and so must the quadrature be. */
static void lambda_equals_the_closed_forms(void **state) {
    (void)state;
    bsdf b;
    for (int gamma = 0; gamma <= 4; gamma++) {
        for (int i = 0; i < ALPHAS; i++) {
            for (int j = 0; j < DEGREES; j++) {
                const double theta = degrees[j] * TEST_PI / 180, wo[3] = {sin(theta), 0, cos(theta)};
                const double tau = wo[0] / wo[2];
                const mu_definition d = bsdf_definition(MU_GTR, alphas[i], gamma, 1, 0, 0, 1);
                bsdf_bind_double(&b, &d, wo);
                const double loss = gamma == 1 ? 2e-16 / fmin(1, tau * tau * tau * tau) : 0;
                bsdf_near(mu_view_d(&b.d, wo).Lambda, closed_form(gamma, alphas[i], tau), 2e-13 + loss);
            }
        }
    }
}

/* Through the neighbours of the integers, where every formula that divides by gamma - k would break. */
static void lambda_and_d_are_continuous_in_gamma(void **state) {
    (void)state;
    bsdf near, at;
    const double m[3] = {0.28, 0, 0.96};
    for (int gamma = 0; gamma <= 4; gamma++) {
        for (int i = 0; i < ALPHAS; i++) {
            const double wo[3] = {0.8, 0, 0.6};
            const mu_definition d = bsdf_definition(MU_GTR, alphas[i], gamma, 1, 0, 0, 1);
            bsdf_bind_double(&at, &d, wo);
            for (double e = -1e-9; e <= 1e-9; e += 2e-9) {
                if (gamma + e < 0) continue;
                const mu_definition n = bsdf_definition(MU_GTR, alphas[i], gamma + e, 1, 0, 0, 1);
                bsdf_bind_double(&near, &n, wo);
                /* d ln D / d gamma is at most 2 ln(1/alpha) plus a constant: 25 for alpha = 1e-4 */
                bsdf_near(mu_view_d(&near.d, wo).Lambda, mu_view_d(&at.d, wo).Lambda, 4e-8);
                bsdf_near(mu_normal_d(&near.d, m).D, mu_normal_d(&at.d, m).D, 4e-8);
            }
        }
    }
}

/* The table against the quadrature: G1 in float to 1e-6 everywhere, for alpha from 1e-4 to 1, gamma from 0
 * to 10. */
static void float_table_is_right(void **state) {
    (void)state;
    bsdf b;
    double worst = 0, worst_alpha = 0, worst_gamma = 0, worst_degrees = 0;
    for (double gamma = 0; gamma <= 10; gamma += 0.37) {
        for (int i = 0; i < ALPHAS; i++) {
            const mu_definition d = bsdf_definition(MU_GTR, alphas[i], gamma, 1, 0, 0, 1);
            const double up[3] = {0, 0, 1};
            bsdf_bind(&b, &d, up);
            for (int j = 0; j < 40; j++) {
                const double theta = atan(pow(10, -2 + 0.15 * j)); /* to 89.99 degrees and beyond */
                const float wf[3] = {(float)sin(theta), 0, (float)cos(theta)};
                const double w[3] = {(double)wf[0], 0, (double)wf[2]}; /* the very direction that float saw */
                const double expected = 1 / (1 + mu_view_d(&b.d, w).Lambda),
                             got = 1 / (1 + (double)mu_view_f(&b.f, wf).Lambda);
                if (fabs(got - expected) <= worst) continue;
                worst = fabs(got - expected), worst_alpha = alphas[i], worst_gamma = gamma,
                worst_degrees = theta * 180 / TEST_PI;
            }
        }
    }
    print_message("worst G1 error of GTR in float: %.2g (alpha %g, gamma %g, %.3f degrees)\n", worst,
                  worst_alpha, worst_gamma, worst_degrees);
    assert_true(worst < 1e-6);
}

/* Also where alpha² underflows, and c = P22 x² far out is a product of 0 and infinity if it is taken apart. */
static void lambda_is_finite_for_the_least_alpha(void **state) {
    (void)state;
    static const double least[] = {1e-150, 1e-160, 1e-300, 5e-324}, gammas[] = {0, 1e-9, 0.5};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 3; j++) {
            const double w[3] = {1e-20, 0, 1};
            const mu_definition d = bsdf_definition(MU_GTR, least[i], gammas[j], 1, 0, 0, 1);
            bsdf b;
            bsdf_bind_double(&b, &d, w);
            const double near = mu_view_d(&b.d, w).Lambda;
            assert_true(near >= 0 && near < 1e-40);
            /* c = (1 - gamma) (1 - a) / (1 - a^(1 - gamma)), in which a^(1 - gamma) is nothing here */
            if (least[i] < 1e-155) bsdf_near(near, (1 - gammas[j]) * 1e-40 / 4, 1e-14);
        }
}

/* What a sampler makes of 4000 points: the mean weight, or NAN where a number is none. */
static double mean_weight(double alpha, double gamma, mu_sampler sampler) {
    enum { COUNT = 4000 };
    const double wo[3] = {0.6, 0, 0.8};
    mu_definition d = bsdf_definition(MU_GTR, alpha, gamma, 1, 0, 0, 1);
    d.sampler = sampler;
    bsdf b;
    bsdf_bind_double(&b, &d, wo);
    double sum = 0;
    for (int k = 0; k < COUNT; k++) { /* R3, Roberts 2018 */
        const double u[3] = {fmod(0.5 + k * 0.8191725133961645, 1), fmod(0.5 + k * 0.6710436067037893, 1),
                             fmod(0.5 + k * 0.5497004779019703, 1)};
        mu_sample_d s;
        mu_sample_wi_d(&b.d, u, &s);
        if (!isfinite(s.wm[0] + s.wm[1] + s.wm[2] + s.pdf + s.weight[0])) return NAN;
        sum += s.rejected ? 0 : s.weight[0];
    }
    return sum / COUNT;
}

/* Below 1e-100 alpha changes what scatters at all by less than the discrepancy of the points, some ln(COUNT)³ / COUNT / 3! < 3 %:
 * the limit is P22 = (1 - gamma)/pi (1 + x)^(gamma-2) x^-gamma. Both samplers must go there, however little is left of alpha. */
static void samplers_need_no_alpha(void **state) {
    (void)state;
    static const double least[] = {1e-153, 1e-160, 1e-300, 5e-324}, gammas[] = {1e-9, 0.5, 0.9};
    for (int j = 0; j < 3; j++) {
        const double expected = mean_weight(1e-100, gammas[j], MU_SAMPLE_VISIBLE);
        for (int i = 0; i < 4; i++)
            for (mu_sampler sampler = MU_SAMPLE_VISIBLE; sampler <= MU_SAMPLE_NDF; sampler++)
                bsdf_near(mean_weight(least[i], gammas[j], sampler), expected, 0.03);
    }
}

/* For gamma in [1, 2) slopes are measured in alpha, and the tail has weight 1 / ln alpha at slopes of 1: where no map holds that
 * unit, the answer would be that of another alpha. D at slope 1 under the least alpha that passes, against Eq. (32): there
 * alpha² drops out but of a^(1-gamma) and ln a. Their exponents of 645 cost 645 roundings, and as many for the map's scale. */
static void what_no_map_holds_is_refused(void **state) {
    (void)state;
    const double scales[] = {1, 1e-20, 1e3, 1e100};
    for (double gamma = 1; gamma < 2; gamma += 0.1875)
        for (int i = 0; i < 4; i++) {
            const double s = scales[i], alpha = 1e-140 * fmax(s, 1), m = sqrt(0.5), x = s * s,
                         ln_a = 2 * log(alpha);
            const double c = gamma == 1 ? -1 / ln_a : (gamma - 1) / expm1((1 - gamma) * ln_a);
            const double up[3] = {0, 0, 1}, wm[3] = {m, 0, m};
            mu_definition d = bsdf_definition(MU_GTR, alpha, gamma, s, 0, 0, s);
            bsdf b;
            mu_complaint why;
            bsdf_bind_double(&b, &d, up);
            const double p22_x = c / TEST_PI * pow((1 + x) / x, gamma - 1) / (1 + x);
            bsdf_near(mu_normal_d(&b.d, wm).D, p22_x * 4, 2000 * 2.3e-16);
            d.alpha = 0.99e-140 * fmax(s, 1);
            assert_false(mu_definition_check(&d, &why));
            assert_string_equal(why.field, "alpha");
            d.alpha = 0;
            assert_true(mu_definition_check(&d, &why));
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(lambda_equals_the_closed_forms),
                                       cmocka_unit_test(lambda_and_d_are_continuous_in_gamma),
                                       cmocka_unit_test(float_table_is_right),
                                       cmocka_unit_test(lambda_is_finite_for_the_least_alpha),
                                       cmocka_unit_test(samplers_need_no_alpha),
                                       cmocka_unit_test(what_no_map_holds_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
