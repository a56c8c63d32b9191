/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_laws.c: what holds of every distribution under M and a tilt, with every form of masking, from both sides of
 * what transmits; and that nothing at the ends of any range is NaN, infinite, negative or endless.
 * Tolerance 1e-11 unless said: two dozen double operations on inputs whose rounding M (condition below 100) amplifies.
 */
#include <float.h>

#include "tests/bsdf_fixture.h"

enum { CASES = 400 };
static const double tolerance = 1e-11;

static mu_definition random_surface(uniform *u, int i) {
    mu_definition d = mu_definition_default();
    d.ndf = (mu_ndf)(i % MU_FLAT);
    d.alpha = 0.05 + 0.8 * uniform_double(u);
    d.gamma = d.ndf == MU_STD ? 1.6 + 5 * uniform_double(u) : 5 * uniform_double(u);
    d.exponent = exp(6 * uniform_double(u));
    bsdf_random_map(u, d.transform);
    if (i % 2) d.tilt[0] = uniform_double(u) - 0.5, d.tilt[1] = uniform_double(u) - 0.5;
    return d;
}

static void random_direction(uniform *u, double w[3]) {
    bsdf_direction(0.02 + 0.98 * uniform_double(u), 7 * uniform_double(u), w);
}

static double shadowing(const mu_definition *d, mu_masking_form form, const double wo[3],
                        const double wi[3]) {
    mu_definition e = *d;
    bsdf b;
    e.masking = form;
    bsdf_bind_double(&b, &e, wo);
    return mu_pair_d(&b.d, wi).G2;
}

/* G1 G1 <= height <= direction <= min G1, all equal where one side is not masked; direction is G1 at wo = wi. */
static void masking_forms_are_in_order(void **state) {
    (void)state;
    uniform u = {31};
    for (int i = 0; i < CASES; i++) {
        const mu_definition d = random_surface(&u, i);
        double wo[3], wi[3];
        random_direction(&u, wo), random_direction(&u, wi);
        bsdf b;
        bsdf_bind_double(&b, &d, wo);
        const double lo = mu_view_d(&b.d, wo).Lambda, li = mu_view_d(&b.d, wi).Lambda,
                     least = fmin(1 / (1 + fmax(lo, 0)), 1 / (1 + fmax(li, 0)));
        double G2[3];
        for (int k = 0; k < 3; k++) G2[k] = shadowing(&d, (mu_masking_form)k, wo, wi);
        assert_true(G2[0] <= G2[1] * (1 + 1e-15) && G2[1] <= G2[2] * (1 + 1e-15) &&
                    G2[2] <= least * (1 + 1e-15));
        bsdf_near(shadowing(&d, MU_DIRECTION_CORRELATED, wo, wo), 1 / (1 + fmax(lo, 0)), tolerance);
        if (lo > 0) continue; /* then Lambda counts as 0 */
        for (int k = 0; k < 3; k++) bsdf_near(G2[k], 1 / (1 + fmax(li, 0)), tolerance);
    }
}

/* v' = (M v_xy, v_z + tilt.v_xy) sees after M what v sees before. */
static int deformed(const mu_definition *d, const double v[3], double out[3]) {
    const double *m = d->transform;
    out[0] = m[0] * v[0] + m[1] * v[1], out[1] = m[2] * v[0] + m[3] * v[1];
    out[2] = v[2] + d->tilt[0] * v[0] + d->tilt[1] * v[1];
    const double length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
    for (int k = 0; k < 3; k++) out[k] /= length;
    return out[2] > 0.02;
}

static void shadowing_is_invariant(void **state) {
    (void)state;
    uniform u = {32};
    int compared = 0;
    for (int i = 0; i < CASES; i++) {
        mu_definition d = random_surface(&u, i), original = d;
        d.tilt[0] = d.tilt[1] =
            0; /* it changes Lambda = sigma / cos - 1 with cos: M alone leaves G2 as it is */
        original.transform[0] = original.transform[3] = 1, original.transform[1] = original.transform[2] = 0;
        original.tilt[0] = original.tilt[1] = 0;
        double v[3], l[3], mv[3], ml[3];
        random_direction(&u, v), random_direction(&u, l);
        if (!deformed(&d, v, mv) || !deformed(&d, l, ml)) continue;
        for (int k = 0; k < 3; k++)
            bsdf_near(shadowing(&d, (mu_masking_form)k, mv, ml),
                      shadowing(&original, (mu_masking_form)k, v, l), tolerance);
        compared++;
    }
    assert_true(compared > CASES / 2);
}

