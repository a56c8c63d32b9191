/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_multiple.c: multiple scattering loses and makes no light, is reciprocal, contains single scattering, and costs
 * nothing where it is off.
 *
 * Random comparisons are Z-tests at the family's level (significance.h). A furnace holds compensation to 1 % and 4
 * standard errors: 1 % is what the tables were made for.
 */
#include "tests/scattering_fixture.h"

#include <stdlib.h>
#include <string.h>

static const struct base_case {
    mu_ndf ndf;
    double alpha, gamma, exponent;
} bases[] = {{MU_GGX, 0.05, 2, 0}, {MU_GGX, 1, 2, 0},     {MU_BECKMANN, 0.6, 2, 0}, {MU_GTR, 0.3, 0.4, 0},
             {MU_GTR, 0.8, 4, 0},  {MU_STD, 0.7, 1.7, 0}, {MU_PHONG, 0, 0, 4.0},    {MU_SHEEN, 0.4, 2, 0}};
static const double maps[][4] = {{1, 0, 0, 1}, {1, 2, 0, 1}, {-1, 0.3, 0.2, 0.6}};
enum { BASES = sizeof bases / sizeof bases[0], MAPS = sizeof maps / sizeof maps[0] };

/* Of compensation what does not depend on how fine tables are is tested of coarse ones, which are made sooner. */
enum { COARSE = 20 };
static mu_definition definition_of(int base, int m, mu_scattering multiple) {
    mu_definition d = bsdf_definition(bases[base].ndf, bases[base].alpha, bases[base].gamma, maps[m][0],
                                      maps[m][1], maps[m][2], maps[m][3]);
    d.exponent = bases[base].exponent;
    d.multiple = multiple;
    return d;
}

/* Walks end with all their light, but for those of more than 128 facets: 1e-4 of any surface here. */
static void walk_keeps_all_light(void **state) {
    (void)state;
    uniform u = {21};
    for (int k = 0; k < BASES * MAPS * 2; k++) {
        mu_definition d = definition_of(k % BASES, k / BASES % MAPS, MU_RANDOM_WALK);
        scene b;
        if (k >= BASES * MAPS) d.tilt[0] = 0.3, d.tilt[1] = -0.5;
        make(&b, &d);
        for (int v = 0; v < 4; v++) {
            double wo[3];
            moments energy = {0};
            bsdf_direction((double[]){1, 0.7, 0.2, 0.0087}[v], k + v, wo);
            view(&b, wo);
            furnace(&b, &u, 500, &energy);
            holds(&energy, 1, 1e-4);
        }
        free(b.memory);
    }
}

static void compensation_returns_what_is_lost(void **state) {
    (void)state;
    uniform u = {22};
    for (int k = 0; k < BASES * MAPS; k++) {
        const mu_definition d = definition_of(k % BASES, k / BASES, MU_COMPENSATED);
        scene b;
        make(&b, &d);
        for (int v = 0; v < 5; v++) {
            double wo[3];
            moments energy = {0};
            bsdf_direction((double[]){1, 0.7, 0.3, 0.07, 0.0087}[v], k + v, wo);
            view(&b, wo);
            furnace(&b, &u, 10000, &energy);
            holds(&energy, 1, 0.01);
        }
        free(b.memory);
    }
}

/* Of GGX with alpha = 1 seen from above: E = 1 - ln 2 (half-vectors are uniform over the disk: in closed form). */
static void table_knows_a_closed_form(void **state) {
    (void)state;
    const mu_definition d = definition_of(1, 0, MU_COMPENSATED);
    scene b;
    make(&b, &d);
    float average;
    const float up[3] = {0, 0, 1};
    bsdf_near((double)mu_albedo_f(b.s, up, &average), 1 - log(2), 1e-4);
    assert_true(average > 0.3f && average < 0.6f);
    free(b.memory);
}

/* From as rough to as smooth as M makes a surface: what leaves it at once is too little, or what it loses, for 1 - E to be told
 * from 1 or 0 in float. */
