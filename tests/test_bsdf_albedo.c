/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_bsdf_albedo.c: the directional albedo by which compensation is made is that of samples, where slopes and the horizon are
 * of very different scales; and a furnace closes over what is made of it.
 *
 * Views: from above and near the horizon, about the axes of M, where slopes change the most. Samples of visible normals in double
 * know no quadrature. Held to 4 standard errors of their mean weight, and 3e-3, three times what the quadrature is asked for
 * (its estimate, of Gauss's nodes among Kronrod's, is the larger of both rules' errors); a furnace to 1 %, which tables are made for.
 */
#include "core/bsdf/albedo.h"
#include "core/bsdf/singular.h"
#include "tests/bsdf_fixture.h"
#include "tests/moments.h"
#include "tests/polar_albedo.h"

#include <stdlib.h>

static const struct hostile {
    mu_ndf ndf;
    double alpha, gamma, m[4], tilt[2];
    int glass;
} all[] = {{MU_STD,
            0.01,
            10,
            {-171.8087173191751, 3215.5486233416405, -505.12548041940414, 9453.865720677964},
            {0, 0},
            0},
           {MU_GGX, 0.3, 2, {0.01, 0, 0, 100}, {0.3, 0.2}, 1},
           {MU_GGX, 0.3, 2, {1e-4, 0, 0, 1e4}, {0, 0}, 1},
           {MU_GGX, 0.01, 2, {1, 0.5, 0, 1}, {0.4, -0.3}, 0},
           {MU_BECKMANN, 0.3, 2, {1, 2, 0, 1}, {0.5, -0.8}, 1},
           {MU_BECKMANN, 0.3, 2, {0.01, 0.2, 0, 0.01}, {0.5, -0.8}, 1}};

static mu_definition definition_of(const struct hostile *h) {
    mu_definition d = bsdf_definition(h->ndf, h->alpha, h->gamma, h->m[0], h->m[1], h->m[2], h->m[3]);
    d.tilt[0] = h->tilt[0], d.tilt[1] = h->tilt[1];
    if (h->glass) d.fresnel = MU_FRESNEL_DIELECTRIC, d.transmission = 1;
    return d;
}

/* M = R(turn) times what is left, in which float holds the surface. */
static double take_turn(mu_definition *d) {
    const singular s = singular_of(d->transform);
    const double right = (s.sum - s.difference) / 2, c = cos(right), sine = sin(right);
    const double m[4] = {s.large * c, -s.large * sine, s.small * sine, s.small * c};
    for (int k = 0; k < 4; k++) d->transform[k] = m[k];
    return (s.sum + s.difference) / 2;
}

static void view_of(int k, uniform *u, int below, double w[3]) {
    const double z = k % 2 ? uniform_double(u) : exp2(-14 * uniform_double(u));
    const double phi = k % 3 ? 7 * uniform_double(u) : TEST_PI / 2 * k + 0.02 * uniform_double(u) - 0.01;
    bsdf_direction(z, phi, w);
    for (int i = 0; i < 3 && below; i++) w[i] = -w[i];
}

static void *memory_for(size_t bytes) {
    return aligned_alloc(64, (bytes + 63) / 64 * 64);
}

static void sample_energy(mu_closure_d *c, uniform *u, int n, moments *energy) {
    c->importance = 1;
    for (int i = 0; i < n; i++) {
        const double v[3] = {uniform_double(u), uniform_double(u), uniform_double(u)};
        mu_sample_d s;
        mu_sample_wi_d(c, v, &s);
        accumulate(energy, s.rejected ? 0 : s.weight[0]);
    }
}

static void near_mean(const moments *m, double value, double slack) {
    const double mean = m->sum / m->n, error = sqrt(fmax(m->squares / m->n - mean * mean, 0) / m->n);
    if (fabs(mean - value) <= slack + 4 * error) return;
    print_error("%.5f, but the mean of samples is %.5f +- %.5f\n", value, mean, error);
    fail();
}

static void measure(const mu_surface_f *s, double core, albedo_lengths *out) {
    const float up[3] = {0, 0, 1};
    mu_closure_f c;
    assert_true(mu_bind_f(s, up, NULL, &c));
    mu_albedo_lengths_of(&c, core, out);
}

static void quadrature_is_the_mean_of_samples(void **state) {
    (void)state;
    uniform u = {41};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
        mu_definition d = definition_of(&all[k]);
        take_turn(&d);
        void *const memory[2] = {memory_for(mu_surface_bytes_f(&d)), memory_for(mu_surface_bytes_d(&d))};
        const mu_surface_f *single = mu_surface_make_f(&d, memory[0]);
        const mu_surface_d *sampled = mu_surface_make_d(&d, memory[1]);
        albedo_lengths lengths;
        measure(single, 1, &lengths);
        for (int v = 0; v < 12; v++) {
            double w[3];
            mu_closure_f c;
            mu_closure_d other;
            moments energy = {0};
            albedo_effort effort = {0, 0};
            view_of(v, &u, all[k].glass && v % 4 > 1, w);
            const float wf[3] = {(float)w[0], (float)w[1], (float)w[2]};
            assert_true(mu_bind_f(single, wf, NULL, &c) && mu_bind_d(sampled, w, NULL, &other));
            sample_energy(&other, &u, 4000, &energy);
            near_mean(&energy, (double)albedo_integral_f(&c, &lengths, 1e-3, &effort), 3e-3);
            assert_true(effort.off <= 0 && effort.facets < 34000);
        }
        free(memory[0]);
        free(memory[1]);
    }
}