/* f(wo,wi) eta² = f(wi,wo) with eta = n_i/n_o, and the pdfs change places; importance is eta² times radiance. */
static void refraction_is_reciprocal(void **state) {
    (void)state;
    uniform u = {33};
    int transmitted = 0;
    for (int i = 0; i < CASES; i++) {
        mu_definition d = random_surface(&u, i);
        d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1;
        d.dielectric = exp((0.1 + uniform_double(&u)) * (i % 3 ? 1 : -1));
        d.masking = (mu_masking_form)(i / 3 % 3);
        double wo[3], v[3];
        random_direction(&u, wo);
        if (i % 4 < 2)
            for (int k = 0; k < 3; k++) wo[k] = -wo[k];
        for (int k = 0; k < 3; k++) v[k] = uniform_double(&u);
        bsdf a, b;
        mu_sample_d s;
        mu_value_d x, y, z;
        bsdf_bind_double(&a, &d, wo);
        mu_sample_wi_d(&a.d, v, &s);
        if (s.rejected || fabs(s.wi[2]) < 0.01) continue;
        const double eta2 = s.transmitted ? s.eta * s.eta : 1;
        transmitted += s.transmitted;
        if (s.transmitted) bsdf_near(s.eta, wo[2] > 0 ? d.dielectric : 1 / d.dielectric, 1e-15);
        assert_int_equal(s.transmitted, s.wi[2] * wo[2] < 0);
        bsdf_near(s.weight[0] * s.pdf, s.f[0] * fabs(s.wi[2]), 1e-12);
        assert_true(s.weight[0] * eta2 <= 1 + 1e-15);
        bsdf_bind_double(&b, &d, s.wi);
        mu_eval_d(&a.d, s.wi, &x), mu_eval_d(&b.d, wo, &y);
        bsdf_near(y.f[0], x.f[0] * eta2,
                  1e-9); /* H of length |eta - 1| >= 0.09 and the lobe's width multiply roundings */
        bsdf_near(y.pdf, x.pdf_reverse, 1e-9);
        bsdf_near(y.pdf_reverse, x.pdf, 1e-9);
        bsdf_near(x.pdf, s.pdf, 1e-6); /* next to total reflection 1 - F multiplies them by more */
        a.d.importance = 1;
        mu_eval_d(&a.d, s.wi, &z);
        bsdf_near(z.f[0], x.f[0] * eta2, 1e-15);
    }
    assert_true(transmitted > CASES / 4);
}

static void float_follows_double(void **state) {
    (void)state;
    uniform u = {34};
    bsdf b;
    for (int i = 0; i < CASES; i++) {
        mu_definition d = random_surface(&u, i);
        d.masking = (mu_masking_form)(i / 2 % 3);
        if (i % 3 == 1) d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1;
        double w[2][3];
        float wf[2][3];
        for (int j = 0; j < 2; j++) {
            bsdf_direction(0.1 + 0.9 * uniform_double(&u), 7 * uniform_double(&u), w[j]);
            if (j && d.transmission && i % 2) w[j][2] = -w[j][2];
            for (int c = 0; c < 3; c++) wf[j][c] = (float)w[j][c], w[j][c] = (double)wf[j][c];
        }
        bsdf_bind(&b, &d, w[0]);
        mu_value_d x;
        mu_value_f y;
        mu_eval_d(&b.d, w[1], &x), mu_eval_f(&b.f, wf[1], &y);
        if (x.f[0] < 1e-30) continue;
        /* the half-vector of a lobe of alpha 0.05 under a map of condition 100; steep tails multiply it once more */
        bsdf_near((double)y.f[0], x.f[0], 2e-3);
        bsdf_near((double)y.pdf, x.pdf, 2e-3);
    }
}

static double any(uniform *u, const double *values, size_t count) {
    return values[(size_t)(uniform_double(u) * (double)count)];
}
#define ANY(u, values) any(u, values, sizeof(values) / sizeof(values)[0])
#define FINE(x, most)  assert_true((double)(x) >= 0 && (double)(x) <= (double)(most))