static void tables_know_every_scale(void **state) {
    (void)state;
    uniform u = {27};
    const double scales[] = {1e-12, 1e-6, 1e-5, 1e5, 1e12};
    for (int k = 0; k < 10; k++) {
        const double scale = scales[k / 2];
        mu_definition d = definition_of(0, k % 2, MU_COMPENSATED);
        for (int i = 0; i < 4; i++) d.transform[i] *= scale;
        scene b;
        make(&b, &d);
        for (int v = 0; v < 3; v++) {
            double wo[3];
            moments energy = {0};
            mu_value_f to;
            bsdf_direction((double[]){1, 0.7, 0.0087}[v], k + v, wo);
            view(&b, wo);
            furnace(&b, &u, 4000, &energy);
            holds(&energy, 1, 0.01);
            mu_eval_f(&b.c, (const float[]){0.6f, 0, 0.8f}, &to);
            assert_true(to.f[0] >= 0 && to.f[0] < 1); /* away from the mirror's direction, or diffuse */
        }
        free(b.memory);
    }
}

/* Rounding takes the place of no direction out of a table: next to the normal, 1 - (r / n)^2 may come out above 1. */
static void tables_hold_every_direction(void **state) {
    (void)state;
    uniform u = {28};
    for (int k = 0; k < 2; k++) { /* both interpolate in sqrt(S): a heavy tail, a tilt */
        mu_definition d = bsdf_definition(k ? MU_GGX : MU_STD, 1e-3, 1.7, 1, 0, 0, 1);
        d.multiple = MU_COMPENSATED, d.tilt[0] = k * 1e-3;
        scene b;
        make(&b, &d);
        for (int i = 0; i < 20000; i++) {
            const double sine = uniform_double(&u) / 2, phi = 7 * uniform_double(&u);
            float average;
            const float w[3] = {(float)(sine * cos(phi)), (float)(sine * sin(phi)),
                                (float)sqrt(1 - sine * sine)};
            const float E = mu_albedo_f(b.s, w, &average);
            assert_true(E >= 0.5f && E <= 1);
        }
        free(b.memory);
    }
}

/* Glass: both sides, all of it comes out again on one side or the other. */
static void glass_keeps_all_light(void **state) {
    (void)state;
    uniform u = {23};
    for (int k = 0; k < 4; k++) {
        const int walks = k < 2;
        mu_definition d = definition_of(k & 1 ? 1 : 2, 1, walks ? MU_RANDOM_WALK : MU_COMPENSATED);
        d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1;
        scene b;
        make(&b, &d);
        for (int v = 0; v < 6; v++) {
            double wo[3];
            moments energy = {0};
            bsdf_direction((double[]){0.95, 0.5, 0.1}[v % 3], 1.3 * (v % 3), wo);
            for (int i = 0; i < 3; i++) wo[i] *= v < 3 ? 1 : -1;
            view(&b, wo);
            furnace(&b, &u, 4000, &energy);
            holds(&energy, 1, walks ? 1e-4 : 0.01);
        }
        free(b.memory);
    }
}

/* What is evaluated is what is sampled: the mean of weight g(wi) by sampling, and of f cos g(wi) over uniform directions, for
 * g = |wi.z| on either side. */
