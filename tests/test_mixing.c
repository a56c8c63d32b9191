/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_mixing.c: bounded and folded visible normals, and the two samplers that mix in uniform directions, in float and
 * double.
 *
 * Reflected directions against the pdf that eval states, by chi² over the hemisphere, what is lost below the horizon being
 * one cell more; and their weights against those of visible normals.
 *
 * Cells are 8 x 16 in cos and azimuth, the pdf integrated over each by 24 x 24 midpoints. The distributions are wide
 * (alpha >= 0.3 after M): the rule's error, measured by halving its step, stays below 2e-5 of the whole, a hundredth of
 * the standard error sqrt(p / N) of the cells that count.
 */
#include <string.h>

#include "tests/bsdf_fixture.h"
#include "tests/significance.h"

enum { RINGS = 8, SECTORS = 16, CELLS = RINGS * SECTORS, FINE = 24, DRAWS = 40000 };

static const struct {
    mu_ndf ndf;
    double alpha, gamma, m[4], cosine;
    mu_sampler sampler;
} cases[] = {
    {MU_GGX, 0.5, 2, {1, 0, 0, 1}, 0.95, MU_SAMPLE_BOUNDED},
    {MU_GGX, 0.7, 2, {-1, 0, 0, 1}, 0.4, MU_SAMPLE_BOUNDED},
    {MU_GGX, 0.5, 2, {1.5, 0.4, 0.1, 0.7}, 0.7, MU_SAMPLE_BOUNDED},
    {MU_GGX,
     0.8,
     2,
     {0.4, 0, 0.3, -0.5},
     0.6,
     MU_SAMPLE_BOUNDED}, /* both singular values of M^-T alpha above 1 */
    {MU_GGX, 0.5, 2, {0.4, 0.1, 0, 1.3}, 0.2, MU_SAMPLE_BOUNDED},
    {MU_GGX, 0.5, 2, {1.2, 0.4, 0.1, 0.7}, 0.7, MU_SAMPLE_MIXED},
    {MU_GTR, 0.6, 1, {1, 0, 0, 1}, 0.5, MU_SAMPLE_MIXED},
    {MU_GTR, 0.6, 0.4, {1.2, 0.4, 0.1, 0.7}, 0.8, MU_SAMPLE_VISIBLE_UNIFORM},
    {MU_BECKMANN, 0.8, 2, {1, 0.5, 0, 1}, 0.6, MU_SAMPLE_VISIBLE_UNIFORM},
    {MU_GTR, 0.6, 0.4, {1.2, 0.4, 0.1, 0.7}, 0.75, MU_SAMPLE_FOLDED},
    {MU_GTR, 0.6, 0.4, {1.2, 0.4, 0.1, 0.7}, 0.5, MU_SAMPLE_FOLDED_UNIFORM},
    {MU_BECKMANN,
     1.2,
     2,
     {1, 0.5, 0, -1},
     0.25,
     MU_SAMPLE_FOLDED}, /* its pdf jumps at wi.z = wo.z: an edge of cells */
};
enum { CASES = sizeof cases / sizeof cases[0] };

static void bind(bsdf *b, size_t k) {
    double wo[3];
    const double *m = cases[k].m;
    mu_definition d = bsdf_definition(cases[k].ndf, cases[k].alpha, cases[k].gamma, m[0], m[1], m[2], m[3]);
    d.sampler = cases[k].sampler;
    bsdf_direction(cases[k].cosine, 0.7 + (double)k, wo);
    bsdf_bind(b, &d, wo);
}

/* Probability of each cell, and of none. */
static void expect(const bsdf *b, double p[CELLS + 1]) {
    double all = 0;
    for (int cell = 0; cell < CELLS; cell++) {
        p[cell] = 0;
        for (int k = 0; k < FINE * FINE; k++) {
            const double cosine = (cell / SECTORS + (k / FINE + 0.5) / FINE) / RINGS;
            const double phi = 2 * TEST_PI * (cell % SECTORS + (k % FINE + 0.5) / FINE) / SECTORS;
            double wi[3];
            mu_value_d value;
            bsdf_direction(cosine, phi, wi);
            mu_eval_d(&b->d, wi, &value);
            p[cell] += value.pdf * 2 * TEST_PI / (CELLS * FINE * FINE);
        }
        all += p[cell];
    }
    assert_true(all > 0.2 && all < 1 + 1e-4);
    p[CELLS] = fmax(0, 1 - all);
}

static int cell_of(const double wi[3]) {
    const double turn = atan2(wi[1], wi[0]) / (2 * TEST_PI);
    const int ring = (int)(wi[2] * RINGS), sector = (int)((turn < 0 ? turn + 1 : turn) * SECTORS);
    return (ring < RINGS ? ring : RINGS - 1) * SECTORS + (sector < SECTORS ? sector : 0);
}

static double p_of_counts(const double expected[CELLS + 1], const int counts[CELLS + 1]) {
    double x2 = 0, rest = 0;
    int rest_count = 0, cells = 0;
    for (int i = 0; i <= CELLS; i++) {
        const double e = expected[i] * DRAWS;
        if (e < 10) { /* rare cells are pooled */
            rest += e, rest_count += counts[i];
            continue;
        }
        x2 += (counts[i] - e) * (counts[i] - e) / e, cells++;
    }
    if (rest >= 10) x2 += (rest_count - rest) * (rest_count - rest) / rest, cells++;
    return p_of_chi2(x2, cells - 1);
}