#define EXTREMES(suffix, type, most)                                                                         \
    static void extremes_##suffix(const mu_definition *d, void *memory, const double o[3],                   \
                                  const double i[3], const double r[3]) {                                    \
        const type wo[3] = {(type)o[0], (type)o[1], (type)o[2]},                                             \
                   wi[3] = {(type)i[0], (type)i[1], (type)i[2]};                                             \
        const type v[3] = {(type)r[0], (type)r[1], (type)r[2]};                                              \
        mu_closure_##suffix c;                                                                               \
        mu_value_##suffix e;                                                                                 \
        mu_sample_##suffix s;                                                                                \
        if (!mu_bind_##suffix(mu_surface_make_##suffix(d, memory), wo, NULL, &c)) return;                    \
        mu_eval_##suffix(&c, wi, &e);                                                                        \
        for (int k = 0; k < 3; k++) FINE(e.f[k], most);                                                      \
        FINE(e.pdf, most), FINE(e.pdf_reverse, most);                                                        \
        mu_sample_wi_##suffix(&c, v, &s);                                                                    \
        for (int k = 0; k < 3; k++)                                                                          \
            FINE(s.f[k], most), FINE(s.weight[k], most), FINE(fabs((double)s.wi[k]), 1.0001);                \
        FINE(s.pdf, most), FINE(s.pdf_reverse, most);                                                        \
        const mu_pair_values_##suffix p = mu_pair_##suffix(&c, wi);                                          \
        FINE(p.G2, 1.0001), FINE(p.F[0], 1.0001);                                                            \
    }
EXTREMES(f, float, FLT_MAX)
EXTREMES(d, double, DBL_MAX)

static void extremes_stay_finite(void **state) {
    (void)state;
    static const double alphas[] = {1e-300, 1e-30, 1e-12, 1e-4, 0.3, 1, 1e4, 1e30, 1e300};
    static const double gammas[] = {1e-300, 0.5,       1,   1 + 1e-12, 1.5 + 1e-12, 1.6,  2 - 1e-12,
                                    2,      2 + 1e-12, 2.6, 6,         1e3,         1e17, 1e300};
    static const double exponents[] = {0, 1e-300, 1, 100, 1e8, 1e30, 1e300};
    static const double tilts[] = {0, 0, 1e-20, 0.3, -1, 30, 1e8, -1e20};
    static const double etas[] = {1e-3, 0.5, 1 - 1e-9, 1, 1 + 1e-15, 1 + 1e-6, 1.5, 1e3};
    static const double cosines[] = {1, 0.5, 1e-3, 1e-9, 1e-20, 1e-38, 1e-300, 0};
    static const double scales[] = {1e-30, 1e-12, 1, 1, 1, 1e12, 1e30};
    static _Alignas(64) unsigned char memory[1 << 15];
    uniform u = {35};
    int shaded = 0;
    for (int i = 0; i < 1200; i++) {
        mu_definition d = random_surface(&u, i);
        const double scale = ANY(&u, scales);
        d.alpha = ANY(&u, alphas), d.gamma = ANY(&u, gammas), d.exponent = ANY(&u, exponents);
        if (d.ndf == MU_GTR) d.alpha = fmin(d.alpha, 1);
        d.tilt[0] = ANY(&u, tilts), d.tilt[1] = ANY(&u, tilts);
        for (int k = 0; k < 4; k++) d.transform[k] *= scale;
        d.masking = (mu_masking_form)(i / 6 % 3);
        d.sampler = (mu_sampler)(i / 18 % MU_SAMPLER_COUNT);
        if (i / 72 % 2)
            d.sampler = MU_SAMPLE_VISIBLE, d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1,
            d.dielectric = ANY(&u, etas);
        mu_complaint why;
        if (!mu_definition_check(&d, &why)) continue;
        double wo[3], wi[3];
        bsdf_direction(ANY(&u, cosines), 7 * uniform_double(&u), wo);
        bsdf_direction(ANY(&u, cosines), 7 * uniform_double(&u), wi);
        for (int k = 0; k < 3 && i % 5 == 0; k++) wi[k] = k == 2 ? wo[k] : -wo[k];
        for (int k = 0; k < 3 && i % 5 == 1; k++) wi[k] = -wo[k];
        if (i % 7 < 3) wi[2] = -wi[2];
        if (i % 11 < 4) wo[2] = -wo[2];
        const double edge = 1 - 0x1p-24, r[3] = {i % 3   ? uniform_double(&u) * edge
                                                 : i % 2 ? 0
                                                         : edge,
                                                 uniform_double(&u) * edge,
                                                 i % 4   ? uniform_double(&u) * edge
                                                 : i % 8 ? 0
                                                         : edge};
        assert_true(mu_surface_bytes_f(&d) <= sizeof memory && mu_surface_bytes_d(&d) <= sizeof memory);
        extremes_f(&d, memory, wo, wi, r);
        extremes_d(&d, memory, wo, wi, r);
        shaded++;
    }
    assert_true(shaded > 600);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(masking_forms_are_in_order), cmocka_unit_test(shadowing_is_invariant),
        cmocka_unit_test(refraction_is_reciprocal), cmocka_unit_test(float_follows_double),
        cmocka_unit_test(extremes_stay_finite)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
