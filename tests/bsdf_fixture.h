/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* bsdf_fixture.h: surfaces and directions for the tests of core/bsdf. */
#ifndef MU_TEST_BSDF_FIXTURE_H
#define MU_TEST_BSDF_FIXTURE_H

#include <math.h>
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include "core/bsdf/musurf.h"
#include "tests/uniform.h"

#define TEST_PI 3.14159265358979323846

typedef struct bsdf {
    _Alignas(64) unsigned char in_double[2048];
    _Alignas(64) unsigned char in_float[16384];
    mu_closure_d d;
    mu_closure_f f;
} bsdf;

static inline mu_definition bsdf_definition(mu_ndf ndf, double alpha, double gamma, double a, double c,
                                            double b, double d) {
    mu_definition definition = mu_definition_default();
    definition.ndf = ndf, definition.alpha = alpha, definition.gamma = gamma;
    definition.transform[0] = a, definition.transform[1] = c, definition.transform[2] = b,
    definition.transform[3] = d;
    return definition;
}

static inline void bsdf_direction(double cosine, double phi, double w[3]) {
    const double sine = sqrt((1 - cosine) * (1 + cosine));
    w[0] = sine * cos(phi), w[1] = sine * sin(phi), w[2] = cosine;
}

/* In double alone: no table is built. */
static inline void bsdf_bind_double(bsdf *b, const mu_definition *definition, const double wo[3]) {
    mu_complaint why;
    assert_true(mu_definition_check(definition, &why));
    assert_true(mu_surface_bytes_d(definition) <= sizeof b->in_double);
    assert_true(mu_bind_d(mu_surface_make_d(definition, b->in_double), wo, NULL, &b->d));
}

static inline void bsdf_bind(bsdf *b, const mu_definition *definition, const double wo[3]) {
    const float wo_f[3] = {(float)wo[0], (float)wo[1], (float)wo[2]};
    bsdf_bind_double(b, definition, wo);
    assert_true(mu_surface_bytes_f(definition) <= sizeof b->in_float);
    assert_true(mu_bind_f(mu_surface_make_f(definition, b->in_float), wo_f, NULL, &b->f));
}

/* Relative difference, and a message that shows both. */
static inline void bsdf_near_at(double got, double expected, double tolerance, const char *what,
                                const char *file, int line) {
    if (!(fabs(got - expected) <= tolerance * fabs(expected)) && !(got == expected)) {
        print_error("%s: got %.17g, expected %.17g, relative error %.3g above %.3g\n", what, got, expected,
                    fabs(got - expected) / fabs(expected), tolerance);
        _fail(file, line);
    }
}
#define bsdf_near(got, expected, tolerance) bsdf_near_at(got, expected, tolerance, #got, __FILE__, __LINE__)

/* A well-conditioned random map, mirrors among them. */
static inline void bsdf_random_map(uniform *u, double m[4]) {
    do {
        for (int i = 0; i < 4; i++) m[i] = 4 * uniform_double(u) - 2;
    } while (fabs(m[0] * m[3] - m[1] * m[2]) < 0.2);
}

#endif