/* And that of another quadrature, of every kind of slopes, through glass. */
static void quadrature_is_that_of_another(void **state) {
    (void)state;
    uniform u = {43};
    static const struct hostile others[] = {
        {MU_STD, 0.3, 1.6, {0.01, 0, 0, 100}, {0, 0}, 1},  {MU_STD, 0.3, 1.6, {1, 2, 0, 1}, {0.3, 0.2}, 1},
        {MU_SHEEN, 0.4, 2, {0.1, 0, 0, 10}, {0, 0}, 1},    {MU_GTR, 0.3, 0.4, {1, 0, 0, 1e4}, {0, 0}, 1},
        {MU_GTR, 0.5, 4, {1e-4, 0, 0, 1}, {0, 0}, 1},      {MU_GGX, 0.3, 2, {6, 0, 0, 6}, {2.5, 1.66}, 1},
        {MU_BECKMANN, 0.3, 2, {1, 0, 0, 1}, {0.9, 0.6}, 0}};
    for (size_t k = 0; k < sizeof others / sizeof others[0]; k++) {
        const mu_definition d = definition_of(&others[k]);
        void *const memory = memory_for(mu_surface_bytes_f(&d));
        const mu_surface_f *s = mu_surface_make_f(&d, memory);
        const double core = d.ndf == MU_GTR ? d.alpha : 1;
        albedo_lengths lengths;
        measure(s, core, &lengths);
        for (int v = 0; v < 16; v++) {
            double w[3], off;
            mu_closure_f c;
            view_of(v, &u, others[k].glass && v % 4 > 1, w);
            assert_true(mu_bind_f(s, (const float[]){(float)w[0], (float)w[1], (float)w[2]}, NULL, &c));
            const double E = (double)albedo_integral_f(&c, &lengths, 1e-3, NULL),
                         other = polar_albedo(&c, core, 3e-4, &off);
            if (fabs(E - other) > 3e-3 + off)
                fail_msg("case %zu, view %g %g %g: %.5f, but %.5f", k, w[0], w[1], w[2], E, other);
        }
        free(memory);
    }
}

static void furnace_closes_where_axes_differ_by_1e8(void **state) {
    (void)state;
    uniform u = {42};
    mu_definition d = definition_of(&all[0]), turned = d;
    const double turn = take_turn(&turned);
    d.multiple = MU_COMPENSATED;
    void *const memory = memory_for(mu_surface_bytes_d(&d));
    const mu_surface_d *s = mu_surface_make_d(&d, memory);
    assert_true(mu_surface_tables_unsure_d(s) == 0);
    for (int v = 0; v < 12; v++) {
        double w[3], x[3];
        mu_closure_d c;
        moments energy = {0};
        view_of(v, &u, 0, w);
        x[0] = cos(turn) * w[0] - sin(turn) * w[1], x[1] = sin(turn) * w[0] + cos(turn) * w[1], x[2] = w[2];
        assert_true(mu_bind_d(s, x, NULL, &c));
        sample_energy(&c, &u, 8000, &energy);
        near_mean(&energy, 1, 0.01);
    }
    free(memory);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(quadrature_is_the_mean_of_samples),
                                       cmocka_unit_test(quadrature_is_that_of_another),
                                       cmocka_unit_test(furnace_closes_where_axes_differ_by_1e8)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
