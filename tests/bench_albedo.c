/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * bench_albedo.c: error against run time of compensated multiple scattering, by the error that its tables may have.
 *
 *     bench_albedo [--json]
 *
 * In a white furnace with F = 1 a compensated surface sends on, toward a view w,
 *     E(w) + lost(w) I,    I = integral of lost(v) cos dv / (pi A),
 * with lost and A as its tables say them (musurf.h: mu_albedo_f), I by the midpoint rule in azimuth and in z^(1/3), for what
 * is near the horizon; 1 is right. E is the quadrature of polar_albedo.c with panels that agree to 1e-6; to 1e-4, it
 * changes by "unsure" at most. It is held to the mean weight of sampled visible normals, which know no quadrature,
 * by Maurer and Pontil's empirical Bernstein bound (2009, Theorem 4; the weights lie in [0, 1]) at 1e-6 for all views of all
 * materials at once: beyond it the benchmark fails. "bound" is the largest share of it that was taken.
 * Worst and root mean square error are over the views. Time is that of one eval, and of making the surface, in float, of
 * the same run; without compensation too ("asked": 0).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/bsdf/albedo.h"
#include "core/bsdf/musurf.h"
#include "tests/polar_albedo.h"
#include "tests/uniform.h"

#define TURN 6.28318530717958648
enum { MATERIALS = 24, VIEWS = 24, DRAWS = 1 << 16, POLAR = 300, AROUND = 128, LIGHTS = 64, ROUNDS = 5 };

static const struct {
    const char *name;
    mu_ndf ndf;
} families[] = {{"ggx", MU_GGX}, {"beckmann", MU_BECKMANN}, {"gtr", MU_GTR}, {"sheen", MU_SHEEN}};
static const double alphas[] = {0.1, 0.5, 1}, gtr_gamma = 1.5, maps[][4] = {{1, 0, 0, 1}, {1, 2, 0, 1}};
static const double asked[] = {0.3, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002};

typedef struct view {
    float w[3];
    double single; /* E */
} view;

typedef struct reference {
    double unsure, bound;
} reference;

typedef struct row {
    double worst, squares, ns, compile_us;
    size_t bytes;
} row;

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static void direction(double z, double phi, float w[3]) {
    const double r = sqrt((1 - z) * (1 + z));
    w[0] = (float)(r * cos(phi)), w[1] = (float)(r * sin(phi)), w[2] = (float)z;
}

/* A surface in memory of its own; the time that making it took. */
static mu_surface_f *make(const mu_definition *d, void **memory, double *us) {
    *memory = aligned_alloc(64, (mu_surface_bytes_f(d) + 63) / 64 * 64);
    if (!*memory) exit(1);
    const double start = now();
    mu_surface_f *s = mu_surface_make_f(d, *memory);
    *us = (now() - start) / 1e3;
    return s;
}

static mu_closure_f bound(const mu_surface_f *s, const float w[3]) {
    mu_closure_f c;
    if (!mu_bind_f(s, w, NULL, &c)) exit(1);
    return c;
}

/* E of every view from 1 to 89.5 degrees, azimuths spread by the golden ratio; stops where sampling does not agree. */
static void references(const mu_definition *d, view views[VIEWS], reference *out) {
    void *memory;
    double us;
    const mu_surface_f *s = make(d, &memory, &us);
    uniform random = {20261126u};
    *out = (reference){0};
    for (int i = 0; i < VIEWS; i++) {
        view *v = &views[i];
        direction(cos((1 + 88.5 * i / (VIEWS - 1)) * TURN / 360), TURN * fmod(i * 0.6180339887498949, 1),
                  v->w);
        const mu_closure_f c = bound(s, v->w);
        double off;
        v->single = polar_albedo(&c, 1, 1e-6, &off);
        out->unsure = fmax(out->unsure, fabs(v->single - polar_albedo(&c, 1, 1e-4, &off)));
        double sum = 0, squares = 0;
        for (int k = 0; k < DRAWS; k++) {
            const float u[3] = {uniform_float(&random), uniform_float(&random), uniform_float(&random)};
            mu_sample_f sample;
            mu_sample_wi_f(&c, u, &sample);
            const double weight = sample.rejected ? 0 : (double)sample.weight[0];
            sum += weight / DRAWS, squares += weight * weight / DRAWS;
        }
        /* and 1e-5, at which the quadrature ends a tail */
        const double ln = log(4 * MATERIALS * VIEWS / 1e-6), variance = fmax(squares - sum * sum, 0);
        const double allowed = sqrt(2 * variance * ln / DRAWS) + 7 * ln / (3 * (DRAWS - 1)) + 1e-5;
        out->bound = fmax(out->bound, fabs(v->single - sum) / allowed);
    }
    free(memory);
    if (out->bound <= 1) return;
    fprintf(
        stderr,
        "bench_albedo: the albedo of single scattering is %.1f times as far from that of samples as chance "
        "allows\n",
        out->bound);
    exit(1);
}