static void directions_follow_the_pdf(void **state) {
    (void)state;
    uniform u = {20230801};
    for (size_t k = 0; k < CASES; k++) {
        bsdf b;
        bind(&b, k);
        double expected[CELLS + 1];
        int in_double[CELLS + 1] = {0}, in_float[CELLS + 1] = {0};
        expect(&b, expected);
        for (int n = 0; n < DRAWS; n++) {
            const double v[3] = {uniform_double(&u), uniform_double(&u), uniform_double(&u)};
            const float vf[3] = {(float)v[0] * 0x0.ffffffp0f, (float)v[1] * 0x0.ffffffp0f,
                                 (float)v[2] * 0x0.ffffffp0f};
            mu_sample_d s;
            mu_sample_f t;
            mu_sample_wi_d(&b.d, v, &s);
            mu_sample_wi_f(&b.f, vf, &t);
            in_double[s.rejected ? CELLS : cell_of(s.wi)]++;
            in_float[t.rejected ? CELLS
                                : cell_of((double[]){(double)t.wi[0], (double)t.wi[1], (double)t.wi[2]})]++;
        }
        const double p = p_of_counts(expected, in_double), q = p_of_counts(expected, in_float);
        if (!(p > significance_level() && q > significance_level()))
            fail_msg("case %zu: p = %g, %g", k, p, q);
    }
}

/* weight pdf = f cos, and eval says the same of the sampled direction; as in test_bsdf_sample.c. */
static void weights_and_eval_agree(void **state) {
    (void)state;
    uniform u = {20230802};
    for (size_t k = 0; k < CASES; k++) {
        bsdf b;
        bind(&b, k);
        for (int n = 0; n < 300; n++) {
            const double v[3] = {uniform_double(&u), uniform_double(&u), uniform_double(&u)};
            mu_sample_d s;
            mu_value_d e;
            mu_sample_wi_d(&b.d, v, &s);
            if (s.rejected) continue;
            bsdf_near(s.weight[0] * s.pdf, s.f[0] * s.wi[2], 1e-12);
            if (cases[k].sampler >= MU_SAMPLE_BOUNDED)
                assert_true(s.weight[0] <= (cases[k].sampler == MU_SAMPLE_FOLDED_UNIFORM ? 1 / 0.7 : 1));
            mu_eval_d(&b.d, s.wi, &e);
            bsdf_near(e.f[0], s.f[0], 1e-8);
            bsdf_near(e.pdf, s.pdf, 1e-8);
            bsdf_near(e.pdf_reverse, s.pdf_reverse, 1e-8);
            const mu_sample_d there = s;
            bsdf back = b;
            if (mu_bind_d(b.d.surface, there.wi, NULL, &back.d)) {
                mu_eval_d(&back.d, b.d.wo, &e);
                bsdf_near(e.pdf, there.pdf_reverse, 1e-8);
            }
        }
    }
}

/* The bound loses nothing that visible normals reflect upwards, and has fewer samples to reject: on a level surface seen
 * from above none at all. 5 standard errors of the difference of two means, as in test_bsdf_sample.c. */
static void the_bound_loses_no_light(void **state) {
    (void)state;
    uniform u = {20230803};
    for (size_t k = 0; k < CASES && cases[k].sampler == MU_SAMPLE_BOUNDED; k++) {
        bsdf b;
        bind(&b, k);
        double mean[2] = {0}, square[2] = {0}, rejected[2] = {0};
        for (int n = 0; n < DRAWS; n++) {
            const double v[3] = {uniform_double(&u), uniform_double(&u), uniform_double(&u)};
            for (int bounded = 0; bounded < 2; bounded++) {
                mu_sample_d s;
                mu_sample_with_d(&b.d, bounded ? MU_SAMPLE_BOUNDED : MU_SAMPLE_VISIBLE, v, &s);
                mean[bounded] += s.weight[0] / DRAWS, square[bounded] += s.weight[0] * s.weight[0] / DRAWS;
                rejected[bounded] += s.rejected;
            }
        }
        const double error = sqrt((square[0] - mean[0] * mean[0] + square[1] - mean[1] * mean[1]) / DRAWS);
        assert_true(fabs(mean[0] - mean[1]) < 5 * error);
        assert_true(rejected[1] < rejected[0]);
        assert_true(square[1] < square[0]);
    }
    const double up[3] = {0, 0, 1};
    mu_definition d = bsdf_definition(MU_GGX, 0.6, 2, 1, 0, 0, 1);
    d.sampler = MU_SAMPLE_BOUNDED;
    bsdf b;
    bsdf_bind_double(&b, &d, up);
    for (int n = 0; n < 1000; n++) {
        const double v[3] = {uniform_double(&u) * (1 - 1e-9), uniform_double(&u), 0};
        mu_sample_d s;
        mu_sample_wi_d(&b.d, v, &s);
        assert_false(s.rejected);
    }
}

static void what_it_does_not_know_is_refused(void **state) {
    (void)state;
    mu_definition d = mu_definition_default();
    mu_complaint why;
    d.sampler = MU_SAMPLE_BOUNDED;
    assert_true(mu_definition_check(&d, &why));
    d.tilt[0] = 0.1;
    assert_false(mu_definition_check(&d, &why));
    assert_string_equal(why.field, "sampler");
    d.tilt[0] = 0, d.ndf = MU_BECKMANN;
    assert_false(mu_definition_check(&d, &why));
    assert_string_equal(why.field, "sampler");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_follow_the_pdf), cmocka_unit_test(weights_and_eval_agree),
        cmocka_unit_test(the_bound_loses_no_light), cmocka_unit_test(what_it_does_not_know_is_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
