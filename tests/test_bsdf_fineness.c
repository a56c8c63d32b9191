/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_fineness.c: how fine the tables of compensation are is up to the definition: cells and panels of its own, refused
 * out of range, 36 and 4 if nothing is said.
 */
#include "tests/bsdf_fixture.h"

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

/* Bilinear interpolation at E's known value, which lies amid a cell where their count is odd: its error is of second order in
 * the cell, a ninth for thrice the cells; a third is asked, for the coarsest are not there yet. From 1 (no table) three such
 * steps would leave 1/729 < 2e-3; and it is not 0, as it is at a node. Tables grow as (n + 1)² + n² floats, to a line of 64. */
static void tables_are_as_fine_as_asked(void **state) {
    (void)state;
    mu_definition d = compensated();
    const size_t usual = mu_surface_bytes_f(&d);
    const int sizes[] = {3, 9, 27}, nodes = d.compensation_cells + 1;
    double before = 1;
    assert_true(d.compensation_cells == 36 && d.compensation_panels == 4);
    for (int i = 0; i < 3; i++) {
        surface b;
        float average;
        const float up[3] = {0, 0, 1};
        d.compensation_cells = sizes[i];
        make(&b, &d);
        const double error = fabs((double)mu_albedo_f(b.made, up, &average) - (1 - log(2)));
        const int n = sizes[i] + 1,
                  values = nodes * nodes + (nodes - 1) * (nodes - 1) - n * n - sizes[i] * sizes[i];
        assert_true(error < before / 3);
        assert_true(fabs((double)usual - (double)mu_surface_bytes_f(&d) - 4.0 * values) < 64);
        before = error;
        free(b.memory);
    }
    assert_true(before < 2e-3 && before > 1e-6);
}

/* One panel misses an edge that 4 see (bench_albedo: by 0.03 at the worst view). */
static void panels_are_those_asked_for(void **state) {
    (void)state;
    mu_definition d = compensated();
    const double wo[3] = {0.6, 0, 0.8};
    double seen[2];
    for (int i = 0; i < 2; i++) {
        surface b;
        float average;
        const float w[3] = {(float)wo[0], (float)wo[1], (float)wo[2]};
        d.compensation_cells = 36, d.compensation_panels = i ? 4 : 1;
        make(&b, &d);
        seen[i] = (double)mu_albedo_f(b.made, w, &average);
        free(b.memory);
    }
    assert_true(seen[0] != seen[1] && fabs(seen[0] - seen[1]) < 0.05);
}

static void wrong_numbers_are_refused(void **state) {
    (void)state;
    mu_definition d = compensated();
    mu_complaint why;
    const int wrong[][2] = {{1, 4}, {257, 4}, {36, 0}, {36, 65}};
    for (int i = 0; i < 4; i++) {
        d.compensation_cells = wrong[i][0], d.compensation_panels = wrong[i][1];
        assert_false(mu_definition_check(&d, &why));
        assert_string_equal(why.field, i < 2 ? "compensation_cells" : "compensation_panels");
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(tables_are_as_fine_as_asked),
                                       cmocka_unit_test(panels_are_those_asked_for),
                                       cmocka_unit_test(wrong_numbers_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
