/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * scattering_fixture.h: a surface in float bound to one view, and the furnace around it, for the tests of multiple
 * scattering.
 */
#ifndef SCATTERING_FIXTURE_H
#define SCATTERING_FIXTURE_H

#include "tests/bsdf_fixture.h"
#include "tests/moments.h"

#include <stdlib.h>

typedef struct scene {
    mu_definition d;
    void *memory;
    mu_surface_f *s;
    mu_closure_f c;
} scene;

static inline void make(scene *b, const mu_definition *d) {
    mu_complaint why;
    assert_true(mu_definition_check(d, &why));
    b->d = *d;
    b->memory = aligned_alloc(64, (mu_surface_bytes_f(d) + 63) / 64 * 64);
    b->s = mu_surface_make_f(d, b->memory);
}

static inline void view(scene *b, const double w[3]) {
    const float wo[3] = {(float)w[0], (float)w[1], (float)w[2]};
    assert_true(mu_bind_f(b->s, wo, NULL, &b->c));
}

static inline void sample_once(const scene *b, uniform *u, mu_sample_f *out) {
    const float v[3] = {uniform_float(u), uniform_float(u), uniform_float(u)};
    mu_sample_wi_f(&b->c, v, out);
}

/* Mean energy of n samples: importance, so that eta does not scale it. */
static inline void furnace(scene *b, uniform *u, int n, moments *energy) {
    b->c.importance = 1;
    for (int i = 0; i < n; i++) {
        mu_sample_f s;
        sample_once(b, u, &s);
        accumulate(energy, s.rejected ? 0 : (double)s.weight[0]);
    }
}

static inline void holds(const moments *m, double truth, double slack) {
    const double mean = m->sum / m->n, error = sqrt(fmax(m->squares / m->n - mean * mean, 0) / m->n);
    if (fabs(mean - truth) <= slack + 4 * error) return;
    print_error("energy %.5f +- %.5f, expected %.5f +- %.5f\n", mean, error, truth, slack);
    fail();
}

#endif
