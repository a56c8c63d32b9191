/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_ibl_walks.c: the albedo of a random walk's surface (core/ibl/walks.c) against means of the walks that its sampler takes.
 *
 * A mean of n weights has its own standard error, e; what is asked for has that which is allowed, or where that takes more walks than it may
 * (slopes of 1 and more) up to twice that. 63 comparisons exceed 5 of both together once in some 10^4 runs; seeds were fixed before the first.
 */
#include "tests/scattering_fixture.h"

#include "core/ibl/ibl.h"

enum { VIEWS = 3, WALKS = 1 << 17, CELLS = 8 };
static const double allowed = 3e-4;

/* Tilts, whose cliffs mask; a long tail; cells, noisy ones; M from 1.7:1 to 16:1. */
static const struct asked {
    mu_ndf ndf;
    double alpha, gamma, m[4], tilt[2];
} cases[] = {{MU_GGX, 0.5, 2, {1.5, 0.7, -0.3, 0.8}, {0, 0}},    {MU_GGX, 0.3, 2, {2, 0, 0, 0.5}, {0.4, 0.2}},
             {MU_GGX, 1, 2, {4, 0, 0, 0.25}, {0.3, 0.3}},        {MU_BECKMANN, 0.5, 2, {1.5, 0.7, -0.3, 0.8}, {0.3, -0.2}},
             {MU_STD, 0.4, 1.7, {1.5, 0.7, -0.3, 0.8}, {1, 0}},  {MU_TABULATED, 0, 2, {2, 0, 0, 0.5}, {0.2, -0.1}},
             {MU_TABULATED, 0, 2, {1, 0.4, 0, 1}, {0, 0}}};
enum { CASES = sizeof cases / sizeof *cases };

static mu_definition definition_of(const struct asked *a, const double cells[CELLS * CELLS]) {
    mu_definition d = bsdf_definition(a->ndf, a->alpha, a->gamma, a->m[0], a->m[1], a->m[2], a->m[3]);
    d.multiple = MU_RANDOM_WALK;
    for (int k = 0; k < 2; k++) d.tilt[k] = a->tilt[k];
    if (a->ndf != MU_TABULATED) return d;
    d.alpha = 1, d.histogram = cells, d.histogram_columns = d.histogram_rows = CELLS;
    for (int k = 0; k < 4; k++) d.histogram_bounds[k] = k % 2 ? 0.8 : -0.8;
    return d;
}

static mu_ibl_slopes still_of(const mu_definition *d) {
    mu_ibl_slopes still;
    mu_definition before = *d;
    for (int k = 0; k < 4; k++) before.transform[k] = k % 3 == 0;
    assert_true(mu_ibl_slopes_of(&before, &still));
    return still;
}

static void make_cells(double cells[CELLS * CELLS]) {
    uniform u = {41};
    for (int i = 0; i < CELLS * CELLS; i++) cells[i] = floor(5 * uniform_double(&u));
}

static void is_the_mean_of_walks(void **state) {
    (void)state;
    double cells[CELLS * CELLS], darkest = 1;
    uniform u = {42};
    make_cells(cells);
    for (int k = 0; k < CASES; k++) {
        mu_definition d = definition_of(&cases[k], cells);
        scene b;
        d.fresnel = MU_FRESNEL_SCHLICK, d.schlick[0] = 0.95, d.schlick[1] = 0.6, d.schlick[2] = 0.2;
        make(&b, &d);
        const mu_ibl_slopes still = still_of(&d);
        for (int v = 0; v < VIEWS; v++) {
            double wo[3], rgb[3];
            moments weight[3] = {{0, 0, 0}};
            bsdf_direction((double[]){0.9, 0.4, 0.03}[v], k + 2 * v, wo);
            view(&b, wo);
            assert_true(mu_ibl_albedo_of_walks_f(&b.c, &still, allowed, rgb));
            for (int i = 0; i < WALKS; i++) {
                mu_sample_f s;
                sample_once(&b, &u, &s);
                for (int c = 0; c < 3; c++) accumulate(&weight[c], s.rejected ? 0 : (double)s.weight[c]);
            }
            for (int c = 0; c < 3; c++) {
                const double n = weight[c].n, mean = weight[c].sum / n,
                             error = sqrt(fmax(weight[c].squares / n - mean * mean, 0) / n);
                if (!(fabs(rgb[c] - mean) <= 5 * hypot(error, 2 * allowed))) {
                    print_error("case %d, view %d: %.5f, walks %.5f +- %.5f\n", k, v, rgb[c], mean, error);
                    fail();
                }
                darkest = fmin(darkest, mean);
            }
        }
        free(b.memory);
    }
    assert_true(darkest < 0.3);
}

/* What loses nothing at a facet loses nothing at all, walk by walk: float's rounding is left. */
static void white_is_white(void **state) {
    (void)state;
    double cells[CELLS * CELLS];
    make_cells(cells);
    for (int k = 0; k < CASES; k++) {
        mu_definition d = definition_of(&cases[k], cells);
        scene b;
        double wo[3], rgb[3];
        make(&b, &d);
        const mu_ibl_slopes still = still_of(&d);
        bsdf_direction(0.3, k, wo);
        view(&b, wo);
        assert_true(mu_ibl_albedo_of_walks_f(&b.c, &still, allowed, rgb));
        for (int c = 0; c < 3; c++) assert_true(fabs(rgb[c] - 1) < 1e-5);
        free(b.memory);
    }
}

/* Nothing else is answered for: what scatters once, and what lets light pass. */
static void says_of_what(void **state) {
    (void)state;
    double rgb[3];
    scene b;
    mu_definition d = bsdf_definition(MU_GGX, 0.5, 2, 1, 0, 0, 1);
    const mu_ibl_slopes still = still_of(&d);
    make(&b, &d);
    view(&b, (const double[]){0, 0, 1});
    assert_false(mu_ibl_albedo_of_walks_f(&b.c, &still, allowed, rgb));
    free(b.memory);
    d.multiple = MU_RANDOM_WALK, d.fresnel = MU_FRESNEL_DIELECTRIC, d.dielectric = 1.5, d.transmission = 1;
    make(&b, &d);
    view(&b, (const double[]){0, 0, 1});
    assert_false(mu_ibl_albedo_of_walks_f(&b.c, &still, allowed, rgb));
    free(b.memory);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(is_the_mean_of_walks), cmocka_unit_test(white_is_white),
                                       cmocka_unit_test(says_of_what)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