/* I: what the lobe makes of one unit of lost light. */
static double returned(const mu_surface_f *s) {
    double sum = 0;
    float average = 0;
    for (int i = 0; i < POLAR; i++) {
        const double t = (i + 0.5) / POLAR, z = t * t * t, solid = TURN / AROUND * 3 * t * t / POLAR;
        for (int j = 0; j < AROUND; j++) {
            float w[3];
            direction(z, TURN * (j + 0.5) / AROUND, w);
            sum += (1 - (double)mu_albedo_f(s, w, &average)) * z * solid;
        }
    }
    return sum / (TURN / 2 * (1 - (double)average));
}

/* The least of the rounds' means, over every view and as many lights. */
static double eval_ns(const mu_surface_f *s, const view views[VIEWS]) {
    uniform random = {20261127u};
    float lights[LIGHTS][3];
    double least = INFINITY;
    for (int i = 0; i < LIGHTS; i++)
        direction(1 - uniform_double(&random), TURN * uniform_double(&random), lights[i]);
    for (int round = 0; round < ROUNDS; round++) {
        double spent = 0;
        for (int k = 0; k < VIEWS; k++) {
            const mu_closure_f c = bound(s, views[k].w);
            const double start = now();
            for (int i = 0; i < LIGHTS; i++) {
                mu_value_f v;
                mu_eval_f(&c, lights[i], &v);
                __asm__ volatile("" : : "r"(&v) : "memory");
            }
            spent += now() - start;
        }
        least = fmin(least, spent / (VIEWS * LIGHTS));
    }
    return least;
}

static row measure(const mu_definition *d, const view views[VIEWS]) {
    void *memory;
    row r = {0};
    const mu_surface_f *s = make(d, &memory, &r.compile_us);
    const int compensated = d->multiple == MU_COMPENSATED;
    const double back = compensated ? returned(s) : 0;
    for (int i = 0; i < VIEWS; i++) {
        float average;
        const double lost = compensated ? 1 - (double)mu_albedo_f(s, views[i].w, &average) : 0;
        const double error = fabs(views[i].single + lost * back - 1);
        r.worst = fmax(r.worst, error), r.squares += error * error / VIEWS;
    }
    r.ns = eval_ns(s, views);
    r.bytes = mu_surface_table_bytes_f(s);
    free(memory);
    return r;
}

static void print(const char *family, const mu_definition *d, const reference *right, const row *r,
                  int json) {
    const double to = d->multiple == MU_COMPENSATED ? d->compensation_error : 0;
    const double *m = d->transform;
    printf(json ? "{\"ndf\": \"%s\", \"alpha\": %.9g, \"transform\": [[%.9g, %.9g], [%.9g, %.9g]], "
                  "\"asked\": %.9g, \"worst\": %.6g, \"rms\": %.6g, \"unsure\": %.3g, \"bound\": %.3g, "
                  "\"ns\": %.6g, "
                  "\"compile_us\": %.6g, "
                  "\"bytes\": %zu}\n"
                : "%-9s alpha %-4g M [[%g, %g], [%g, %g]] asked %-5g worst %8.2e rms %8.2e "
                  "(unsure %7.1e, bound %4.2f) "
                  "%6.1f ns %10.1f us %7zu bytes\n",
           family, d->alpha, m[0], m[1], m[2], m[3], to, r->worst, sqrt(r->squares), right->unsure,
           right->bound, r->ns, r->compile_us, r->bytes);
}

/* One material: singly, by the error asked for. */
static void run(const char *family, mu_definition d, int json) {
    view views[VIEWS];
    reference right;
    references(&d, views, &right);
    row r = measure(&d, views);
    print(family, &d, &right, &r, json);
    d.multiple = MU_COMPENSATED;
    for (size_t i = 0; i < sizeof asked / sizeof asked[0]; i++) {
        d.compensation_error = asked[i];
        r = measure(&d, views);
        print(family, &d, &right, &r, json);
    }
}

int main(int argc, char **argv) {
    const int json = argc > 1 && strcmp(argv[1], "--json") == 0;
    if (!json)
        printf("compensated multiple scattering in a white furnace, %d views: error, one eval, making it\n",
               VIEWS);
    for (size_t f = 0; f < sizeof families / sizeof families[0]; f++)
        for (size_t a = 0; a < sizeof alphas / sizeof alphas[0]; a++)
            for (size_t m = 0; m < sizeof maps / sizeof maps[0]; m++) {
                mu_definition d = mu_definition_default();
                d.ndf = families[f].ndf, d.alpha = alphas[a], d.gamma = gtr_gamma;
                memcpy(d.transform, maps[m], sizeof d.transform);
                run(families[f].name, d, json);
            }
    return 0;
}
