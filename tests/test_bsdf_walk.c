/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_walk.c: the parts of a random walk, by the number of facets that light meets: one facet is single scattering
 * (with the cliffs' masking where the surface is tilted), and what is left after many is next to nothing.
 */
#define MU_REAL_BITS 53
#include "core/bsdf/multiple.h"

#include "tests/bsdf_fixture.h"
#include "tests/moments.h"

static const struct {
    mu_ndf ndf;
    double alpha, gamma;
} bases[] = {{MU_GGX, 0.2, 2}, {MU_GGX, 1, 2}, {MU_BECKMANN, 0.7, 2}, {MU_SHEEN, 0.4, 2}, {MU_STD, 0.8, 1.7}};
enum { BASES = sizeof bases / sizeof bases[0] };

/* The mean over salts of f after one facet, against eval of single scattering; 200 salts at 100 pairs of directions,
 * whose differences add up. On a tilted surface, single scattering is masked by cliffs too, and a cliff alone sends light
 * on: both are known. T = M^-T t, sigma' = sigma + max(0, T.w). */
static void one_facet_is_single_scattering(void **state) {
    (void)state;
    uniform u = {31};
    for (int k = 0; k < 2 * BASES; k++) {
        mu_definition d = bsdf_definition(bases[k % BASES].ndf, bases[k % BASES].alpha,
                                          bases[k % BASES].gamma, 1, 0.5, -0.2, 0.7);
        const double t[2] = {k < BASES ? 0 : 0.4, k < BASES ? 0 : -0.3}, det = 0.7 + 0.1;
        const double T[2] = {(0.7 * t[0] + 0.2 * t[1]) / det, (-0.5 * t[0] + t[1]) / det};
        d.tilt[0] = t[0], d.tilt[1] = t[1];
        bsdf single;
        moments difference = {0, 0, 0};
        for (int pair = 0; pair < 100; pair++) {
            double wo[3], wi[3];
            bsdf_direction(0.1 + 0.9 * uniform_double(&u), 7 * uniform_double(&u), wo);
            bsdf_direction(0.1 + 0.9 * uniform_double(&u), 7 * uniform_double(&u), wi);
            bsdf_bind_double(&single, &d, wo);
            value v;
            single.d.kernel->plans[PLAN_FULL]->eval(&single.d, wi, &v);
            double expected = v.f[0];
            if (k >= BASES) {
                const mu_masking_d o = mu_view_d(&single.d, wo), i = mu_view_d(&single.d, wi);
                const double cliff_o = fmax(T[0] * wo[0] + T[1] * wo[1], 0),
                             cliff_i = fmax(T[0] * wi[0] + T[1] * wi[1], 0);
                const double plain = 1 + fmax(o.Lambda, 0) + fmax(i.Lambda, 0),
                             masked = 1 + o.Lambda + cliff_o / wo[2] + i.Lambda + cliff_i / wi[2];
                expected = v.f[0] * plain / masked +
                           cliff_o * cliff_i / hypot(T[0], T[1]) / TEST_PI / (wo[2] * wi[2] * masked);
            }
            moments f = {0, 0, 0};
            for (uint32_t salt = 0; salt < 200; salt++) {
                const multiple with = {.salt = salt, .average = {1, 1, 1}};
                double more[3];
                walk_estimate_d(single.d.kernel->plans[PLAN_FULL], &single.d, &with, wi, 1, 1, more);
                accumulate(&f, more[0]);
            }
            accumulate(&difference, (f.sum / f.n - expected) / expected);
        }
        agrees(&difference, 0, 1e-9, "one facet less single scattering, relative");
    }
}

/* Of 50000 walks on surfaces of alpha 1 to 4, those that have not left after 128 facets: below 1e-4 (p < 1e-6 to pass if it
 * were 4e-4). */
static void walks_end(void **state) {
    (void)state;
    uniform u = {32};
    int left = 0;
    for (int k = 0; k < 50; k++) {
        const double scale = 1.0 / (1 + k % 4);
        mu_definition d = bsdf_definition(bases[k % BASES].ndf, 1, 2, scale, 0, 0, scale);
        bsdf single;
        double wo[3];
        bsdf_direction(0.05 + 0.9 * uniform_double(&u), 1, wo);
        bsdf_bind_double(&single, &d, wo);
        const multiple with = {.average = {1, 1, 1}};
        for (int i = 0; i < 1000; i++) {
            const double v[3] = {uniform_double(&u), uniform_double(&u), uniform_double(&u)};
            walk_end end;
            walk_trace_d(single.d.kernel->plans[PLAN_FULL], &single.d, &with, v, &end);
            left += !(end.i[2] > 0);
        }
    }
    print_message("%d of 50000 walks do not end\n", left);
    assert_true(left <= 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(one_facet_is_single_scattering),
                                       cmocka_unit_test(walks_end)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
