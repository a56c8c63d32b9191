/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_mirror.c: the surface without microfacets, level and tilted, against the laws of reflection and refraction written
 * down anew, and against the limit that it is: GGX under the same map and tilt, of a roughness that goes to 0.
 */
#include <float.h>

#include "tests/bsdf_fixture.h"

static void unit(double w[3]) {
    const double length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    for (int k = 0; k < 3; k++) w[k] /= length;
}

static double dot3(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The normal of the plane z = t.p after M: (-M^-T t, 1). */
static void leaning(const mu_definition *d, double m[3]) {
    const double *M = d->transform, det = M[0] * M[3] - M[1] * M[2];
    m[0] = -(M[3] * d->tilt[0] - M[2] * d->tilt[1]) / det;
    m[1] = -(-M[1] * d->tilt[0] + M[0] * d->tilt[1]) / det;
    m[2] = 1;
    unit(m);
}

static mu_definition mirror_of(uniform *u, int i) {
    mu_definition d = bsdf_definition(i & 1 ? MU_FLAT : MU_GGX, 0, 2, 1, 0, 0, 1);
    bsdf_random_map(u, d.transform);
    for (int k = 0; k < 2; k++) d.tilt[k] = i % 3 ? uniform_double(u) - 0.5 : 0;
    d.masking = (mu_masking_form)(i % MU_MASKING_COUNT);
    d.fresnel = MU_FRESNEL_DIELECTRIC, d.dielectric = i & 2 ? 1.5 : 0.7;
    d.transmission = i % 5 < 3;
    return d;
}

static double random_wo(uniform *u, double wo[3], int below) {
    bsdf_direction(0.05 + 0.95 * uniform_double(u), 2 * TEST_PI * uniform_double(u), wo);
    if (below) wo[2] = -wo[2];
    return wo[2];
}

/* To 32 roundings of unit vectors: reflection and refraction amplify those of m by 2 and by 1/cos, and cos is 0.03 at least. */
static void directions_obey_the_laws(void **state) {
    (void)state;
    uniform u = {.state = 20261126};
    int reflected = 0, refracted = 0, total = 0;
    for (int i = 0; i < 3000; i++) {
        const mu_definition d = mirror_of(&u, i);
        bsdf b;
        double wo[3], m[3];
        const double side = random_wo(&u, wo, d.transmission && i % 7 == 0) < 0 ? -1 : 1;
        bsdf_bind_double(&b, &d, wo);
        leaning(&d, m);
        const double uniforms[3] = {uniform_double(&u), uniform_double(&u), uniform_double(&u)};
        mu_sample_d s;
        mu_sample_wi_d(&b.d, uniforms, &s);
        const double facing = side * dot3(m, wo), eta = side > 0 ? d.dielectric : 1 / d.dielectric;
        if (s.rejected) {
            /* turned away, or lost below the horizon */
            const double up = 2 * facing * m[2] - side * wo[2];
            assert_true(facing <= 1e-12 || up <= 1e-12 || d.transmission);
            continue;
        }
        assert_true(s.delta && s.f[0] == 0 && facing > 0);
        for (int k = 0; k < 3; k++) assert_true(fabs(s.wm[k] - side * m[k]) < 32 * DBL_EPSILON);
        if (!s.transmitted) {
            reflected++;
            for (int k = 0; k < 3; k++)
                assert_true(fabs(s.wi[k] - (2 * dot3(m, wo) * m[k] - wo[k])) < 32 * DBL_EPSILON);
            total += facing < 0.7 && 1 - facing * facing > eta * eta;
            continue;
        }
        refracted++; /* eta wi + wo is along m: Snell's law as a vector */
        double across[3];
        for (int k = 0; k < 3; k++) across[k] = eta * s.wi[k] + wo[k];
        const double along = dot3(across, m);
        for (int k = 0; k < 3; k++) assert_true(fabs(across[k] - along * m[k]) < 64 * DBL_EPSILON);
        assert_true(s.wi[2] * wo[2] < 0 && s.eta == (side > 0 ? d.dielectric : 1 / d.dielectric));
    }
    assert_true(reflected > 500 && refracted > 300 && total > 20);
}

/* D's mean slope is alpha at most of its normals, so directions differ by some alpha, and weights, whose slope is 1/cos of both
 * directions, by some alpha / cos²: 100 alpha. The mean normal of GGX drawn at u = 1/2 is alpha off. */
static void the_limit_of_ggx(void **state) {
    (void)state;
    uniform u = {.state = 7};
    const double alpha = 1e-9;
    int compared = 0;
    for (int i = 0; i < 3000; i++) {
        const mu_definition d = mirror_of(&u, i);
        mu_definition rough = d;
        rough.ndf = MU_GGX, rough.alpha = alpha;
        bsdf flat, ggx;
        double wo[3];
        random_wo(&u, wo, d.transmission && i % 7 == 0);
        bsdf_bind_double(&flat, &d, wo);
        bsdf_bind_double(&ggx, &rough, wo);
        const double uniforms[3] = {0.5 * uniform_double(&u), uniform_double(&u), uniform_double(&u)};
        mu_sample_d s, t;
        mu_sample_wi_d(&flat.d, uniforms, &s);
        mu_sample_wi_d(&ggx.d, uniforms, &t);
        if (s.rejected || t.rejected || s.transmitted != t.transmitted || fabs(s.wi[2]) < 0.05) continue;
        double m[3];
        leaning(&d, m);
        if (fabs(dot3(m, wo)) < 0.1) continue;
        compared++;
        const double facing = fabs(dot3(m, s.wi)),
                     tolerance = 100 * alpha / fmin(facing, 1) / fmin(1, fabs(wo[2]));
        for (int k = 0; k < 3; k++) assert_true(fabs(s.wi[k] - t.wi[k]) < tolerance);
        bsdf_near(s.weight[0], t.weight[0], 20 * tolerance);
        const mu_masking_d a = mu_view_d(&flat.d, wo), c = mu_view_d(&ggx.d, wo);
        bsdf_near(a.sigma, c.sigma, 100 * alpha / fabs(wo[2]));
    }
    assert_true(compared > 1000);
}

/* Level, all light goes on: the weight is F, or 1 where F was the choice, to the last bit in both precisions. */
static void a_level_mirror_loses_nothing(void **state) {
    (void)state;
    uniform u = {.state = 3};
    for (int i = 0; i < 300; i++) {
        mu_definition d = mirror_of(&u, i);
        d.tilt[0] = d.tilt[1] = 0;
        d.fresnel = d.transmission ? MU_FRESNEL_DIELECTRIC : MU_FRESNEL_NONE;
        bsdf b;
        double wo[3];
        random_wo(&u, wo, 0);
        bsdf_bind(&b, &d, wo);
        b.d.importance = b.f.importance = 1;
        const double ud[3] = {0.3, 0.6, uniform_double(&u)};
        const float uf[3] = {0.3f, 0.6f, (float)ud[2]};
        mu_sample_d s;
        mu_sample_f t;
        mu_sample_wi_d(&b.d, ud, &s);
        mu_sample_wi_f(&b.f, uf, &t);
        assert_true(!s.rejected && !t.rejected && s.weight[0] == 1 && t.weight[0] == 1);
        mu_value_d v;
        mu_eval_d(&b.d, s.wi, &v);
        assert_true(v.f[0] == 0 && v.pdf == 0);
    }
}

/* Blurred, it is GGX of that roughness about its own mean slope. */
static void blur_stays_about_the_leaning_normal(void **state) {
    (void)state;
    uniform u = {.state = 11};
    for (int i = 0; i < 200; i++) {
        mu_definition d = mirror_of(&u, i);
        d.transmission = 0;
        double wo[3], m[3];
        random_wo(&u, wo, 0);
        leaning(&d, m);
        bsdf blurred, ggx;
        bsdf_bind_double(&blurred, &d, wo);
        mu_blur_d(&blurred.d, 0.2);
        mu_definition rough = bsdf_definition(MU_GGX, 0.2, 2, 1, 0, 0, 1);
        rough.masking = d.masking, rough.fresnel = d.fresnel, rough.dielectric = d.dielectric;
        rough.tilt[0] = -m[0] / m[2], rough.tilt[1] = -m[1] / m[2];
        bsdf_bind_double(&ggx, &rough, wo);
        for (int j = 0; j < 20; j++) {
            double wi[3];
            random_wo(&u, wi, 0);
            mu_value_d a, b;
            mu_eval_d(&blurred.d, wi, &a);
            mu_eval_d(&ggx.d, wi, &b);
            bsdf_near(a.f[0], b.f[0], 1e-10); /* tilts of up to 5, in units of 0.2, squared, of 1e-16 */
            bsdf_near(a.pdf, b.pdf, 1e-10);
        }
    }
}

/* What has no table and no walk is refused; a level mirror loses nothing, and takes both. */
static void multiple_scattering_is_refused_if_tilted(void **state) {
    (void)state;
    for (mu_scattering multiple = MU_COMPENSATED; multiple <= MU_RANDOM_WALK; multiple++) {
        mu_definition d = bsdf_definition(MU_FLAT, 0.3, 2, 1, 0, 0, 1);
        mu_complaint why;
        d.multiple = multiple;
        assert_true(mu_definition_check(&d, &why));
        d.tilt[1] = 0.1;
        assert_false(mu_definition_check(&d, &why));
        assert_string_equal(why.field, "multiple");
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_obey_the_laws), cmocka_unit_test(the_limit_of_ggx),
        cmocka_unit_test(a_level_mirror_loses_nothing), cmocka_unit_test(blur_stays_about_the_leaning_normal),
        cmocka_unit_test(multiple_scattering_is_refused_if_tilted)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
