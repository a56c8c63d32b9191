/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_tabulated_sample.c: the samplers of a slope histogram draw what they say: chi² of micronormals in quarters of
 * cells, whose probabilities are those of clipped polygons, under skewed and mirrored M and tilts that turn the surface away
 * from the viewer; by D cos and by visible normals, in double and in float.
 */
#include "tests/significance.h"
#include "tests/tabulated_fixture.h"

enum { COLUMNS = 7, ROWS = 5, PARTS = 2, BINS = COLUMNS * ROWS * PARTS * PARTS, DRAWS = 60000 };

static const struct view {
    double transform[4], tilt[2], cosine, phi;
} views[] = {{{1, 0, 0, 1}, {0, 0}, 1, 0},
             {{1, 0, 0, 1}, {0, 0}, 0.5, 0.7},
             {{1, 0, 0, 1}, {0, 0}, 1e-3, 3},
             {{1, 2, 0, 1}, {0, 0}, 0.7, 4},
             {{1, 2, 0, 1}, {0, 0}, 0.05, 1},
             {{-1.5, 0.2, 0.4, 0.8}, {0, 0}, 0.3, 5},
             {{0, 3, 0.3, 0}, {0, 0}, 0.1, 2},
             {{1, 0.3, -0.2, 0.7}, {0.5, -0.4}, 0.4, 0.1},
             {{1, 0, 0, 1}, {1, 0}, 0.5, 0.2},
             {{1, 0, 0, 1}, {1.2, 0}, 0.6, 0}, /* seen from behind */
             {{-1, 0.5, 0.2, 1}, {0.6, -1.5}, 0.3, 2}};
enum { VIEWS = sizeof views / sizeof views[0] };

static double weights[COLUMNS * ROWS];

static mu_definition definition_of(const struct view *v) {
    uniform u = {401};
    for (int i = 0; i < COLUMNS * ROWS; i++)
        weights[i] = uniform_double(&u) < 0.3 ? 0 : 0.05 + uniform_double(&u);
    mu_definition d = tabulated_definition(weights, COLUMNS, ROWS, -0.6, 0.9, -1.0, 0.5);
    for (int k = 0; k < 4; k++) d.transform[k] = v->transform[k];
    for (int k = 0; k < 2; k++) d.tilt[k] = v->tilt[k];
    return d;
}

static double probabilities(const mu_definition *d, const double w[3], int visible, double p[BINS]) {
    double total = 0;
    for (size_t k = 0; k < BINS; k++) {
        const size_t column = k / PARTS % COLUMNS, row = k / (PARTS * PARTS * COLUMNS);
        const int i = (int)(k % PARTS), j = (int)(k / (PARTS * COLUMNS) % PARTS);
        total += p[k] = tabulated_part(d, column, row, PARTS, i, j, w, !visible);
    }
    assert_true(total > 0);
    for (size_t k = 0; k < BINS; k++) p[k] /= total;
    return total;
}

/* The bin of a micronormal: its slope, M^T times it, less the tilt. */
static size_t bin_of(const mu_definition *d, const double m[3]) {
    const double *t = d->transform, *b = d->histogram_bounds, s[2] = {-m[0] / m[2], -m[1] / m[2]};
    const double x = (t[0] * s[0] + t[2] * s[1] - d->tilt[0] - b[0]) / (b[1] - b[0]) * (COLUMNS * PARTS),
                 y = (t[1] * s[0] + t[3] * s[1] - d->tilt[1] - b[2]) / (b[3] - b[2]) * (ROWS * PARTS);
    if (!(x > -1e-3 && x < COLUMNS * PARTS + 1e-3 && y > -1e-3 && y < ROWS * PARTS + 1e-3)) return BINS;
    const size_t i = (size_t)fmin(fmax(x, 0), COLUMNS * PARTS - 1),
                 j = (size_t)fmin(fmax(y, 0), ROWS * PARTS - 1);
    return j * COLUMNS * PARTS + i;
}

/* Bins of fewer than 5 expected draws are taken together. */
static void chi2(const double p[BINS], const unsigned counts[BINS + 1], const char *what, int view) {
    double x2 = 0, few_expected = 0, few = counts[BINS], degrees = -1;
    for (int k = 0; k < BINS; k++) {
        const double expected = p[k] * DRAWS;
        if (expected < 5) {
            few_expected += expected, few += counts[k];
            continue;
        }
        x2 += pow(counts[k] - expected, 2) / expected, degrees++;
    }
    if (few_expected >= 5) x2 += pow(few - few_expected, 2) / few_expected, degrees++;
    /* a handful of draws rounded into an empty neighbour, in float: 1e-3 of a draw's cell at most */
    if (few_expected < 5) assert_true(few <= few_expected + 30);
    const double significance = p_of_chi2(x2, degrees);
    print_message("%s, view %d: chi² %.1f of %g, p = %.3g\n", what, view, x2, degrees, significance);
    assert_true(significance > significance_level());
}

