/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_fit.c: fits recover the distribution, M and tilt of surfaces made by the generator, within their own errors; tables
 * of ln P22 agree with the closed forms from which surfaces are made (quantile.c, written apart from core/bsdf).
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/render/surface_fft.h"
#include "core/surface/fit.h"
#include "core/surface/generate.h"
#include "core/surface/minimise.h"

static mu_definition named(mu_ndf ndf, double alpha, double gamma, double exponent) {
    mu_definition d = mu_definition_default();
    d.ndf = ndf, d.alpha = alpha, d.gamma = gamma, d.exponent = exponent;
    return d;
}

/*
 * Cubic Hermite polynomials are off by h^4/384 = 1.63e-8 of the fourth derivative by x = ln r. Of ln P22 that is at most
 * 2 gamma for a power (ln(1 + e^2x) has at most 2), 8 for the cosines of phong and sheen, 16 q for a Gaussian, q =
 * r^2/alpha^2; shares are integrals over exp of it, in which 16 q becomes 16 (q + 1), its mean beyond q. The share above is interpolated itself: of exp(-q), q ~ e^2x, the
 * fourth derivative is (-16 q + 112 q^2 - 96 q^3 + 16 q^4) exp(-q); where q goes as e^mx, (m/2)^4 times as much; tails that
 * are longer bend less. Shares below 1e-9 are rounding of 1 - share.
 */
static void tables_hold_the_closed_forms(void **state) {
    (void)state;
    static const struct {
        mu_ndf ndf;
        mu_slope_law law;
    } all[] = {{MU_GGX, {MU_SLOPE_GGX, 0.3, 0, 0}},    {MU_BECKMANN, {MU_SLOPE_BECKMANN, 0.3, 0, 0}},
               {MU_GTR, {MU_SLOPE_GTR, 0.1, 0.3, 0}},  {MU_GTR, {MU_SLOPE_GTR, 0.3, 1, 0}},
               {MU_GTR, {MU_SLOPE_GTR, 0.3, 8, 0}},    {MU_STD, {MU_SLOPE_STD, 0.3, 1.6, 0}},
               {MU_STD, {MU_SLOPE_STD, 0.3, 40, 0}},   {MU_PHONG, {MU_SLOPE_PHONG, 1, 0, 20}},
               {MU_SHEEN, {MU_SLOPE_SHEEN, 0.3, 0, 0}}};
    for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
        const mu_slope_law *law = &all[k].law;
        const mu_definition d = named(all[k].ndf, law->alpha, law->gamma, law->exponent);
        const size_t bytes = mu_radial_bytes(&d);
        void *memory = aligned_alloc(16, (bytes + 15) / 16 * 16);
        mu_radial *table = malloc(sizeof *table);
        assert_true(memory && table && mu_radial_make(table, &d, memory));
        for (double x = -6.013; x < 6; x += 0.0371) {
            const double r = exp(x), above = 1 - mu_slope_share(law, r);
            if (above < 1e-9) break;
            const double q = -log(above), m = law->kind == MU_SLOPE_SHEEN ? 2 + 1 / law->alpha : 2;
            const double of_share = pow(m / 2, 4) * q * (16 + q * (112 + q * (96 + q * 16)));
            const double fourth = 2 * law->gamma + 8 + 16 * (q + 1) + of_share;
            if (fabs(mu_radial_above(table, x) - above) > 1.63e-8 * fourth * above + 1e-14)
                fail_msg("case %zu, r %g: share above %.12g, not %.12g", k, r, mu_radial_above(table, x),
                         above);
        }
        free(table);
        free(memory);
    }
}

static double bowl(void *context, const double *x, double *g) { /* Rosenbrock's, of three numbers */
    double value = 0;
    (void)context;
    for (int k = 0; k < 3; k++) g[k] = 0;
    for (int k = 0; k < 2; k++) {
        const double a = x[k + 1] - x[k] * x[k], b = 1 - x[k];
        value += 100 * a * a + b * b;
        g[k] += -400 * a * x[k] - 2 * b;
        g[k + 1] += 200 * a;
    }
    return value;
}

