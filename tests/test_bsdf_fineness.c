/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_fineness.c: how fine the tables of compensation are is up to the definition: an error that they keep, refused out of
 * range; and one set of tables serves both precisions.
 */
#include "core/bsdf/albedo.h"
#include "tests/bsdf_fixture.h"
#include "tests/polar_albedo.h"

#include <stdlib.h>

typedef struct surface {
    void *memory;
    mu_surface_f *made;
} surface;

/* GGX of alpha 1, whose E from above is 1 - ln 2 (half-vectors are uniform over the disk: in closed form). */
static mu_definition compensated(void) {
    mu_definition d = bsdf_definition(MU_GGX, 1, 2, 1, 0, 0, 1);
    d.multiple = MU_COMPENSATED;
    return d;
}

static void make(surface *b, const mu_definition *d) {
    mu_complaint why;
    assert_true(mu_definition_check(d, &why));
    b->memory = aligned_alloc(64, (mu_surface_bytes_f(d) + 63) / 64 * 64);
    b->made = mu_surface_make_f(d, b->memory);
}

/* What the tables say of E is as near to the quadrature as was asked, at views they were not made from; and coarser tables are
 * smaller. Halving stops where a value midway is within half of the error along either axis, and 1e-3 is the quadrature's. */
static void tables_are_as_fine_as_asked(void **state) {
    (void)state;
    const double errors[] = {0.1, 0.02, 0.002};
    size_t before = 0;
    for (int i = 0; i < 3; i++) {
        mu_definition d = bsdf_definition(MU_GGX, 0.6, 2, 1, 2, 0, 1), single = d;
        surface b, plain;
        d.multiple = MU_COMPENSATED, d.compensation_error = errors[i];
        make(&b, &d);
        make(&plain, &single);
        assert_true(mu_surface_tables_unsure_f(b.made) == 0);
        for (int k = 0; k < 40; k++) {
            double wo[3];
            float average;
            mu_closure_f c;
            bsdf_direction(pow((k + 0.5) / 40, 3), 2.4 * k, wo);
            const float w[3] = {(float)wo[0], (float)wo[1], (float)wo[2]};
            assert_true(mu_bind_f(plain.made, w, NULL, &c));
            double off;
            const double E = polar_albedo(&c, 1, 1e-5, &off);
            assert_true(fabs((double)mu_albedo_f(b.made, w, &average) - E) < errors[i] + 1e-3);
        }
        assert_true(mu_surface_table_bytes_f(b.made) > before);
        before = mu_surface_table_bytes_f(b.made);
        free(b.memory);
        free(plain.memory);
    }
}

/* Tables of one precision serve the other: the same answers, and no second copy. */
static void tables_are_shared(void **state) {
    (void)state;
    mu_definition d = compensated();
    surface b;
    float of_f;
    double of_d;
    make(&b, &d);
    d.compensation_tables = mu_surface_tables_f(b.made), d.compensation_borrows = 1;
    assert_non_null(d.compensation_tables);
    assert_true(mu_surface_bytes_d(&d) < 4096);
    void *memory = aligned_alloc(64, (mu_surface_bytes_d(&d) + 63) / 64 * 64);
    const mu_surface_d *other = mu_surface_make_d(&d, memory);
    const float w[3] = {0.6f, 0, 0.8f};
    const double v[3] = {(double)w[0], 0, (double)w[2]};
    assert_true((double)mu_albedo_f(b.made, w, &of_f) == mu_albedo_d(other, v, &of_d));
    free(memory);
    free(b.memory);
}

static void wrong_numbers_are_refused(void **state) {
    (void)state;
    mu_definition d = compensated();
    mu_complaint why;
    const double wrong[] = {0, 0.6, NAN};
    for (int i = 0; i < 3; i++) {
        d.compensation_error = wrong[i];
        assert_false(mu_definition_check(&d, &why));
        assert_string_equal(why.field, "compensation_error");
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(tables_are_as_fine_as_asked),
                                       cmocka_unit_test(tables_are_shared),
                                       cmocka_unit_test(wrong_numbers_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
