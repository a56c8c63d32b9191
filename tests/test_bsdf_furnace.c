/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_furnace.c: compensated multiple scattering where its tables have most to follow, and after blurring.
 *
 * The furnace: F = 1, or glass whose reflected and transmitted light (importance) together are all that came; either is held
 * to 1 % and 4 standard errors of sampled weights.
 */
#include "tests/scattering_fixture.h"

#include <stdlib.h>

/* Where E changes fastest: strong anisotropy, a heavy tail under a mirror, a tilt, and glass that is skewed. */
static void compensation_holds_where_it_is_hard(void **state) {
    (void)state;
    static const struct {
        mu_ndf ndf;
        double alpha, gamma, map[4], tilt[2];
        int glass;
    } hard[] = {
        {MU_GGX, 0.5, 2, {1, 0, 0, 100}, {0, 0}, 0},     {MU_GGX, 1, 2, {10, 0, 0, 0.1}, {0, 0}, 0},
        {MU_BECKMANN, 1, 2, {0.3, 0, 0, 30}, {0, 0}, 0}, {MU_STD, 0.7, 1.6, {-1, 0.3, 0.2, 0.6}, {0, 0}, 0},
        {MU_GGX, 0.3, 2, {1, 0, 0, 1}, {1, 0.5}, 0},     {MU_GGX, 0.5, 2, {1, 2, 0, 1}, {0, 0}, 1},
        {MU_GTR, 0.3, 1, {1, 0, 0, 1}, {0, 0}, 1}};
    uniform u = {28};
    for (size_t k = 0; k < sizeof hard / sizeof hard[0]; k++) {
        const double *m = hard[k].map;
        mu_definition d = bsdf_definition(hard[k].ndf, hard[k].alpha, hard[k].gamma, m[0], m[1], m[2], m[3]);
        d.tilt[0] = hard[k].tilt[0], d.tilt[1] = hard[k].tilt[1];
        d.multiple = MU_COMPENSATED;
        if (hard[k].glass) d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1;
        scene b;
        make(&b, &d);
        for (int v = 0; v < 8 * (1 + hard[k].glass); v++) {
            double wo[3];
            moments energy = {0};
            bsdf_direction((double[]){0.98, 0.75, 0.5, 0.3, 0.12, 0.04, 0.01, 0.001}[v % 8], 1.3 * v, wo);
            for (int i = 0; i < 3; i++) wo[i] *= v < 8 ? 1 : -1;
            view(&b, wo);
            furnace(&b, &u, 10000, &energy);
            holds(&energy, 1, 0.01);
        }
        free(b.memory);
    }
}

/* Blurred, what is lost is that of the blurred surface: within 2 %, for its tables are coarser, and a factor of 2 apart. */
static void compensation_follows_blur(void **state) {
    (void)state;
    uniform u = {29};
    const double blurs[] = {0.1, 0.35, 1, 3};
    for (int k = 0; k < 12; k++) {
        static const double maps[][4] = {{1, 0, 0, 1}, {1, 2, 0, 1}, {-1, 0.3, 0.2, 0.6}};
        const double *m = maps[k % 3];
        mu_definition d = bsdf_definition((mu_ndf[]){MU_GGX, MU_GTR, MU_BECKMANN}[k / 4],
                                          (double[]){0.05, 0.3, 0.6}[k / 4], 0.4, m[0], m[1], m[2], m[3]);
        d.multiple = MU_COMPENSATED, d.compensation_blurs = 1;
        scene b;
        make(&b, &d);
        for (int v = 0; v < 4; v++) {
            double wo[3];
            moments energy = {0};
            bsdf_direction((double[]){1, 0.6, 0.2, 0.02}[v], k + v, wo);
            view(&b, wo);
            mu_blur_f(&b.c, (float)blurs[k % 4]);
            furnace(&b, &u, 10000, &energy);
            holds(&energy, 1, 0.02);
        }
        free(b.memory);
    }
}

/* Without tables for it (compensation_blurs) what is blurred scatters singly, bit by bit. */
static void blur_without_tables_is_single(void **state) {
    (void)state;
    for (int k = 0; k < 2; k++) {
        mu_definition d = bsdf_definition(MU_BECKMANN, 0.3, 2, 1, 2, 0, 1), once;
        if (k) d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1;
        once = d, d.multiple = MU_COMPENSATED;
        scene a, b;
        make(&a, &d), make(&b, &once);
        const double wo[3] = {0.6, 0.48, 0.64};
        const float wi[3] = {0.48f, -0.64f, 0.6f};
        mu_value_f x, y, sharp;
        view(&a, wo), view(&b, wo);
        mu_eval_f(&a.c, wi, &sharp);
        mu_blur_f(&a.c, 0.7f), mu_blur_f(&b.c, 0.7f);
        mu_eval_f(&a.c, wi, &x), mu_eval_f(&b.c, wi, &y);
        assert_true(x.f[0] > 0 && x.f[0] == y.f[0] && x.pdf == y.pdf && x.pdf_reverse == y.pdf_reverse);
        assert_true(sharp.f[0] != x.f[0]);
        free(a.memory), free(b.memory);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(compensation_holds_where_it_is_hard),
                                       cmocka_unit_test(blur_without_tables_is_single),
                                       cmocka_unit_test(compensation_follows_blur)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