static void minimum_and_inverse(void **state) {
    (void)state;
    double x[3] = {-1.2, 1, 2}, h[9], inverse[9];
    _Bool converged;
    assert_true(mu_minimise(bowl, NULL, 3, x, 1e-9, &converged) < 1e-16 && converged);
    for (int k = 0; k < 3; k++) assert_true(fabs(x[k] - 1) < 1e-8);
    mu_hessian(bowl, NULL, 3, x, 1e-5, h);
    assert_true(fabs(h[0] - 802) < 1e-3 && fabs(h[1] + 400) < 1e-3 && fabs(h[8] - 200) < 1e-3);
    assert_true(mu_invert(h, 3, inverse));
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double sum = 0;
            for (int k = 0; k < 3; k++) sum += h[3 * i + k] * inverse[3 * k + j];
            assert_true(fabs(sum - (i == j)) < 1e-9);
        }
    h[8] = -1;
    assert_false(mu_invert(h, 3, inverse));
}

static mu_generator *made(mu_slope_law law, uint32_t n, uint64_t seed) {
    const mu_recipe recipe = {law, n, 6, seed, 0.9999};
    mu_generator *g = mu_generator_make(&recipe);
    mu_fft *fft = mu_fft_make(n);
    const mu_spectral spectral = mu_fft_spectral(fft);
    assert_true(g && mu_generator_start(g, &spectral));
    for (int pass = 0; pass < 30; pass++) assert_true(mu_generator_pass(g, &spectral));
    mu_fft_free(fft);
    return g;
}

static void near(const char *name, const char *what, double found, double error, double truth, double size) {
    /* made surfaces follow their law more closely than chance would have it: 4 standard errors are never met, if they
     * are right; and an error of a fifth of the size would tell nothing */
    if (!(fabs(found - truth) <= 4 * error && error > 0 && error < 0.2 * size))
        fail_msg("%s: %s is %.5f +- %.5f, not %.5f", name, what, found, error, truth);
}

typedef struct mu_case {
    const char *name; /* the candidate that is to be it */
    mu_slope_law law;
    double m[4], tilt[2];
} mu_case;

static void recover(const mu_case *c, uint64_t seed) {
    mu_generator *g = made(c->law, 256, seed);
    mu_heightfield f = mu_generator_surface(g);
    const _Bool open = c->tilt[0] != 0 || c->tilt[1] != 0;
    double *h = malloc(mu_cells(&f) * sizeof *h);
    const double *m = c->m, det = m[0] * m[3] - m[1] * m[2];
    for (uint32_t i = 0; i < f.nx; i++)
        for (uint32_t j = 0; j < f.nx; j++)
            h[i * f.nx + j] = f.h[i * f.nx + j] + c->tilt[0] * i + c->tilt[1] * j;
    const mu_slopes s = {{h, f.nx, f.ny}, {m[3] / det, -m[2] / det, -m[1] / det, m[0] / det}, open};
    mu_fit *fit = calloc(1, sizeof *fit);
    fit->keep = 0.999, fit->tolerance = 0.02;
    mu_fit_slopes(fit, &s);
    if (fit->verdict != MU_FIT_EXPLAINED) fail_msg("%s: %s", c->name, fit->reason);
    const mu_fitted *found = NULL;
    for (int k = 0; k < fit->count; k++)
        if (strcmp(fit->fitted[k].candidate->name, c->name) == 0) found = &fit->fitted[k];
    /* A family that holds it may be a little likelier, no more: criterion of one number more */
    assert_true(found && found->converged && found->explains && !found->at_end);
    assert_true(found->criterion - fit->fitted[0].criterion < 2);
    const double alpha = c->law.kind == MU_SLOPE_PHONG ? 1 : c->law.alpha;
    mu_anisotropy truth;
    assert_true(mu_transform_anisotropy(m, alpha, &truth));
    const mu_told *t = &found->told, *e = &found->error;
    near(c->name, "alpha_x", t->alpha_x, e->alpha_x, truth.alpha_x, truth.alpha_x);
    near(c->name, "alpha_y", t->alpha_y, e->alpha_y, truth.alpha_y, truth.alpha_y);
    if (truth.alpha_x > 1.2 * truth.alpha_y)
        near(c->name, "rotation", t->rotation, e->rotation, truth.rotation, 0.5);
    if (c->law.kind == MU_SLOPE_GTR || c->law.kind == MU_SLOPE_STD)
        near(c->name, "gamma", t->gamma, e->gamma, c->law.gamma, c->law.gamma);
    if (c->law.kind == MU_SLOPE_PHONG)
        near(c->name, "exponent", t->exponent, e->exponent, c->law.exponent, c->law.exponent);
    for (int k = 0; k < 2; k++) {
        const double mean = s.cotransform[2 * k] * c->tilt[0] + s.cotransform[2 * k + 1] * c->tilt[1];
        near(c->name, k ? "mean slope y" : "mean slope x", t->mean[k], e->mean[k], mean, alpha);
    }
    /* the tilt before the symmetric M found puts the mean slope where it was found */
    const double *M = t->transform, size = M[0] * M[2] - M[1] * M[1];
    assert_true(fabs((M[2] * t->tilt[0] - M[1] * t->tilt[1]) / size - t->mean[0]) < 1e-12);
    free(fit);
    free(h);
    mu_generator_free(g);
}