static void evaluation_agrees_with_sampling(void **state) {
    (void)state;
    uniform u = {24};
    for (int k = 0; k < 24; k++) {
        mu_definition d = definition_of(k % 4 + 1, k / 4 % MAPS, k < 12 ? MU_RANDOM_WALK : MU_COMPENSATED);
        const int glass = k % 2;
        d.compensation_error = 1.0 / COARSE;
        if (glass) d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1;
        if (k % 3 == 0) d.tilt[0] = 0.2, d.tilt[1] = 0.1;
        scene b;
        make(&b, &d);
        double wo[3];
        bsdf_direction(0.3 + 0.02 * k, k, wo);
        for (int i = 0; i < 3; i++) wo[i] *= k % 4 == 3 ? -1 : 1;
        view(&b, wo);
        moments difference[2] = {{0, 0, 0}, {0, 0, 0}};
        for (int i = 0; i < 20000; i++) {
            mu_sample_f s;
            sample_once(&b, &u, &s);
            double w[3], sampled[2] = {0, 0};
            if (!s.rejected) sampled[s.wi[2] < 0] = (double)s.weight[0] * fabs((double)s.wi[2]);
            bsdf_direction(uniform_double(&u), 2 * TEST_PI * uniform_double(&u), w);
            for (int side = 0; side < 2; side++) {
                const float wi[3] = {(float)w[0], (float)w[1], (float)(side ? -w[2] : w[2])};
                mu_value_f v;
                mu_eval_f(&b.c, wi, &v);
                accumulate(&difference[side], sampled[side] - (double)v.f[0] * w[2] * w[2] * 2 * TEST_PI);
            }
        }
        for (int side = 0; side < 2; side++) agrees(&difference[side], 0, 1e-6, "sampled less evaluated");
        free(b.memory);
    }
}

/* A mean over salts at one pair of directions. */
static void mean_over_salts(mu_definition *d, const double wo[3], const double wi[3], int n, moments *f) {
    bsdf b;
    for (int i = 0; i < n; i++) {
        mu_value_d v;
        d->salt = (unsigned)i;
        bsdf_bind_double(&b, d, wo);
        mu_eval_d(&b.d, wi, &v);
        accumulate(f, v.f[0]);
    }
}

static void z_test(const moments *a, const moments *b, double scale) {
    const double x = a->sum / a->n, y = b->sum / b->n * scale;
    const double variance = (a->squares / a->n - x * x) / a->n +
                            scale * scale * (b->squares / b->n - y * y / scale / scale) / b->n;
    const double z = (x - y) / sqrt(fmax(variance, 1e-30));
    if (p_of_z(z) > significance_level()) return;
    print_error("means %.6g and %.6g differ: z = %.2f\n", x, y, z);
    fail();
}

/* f(wo, wi) = f(wi, wo); through glass, f(wo, wi) / n_o² = f(wi, wo) / n_i². */
static void walk_is_reciprocal(void **state) {
    (void)state;
    uniform u = {25};
    for (int k = 0; k < 10; k++) {
        mu_definition d = definition_of(1 + k % 2, k % MAPS, MU_RANDOM_WALK);
        const int glass = k >= 6, through = k >= 8;
        if (glass) d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1;
        if (k % 2) d.tilt[0] = 0.3, d.tilt[1] = -0.2;
        double wo[3], wi[3];
        moments there = {0}, back = {0};
        bsdf_direction(0.2 + 0.7 * uniform_double(&u), 7 * uniform_double(&u), wo);
        bsdf_direction(0.2 + 0.7 * uniform_double(&u), 7 * uniform_double(&u), wi);
        if (through) wi[2] = -wi[2];
        mean_over_salts(&d, wo, wi, 10000, &there);
        mean_over_salts(&d, wi, wo, 10000, &back);
        z_test(&there, &back, through ? 1 / (d.dielectric * d.dielectric) : 1);
    }
}

/* M = diag(alpha/alpha_x, alpha/alpha_y) on GGX of alpha is GGX of alpha 1 under diag(1/alpha_x, 1/alpha_y). */
static void walk_knows_the_map_alone(void **state) {
    (void)state;
    mu_definition one = bsdf_definition(MU_GGX, 0.5, 2, 0.5 / 0.9, 0, 0, 0.5 / 0.3),
                  other = bsdf_definition(MU_GGX, 1, 2, 1 / 0.9, 0, 0, 1 / 0.3);
    one.multiple = other.multiple = MU_RANDOM_WALK;
    const double wo[3] = {0.6, 0.48, 0.64}, wi[3] = {0.48, -0.64, 0.6};
    moments a = {0}, b = {0};
    mean_over_salts(&one, wo, wi, 10000, &a);
    mean_over_salts(&other, wo, wi, 10000, &b);
    z_test(&a, &b, 1);
}

