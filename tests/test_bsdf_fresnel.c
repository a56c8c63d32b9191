/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_fresnel.c: reflectances against complex arithmetic, and against what optics says of special
 * angles. wo = wi turned about z, so that the angle at the half-vector is known.
 */
#include <complex.h>

#include "tests/bsdf_fixture.h"

static void reflectance(const mu_definition *d, double cosine, double out[3]) {
    const double sine = sqrt((1 - cosine) * (1 + cosine)), wo[3] = {sine, 0, cosine},
                 wi[3] = {-sine, 0, cosine};
    bsdf b;
    bsdf_bind(&b, d, wo);
    const mu_pair_values_d pair = mu_pair_d(&b.d, wi);
    const mu_pair_values_f single =
        mu_pair_f(&b.f, (const float[3]){(float)wi[0], (float)wi[1], (float)wi[2]});
    for (int k = 0; k < 3; k++) {
        out[k] = pair.F[k];
        assert_true(fabs((double)single.F[k] - out[k]) < 1e-5);
    }
}

/* Snell and Fresnel with a complex index; n² - sin² is written so that an index near 1 does not cancel. */
static double by_complex_numbers(double complex n, double c) {
    const double complex t = csqrt((n - 1) * (n + 1) + c * c);
    const double complex s = (c - t) / (c + t), p = (n * n * c - t) / (n * n * c + t);
    return (pow(cabs(s), 2) + pow(cabs(p), 2)) / 2;
}

static void metals_follow_complex_optics(void **state) {
    (void)state;
    mu_definition d = mu_definition_default();
    d.fresnel = MU_FRESNEL_CONDUCTOR;
    for (int i = 0; mu_metal_names[i]; i++) {
        assert_true(mu_metal(mu_metal_names[i], d.n, d.k));
        for (double c = 1; c > 1e-7; c *= 0.7) {
            double F[3];
            reflectance(&d, c, F);
            /* tolerance: 1 - F vanishes at grazing, and wo's own cosine is rounded */
            for (int k = 0; k < 3; k++) bsdf_near(F[k], by_complex_numbers(d.n[k] + I * d.k[k], c), 1e-12);
        }
    }
    assert_false(mu_metal("Xx", d.n, d.k));
}

static void dielectrics_follow_optics(void **state) {
    (void)state;
    mu_definition d = mu_definition_default();
    double F[3];
    d.fresnel = MU_FRESNEL_DIELECTRIC;
    static const double indices[] = {1.5, 1 / 1.5, 2.4, 1 + 0x1p-20, 0.3};
    for (int i = 0; i < 5; i++) {
        d.dielectric = indices[i];
        for (double c = 1; c > 1e-6; c *= 0.7) {
            reflectance(&d, c, F);
            /* absolute where F itself is near 0: eta - 1 carries its rounding twice */
            const double expected = by_complex_numbers(d.dielectric, c);
            assert_true(fabs(F[0] - expected) <= 1e-11 * expected + 1e-15);
        }
    }
    d.dielectric = 1.5;
    reflectance(&d, 1, F);
    bsdf_near(F[0], 0.04, 1e-14);
    d.dielectric = 1 / 1.5;
    reflectance(&d, 0.7, F); /* beyond the critical angle, cos 0.745 */
    assert_true(F[0] == 1);
    d.dielectric = 1;
    reflectance(&d, 0.3, F);
    assert_true(F[0] == 0);
}

static void schlick_has_its_ends(void **state) {
    (void)state;
    mu_definition d = mu_definition_default();
    double F[3];
    d.fresnel = MU_FRESNEL_SCHLICK;
    d.schlick[0] = 0.2, d.schlick[1] = 0.5, d.schlick[2] = 1;
    reflectance(&d, 1, F);
    for (int k = 0; k < 3; k++) bsdf_near(F[k], d.schlick[k], 1e-14);
    reflectance(&d, 1e-12, F);
    for (int k = 0; k < 3; k++) bsdf_near(F[k], 1, 1e-11);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(metals_follow_complex_optics),
                                       cmocka_unit_test(dielectrics_follow_optics),
                                       cmocka_unit_test(schlick_has_its_ends)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