static void recovers_what_was_made(void **state) {
    (void)state;
    static const mu_case cases[] = {
        {"beckmann", {MU_SLOPE_BECKMANN, 0.3, 0, 0}, {2, 0.6, 0, 0.7}, {0, 0}},
        {"ggx", {MU_SLOPE_GGX, 0.2, 0, 0}, {1, 2, 0, 1}, {0.05, -0.1}},
        {"gtr", {MU_SLOPE_GTR, 0.3, 1.5, 0}, {1, 0, 0, 1}, {0, 0}},
        {"gtr", {MU_SLOPE_GTR, 0.3, 3, 0}, {1, 0.7, 0, 1}, {0.1, 0.1}},
        {"std", {MU_SLOPE_STD, 0.3, 3, 0}, {0.5, 0.5, -1, 2}, {0, 0}},
        {"phong", {MU_SLOPE_PHONG, 1, 0, 20}, {2, 0, 0, 0.5}, {0, 0}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) recover(&cases[k], 300 + k);
}

/* The gradient against differences of the value; and the censored tail: all facets are inside or in the tail. */
static void gradient_is_the_derivative(void **state) {
    (void)state;
    mu_generator *g = made((mu_slope_law){MU_SLOPE_GTR, 0.3, 1.5, 0}, 128, 7);
    const mu_slopes s = {mu_generator_surface(g), {1, 0.3, 0, 1.4}, 0};
    double *sample = malloc((size_t)2 * MU_SAMPLE * sizeof *sample);
    mu_cloud cloud = {0};
    assert_true(mu_cloud_pilot(&cloud, &s, 0.99, sample, mu_cloud_sample(&s, sample)) &&
                mu_cloud_fill(&cloud, &s));
    assert_true(cloud.sets[2].facets == 2.0 * 128 * 128 &&
                fabs(cloud.sets[2].tail / cloud.sets[2].facets - 0.01) < 1e-3);
    for (int k = 0; k < MU_CANDIDATES; k++) {
        mu_likelihood *l = calloc(1, sizeof *l);
        double p[MU_MOST_PARAMETERS], gradient[MU_MOST_PARAMETERS], other[MU_MOST_PARAMETERS];
        l->candidate = mu_candidate_get(k), l->cloud = &cloud;
        assert_true(mu_candidate_start(l->candidate, 0, 0.35, p));
        p[MU_AT_D] = 0.1, p[MU_AT_C] = -0.2, p[MU_AT_X] = 0.05, p[MU_AT_Y] = 0.1;
        mu_likelihood_at(l, &cloud.sets[2], p, gradient);
        for (int i = 0; i < mu_candidate_parameters(l->candidate); i++) {
            const double step = 1e-5, kept = p[i];
            p[i] = kept + step;
            double difference = mu_likelihood_at(l, &cloud.sets[2], p, other);
            p[i] = kept - step;
            difference = (difference - mu_likelihood_at(l, &cloud.sets[2], p, other)) / (2 * step);
            p[i] = kept;
            /* shapes are differences of steps 1e-3 in the gradient: 1e-6/6 of a third derivative of some units. Sheen's ln
             * density is singular at its centre: a step of 1e-5 is small against the distance of the nearest point */
            if (fabs(difference - gradient[i]) > 2e-5 * (1 + fabs(gradient[i])))
                fail_msg("%s: derivative %d is %.9g, gradient %.9g", l->candidate->name, i, difference,
                         gradient[i]);
        }
        free(l->memory);
        free(l);
    }
    mu_cloud_free(&cloud);
    free(sample);
    mu_generator_free(g);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tables_hold_the_closed_forms),
        cmocka_unit_test(minimum_and_inverse),
        cmocka_unit_test(gradient_is_the_derivative),
        cmocka_unit_test(recovers_what_was_made),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