/* Exact but for rounding: 1e-6 of float tables in either order. weight pdf = f cos where no walk is in between. */
static void compensation_is_pointwise(void **state) {
    (void)state;
    uniform u = {26};
    for (int k = 0; k < 12; k++) {
        mu_definition d = definition_of(k % BASES, k % MAPS, MU_COMPENSATED);
        d.compensation_error = 1.0 / COARSE;
        if (k % 2)
            d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1;
        else
            d.fresnel = MU_FRESNEL_CONDUCTOR;
        void *memory = aligned_alloc(64, (mu_surface_bytes_d(&d) + 63) / 64 * 64);
        mu_surface_d *s = mu_surface_make_d(&d, memory);
        for (int i = 0; i < 100; i++) {
            double wo[3];
            const double v[3] = {uniform_double(&u), uniform_double(&u), uniform_double(&u)};
            mu_closure_d c, back;
            mu_sample_d x;
            mu_value_d e, r;
            bsdf_direction(0.01 + 0.99 * uniform_double(&u), 7 * uniform_double(&u), wo);
            assert_true(mu_bind_d(s, wo, NULL, &c));
            mu_sample_wi_d(&c, v, &x);
            if (x.rejected) continue;
            mu_eval_d(&c, x.wi, &e);
            for (int j = 0; j < 3; j++) bsdf_near(x.weight[j] * x.pdf, x.f[j] * fabs(x.wi[2]), 1e-9);
            bsdf_near(e.f[0], x.f[0], 1e-6);
            bsdf_near(e.pdf, x.pdf, 1e-6);
            if (!mu_bind_d(s, x.wi, NULL, &back)) continue;
            mu_eval_d(&back, wo, &r);
            const double scale = x.transmitted ? 1 / (x.eta * x.eta) : 1;
            bsdf_near(r.f[0] * scale, e.f[0], 1e-6);
            bsdf_near(r.pdf, e.pdf_reverse, 1e-6);
        }
        free(memory);
    }
}

/* chi² of the compensated sampler against its pdf: 16 x 16 cells equal in solid angle, each pdf integrated at 24 x 24
 * points (its cells' steps leave 1 % of noise in the expected counts of 20000 draws: an eighth of their own). */
static void compensated_sampler_has_its_pdf(void **state) {
    (void)state;
    uniform u = {27};
    enum { SIDE = 16, FINE = 24, DRAWS = 20000 };
    for (int k = 0; k < 4; k++) {
        mu_definition d = definition_of((int[]){1, 2, 4, 7}[k], k % MAPS, MU_COMPENSATED);
        scene b;
        d.compensation_error = 1.0 / COARSE;
        make(&b, &d);
        double wo[3], expected[SIDE * SIDE] = {0}, count[SIDE * SIDE] = {0}, all = 0, rejected = 0;
        bsdf_direction(0.6, k, wo);
        view(&b, wo);
        for (int i = 0; i < SIDE * FINE; i++)
            for (int j = 0; j < SIDE * FINE; j++) {
                double w[3];
                mu_value_f v;
                bsdf_direction((i + 0.5) / (SIDE * FINE), 2 * TEST_PI * (j + 0.5) / (SIDE * FINE), w);
                const float wi[3] = {(float)w[0], (float)w[1], (float)w[2]};
                mu_eval_f(&b.c, wi, &v);
                const double share = (double)v.pdf * 2 * TEST_PI / (SIDE * FINE) / (SIDE * FINE);
                expected[i / FINE * SIDE + j / FINE] += share * DRAWS, all += share;
            }
        for (int i = 0; i < DRAWS; i++) {
            mu_sample_f s;
            sample_once(&b, &u, &s);
            if (s.rejected) {
                rejected++;
                continue;
            }
            const double phi = atan2((double)s.wi[1], (double)s.wi[0]) / (2 * TEST_PI);
            const int cell = (int)fmin((double)s.wi[2] * SIDE, SIDE - 1) * SIDE +
                             (int)fmin((phi < 0 ? phi + 1 : phi) * SIDE, SIDE - 1);
            count[cell]++;
        }
        double chi2 = pow(rejected - (1 - all) * DRAWS, 2) / fmax((1 - all) * DRAWS, 1);
        for (int i = 0; i < SIDE * SIDE; i++) chi2 += pow(count[i] - expected[i], 2) / fmax(expected[i], 1);
        assert_true(p_of_chi2(chi2, SIDE * SIDE) > significance_level());
        free(b.memory);
    }
}