static void sampler_draws_its_density(mu_sampler sampler, int in_float) {
    for (int v = 0; v < VIEWS; v++) {
        const mu_definition d = definition_of(&views[v]);
        tabulated_surfaces s = tabulated_make(&d, in_float);
        double wo[3], p[BINS];
        unsigned counts[BINS + 1] = {0};
        bsdf_direction(views[v].cosine, views[v].phi, wo);
        const float wo_f[3] = {(float)wo[0], (float)wo[1], (float)wo[2]};
        const double sigma = probabilities(&d, wo, sampler == MU_SAMPLE_VISIBLE, p);
        mu_closure_d c;
        mu_closure_f f;
        assert_true(mu_bind_d(s.d, wo, NULL, &c));
        if (sampler == MU_SAMPLE_VISIBLE) bsdf_near(mu_view_d(&c, wo).sigma, sigma, 1e-12);
        if (in_float) assert_true(mu_bind_f(s.f, wo_f, NULL, &f));
        uniform u = {500 + (uint64_t)v};
        for (int i = 0; i < DRAWS; i++) {
            double m[3];
            if (in_float) {
                const float three[3] = {uniform_float(&u), uniform_float(&u), uniform_float(&u)};
                mu_sample_f out;
                mu_sample_with_f(&f, sampler, three, &out);
                for (int k = 0; k < 3; k++) m[k] = (double)out.wm[k];
            } else {
                const double three[3] = {uniform_double(&u), uniform_double(&u), uniform_double(&u)};
                mu_sample_d out;
                mu_sample_with_d(&c, sampler, three, &out);
                for (int k = 0; k < 3; k++) m[k] = out.wm[k];
            }
            counts[bin_of(&d, m)]++;
        }
        chi2(p, counts, sampler == MU_SAMPLE_VISIBLE ? "visible" : "D cos", v);
        tabulated_free(&s);
    }
}

static void slopes_in_double(void **state) {
    (void)state;
    sampler_draws_its_density(MU_SAMPLE_NDF, 0);
}
static void slopes_in_float(void **state) {
    (void)state;
    sampler_draws_its_density(MU_SAMPLE_NDF, 1);
}
static void visible_in_double(void **state) {
    (void)state;
    sampler_draws_its_density(MU_SAMPLE_VISIBLE, 0);
}
static void visible_in_float(void **state) {
    (void)state;
    sampler_draws_its_density(MU_SAMPLE_VISIBLE, 1);
}

/* weight pdf = f cos, to rounding; and eval tells of the drawn direction what the sample did. */
static void weight_times_pdf_is_f_cos(void **state) {
    (void)state;
    uniform u = {402};
    int elsewhere = 0;
    for (int v = 0; v < VIEWS; v++) {
        const mu_definition d = definition_of(&views[v]);
        tabulated_surfaces s = tabulated_make(&d, 0);
        double wo[3];
        mu_closure_d c;
        bsdf_direction(views[v].cosine, views[v].phi, wo);
        assert_true(mu_bind_d(s.d, wo, NULL, &c));
        for (int i = 0; i < 1000; i++) {
            const double three[3] = {uniform_double(&u), uniform_double(&u), uniform_double(&u)};
            mu_sample_d out;
            mu_value_d e;
            mu_sample_with_d(&c, i % 2 ? MU_SAMPLE_VISIBLE : MU_SAMPLE_NDF, three, &out);
            if (out.rejected) continue;
            bsdf_near(out.weight[0] * out.pdf, out.f[0] * out.wi[2], 1e-12);
            assert_true(out.pdf > 0);
            mu_eval_d(&c, out.wi, &e);
            elsewhere += fabs(e.f[0] - out.f[0]) > 1e-8 * out.f[0]; /* rounded into the next cell */
        }
        tabulated_free(&s);
    }
    assert_true(elsewhere <= 2);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(slopes_in_double), cmocka_unit_test(slopes_in_float),
                                       cmocka_unit_test(visible_in_double),
                                       cmocka_unit_test(visible_in_float),
                                       cmocka_unit_test(weight_times_pdf_is_f_cos)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
