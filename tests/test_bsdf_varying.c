/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_varying.c: compensated multiple scattering under an M of the point: no light is lost or made, blurred or not, and
 * evaluation, sampling, density and exchanged directions agree. The furnace: F = 1, held to what the tables were made for
 * and 4 standard errors of sampled weights.
 */
#include "tests/scattering_fixture.h"

static mu_definition varying(mu_ndf ndf, double alpha, double error) {
    mu_definition d = bsdf_definition(ndf, alpha, 2, 1, 0, 0, 1);
    d.multiple = MU_COMPENSATED, d.compensation_varies = 1, d.compensation_error = error;
    d.compensation_blurs = 1;
    return d;
}

/* Any M, mirrors among them, by which slopes of roughness alpha become rough by 1/128 ... 2 along its axes. */
static void within(uniform *u, double alpha, float m[4]) {
    const double a = alpha * 128 / exp2(8 * uniform_double(u)), b = alpha * 128 / exp2(8 * uniform_double(u)),
                 s = 7 * uniform_double(u), t = 7 * uniform_double(u),
                 flip = uniform_double(u) < 0.5 ? -1 : 1;
    m[0] = (float)(a * cos(s) * cos(t) - flip * b * sin(s) * sin(t));
    m[1] = (float)(-a * cos(s) * sin(t) - flip * b * sin(s) * cos(t));
    m[2] = (float)(a * sin(s) * cos(t) + flip * b * cos(s) * sin(t));
    m[3] = (float)(-a * sin(s) * sin(t) + flip * b * cos(s) * cos(t));
}

static void view_under(scene *b, uniform *u, const float m[4]) {
    double w[3];
    bsdf_direction(0.002 + 0.998 * pow(uniform_double(u), 2), 7 * uniform_double(u), w);
    const float wo[3] = {(float)w[0], (float)w[1], (float)w[2]};
    assert_true(mu_bind_f(b->s, wo, m, &b->c));
}

static void furnace_under(const scene *b, uniform *u, double slack) {
    moments energy = {0};
    for (int i = 0; i < 8000; i++) {
        mu_sample_f s;
        sample_once(b, u, &s);
        accumulate(&energy, s.rejected ? 0 : (double)s.weight[0]);
    }
    const double mean = energy.sum / energy.n,
                 error = sqrt(fmax(energy.squares / energy.n - mean * mean, 0) / energy.n);
    if (fabs(mean - 1) <= slack + 4 * error) return;
    print_error("energy %.5f +- %.5f, expected 1 +- %.5f\n", mean, error, slack);
    fail();
}

/* As exact as with a constant M (test_bsdf_multiple.c): 1e-6 of float tables in either order. */
static void pointwise(const scene *b, uniform *u, const float m[4]) {
    for (int i = 0; i < 50; i++) {
        mu_sample_f x;
        mu_value_f e, r;
        mu_closure_f back;
        sample_once(b, u, &x);
        if (x.rejected || !(x.pdf < 1e20f) || !mu_bind_f(b->s, x.wi, m, &back)) continue;
        mu_eval_f(&b->c, x.wi, &e);
        mu_eval_f(&back, b->c.wo, &r);
        /* single scattering in float has 1e-3 in the core of the smoothest lobes: test_bsdf_precision.c bounds that */
        bsdf_near((double)x.weight[0] * (double)x.pdf, (double)x.f[0] * (double)x.wi[2], 1e-5);
        bsdf_near((double)r.f[0], (double)e.f[0], 1e-3);
        bsdf_near((double)r.pdf, (double)e.pdf_reverse, 1e-3);
    }
}

static void keeps_light_under_any_map(void **state) {
    (void)state;
    uniform u = {31};
    const mu_definition d = varying(MU_GGX, 0.3, 0.01);
    scene b;
    make(&b, &d);
    assert_true(mu_surface_tables_unsure_f(b.s) == 0);
    for (int k = 0; k < 60; k++) {
        float m[4];
        within(&u, d.alpha, m);
        view_under(&b, &u, m);
        furnace_under(&b, &u, 0.01);
        pointwise(&b, &u, m);
        mu_blur_f(&b.c, (float)exp2(-5 * uniform_double(&u)));
        furnace_under(&b, &u, 0.01);
    }
    free(b.memory);
}

/* Beckmann, and the GGX into which blurring turns it, at an error that takes less time. */
static void keeps_light_of_another(void **state) {
    (void)state;
    uniform u = {32};
    const mu_definition d = varying(MU_BECKMANN, 0.6, 0.05);
    scene b;
    make(&b, &d);
    for (int k = 0; k < 30; k++) {
        float m[4];
        within(&u, d.alpha, m);
        view_under(&b, &u, m);
        furnace_under(&b, &u, 0.05);
        mu_blur_f(&b.c, (float)exp2(-5 * uniform_double(&u)));
        furnace_under(&b, &u, 0.05);
    }
    free(b.memory);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(keeps_light_under_any_map),
                                       cmocka_unit_test(keeps_light_of_another)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