/* Off, a surface is what it was: no byte more, and the same answers; a walk's pdf and value never leave the range. */
static void off_is_off(void **state) {
    (void)state;
    assert_int_equal(sizeof(mu_closure_f), offsetof(mu_closure_f, lobe) +
                                               sizeof(mu_lobe)); /* no more; the plugin leaves the end off */
    const mu_definition off = definition_of(1, 1, MU_SINGLE), walks = definition_of(1, 1, MU_RANDOM_WALK);
    assert_true(mu_surface_bytes_f(&off) < mu_surface_bytes_f(&walks));
    mu_definition d = definition_of(1, 1, MU_COMPENSATED);
    d.compensation_error = 1.0 / COARSE;
    const double m[4] = {1, 2, 0, 1};
    bsdf single;
    const double wo[3] = {0.6, 0.48, 0.64}, wi[3] = {0.48, -0.64, 0.6};
    void *memory = aligned_alloc(64, (mu_surface_bytes_d(&d) + 63) / 64 * 64);
    mu_surface_d *s = mu_surface_make_d(&d, memory);
    mu_closure_d c;
    mu_value_d x, y;
    bsdf_bind_double(&single, &off, wo);
    mu_eval_d(&single.d, wi, &x);
    assert_true(mu_bind_d(s, wo, m, &c)); /* an M of the point: tables do not hold, scattering is single */
    mu_eval_d(&c, wi, &y);
    bsdf_near(x.f[0], y.f[0], 1e-14);
    bsdf_near(x.pdf, y.pdf, 1e-14);
    mu_bind_d(s, wo, NULL, &c);
    mu_eval_d(&c, wi, &y);
    assert_true(y.f[0] > 1.05 * x.f[0]);
    free(memory);
}

static void refuses_what_it_cannot_do(void **state) {
    (void)state;
    mu_complaint why;
    mu_definition d = definition_of(1, 0, MU_RANDOM_WALK);
    d.masking = MU_SEPARABLE;
    assert_false(mu_definition_check(&d, &why));
    assert_string_equal(why.field, "multiple");
    d.masking = MU_HEIGHT_CORRELATED, d.sampler = MU_SAMPLE_NDF;
    assert_false(mu_definition_check(&d, &why));
    d = definition_of(0, 0, MU_COMPENSATED);
    d.tilt[0] = 1;
    assert_true(mu_definition_check(&d, &why));
    d.alpha = 0;
    assert_false(mu_definition_check(&d, &why));
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(walk_keeps_all_light),
                                       cmocka_unit_test(compensation_returns_what_is_lost),
                                       cmocka_unit_test(table_knows_a_closed_form),
                                       cmocka_unit_test(tables_know_every_scale),
                                       cmocka_unit_test(tables_hold_every_direction),
                                       cmocka_unit_test(glass_keeps_all_light),
                                       cmocka_unit_test(evaluation_agrees_with_sampling),
                                       cmocka_unit_test(walk_is_reciprocal),
                                       cmocka_unit_test(walk_knows_the_map_alone),
                                       cmocka_unit_test(compensation_is_pointwise),
                                       cmocka_unit_test(compensated_sampler_has_its_pdf),
                                       cmocka_unit_test(off_is_off),
                                       cmocka_unit_test(refuses_what_it_cannot_do)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
