/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * bench_samplers.c: variance against run time of the samplers.
 *
 *     bench_samplers [--json]
 *
 * For each material, view and sampler the variance of one sample's weight f cos / pdf with F = 1 (a white furnace: its mean
 * is the albedo), the largest weight, the share that is lost below the horizon, and the time of one sample, in float, all
 * of the same run. Samplers take turns within a round; a sampler's time is the least of its rounds. With --json a line
 * for each; without, for each group and sampler, the geometric mean over the group of variance, and of variance times
 * time, over those of the group's first sampler.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/bsdf/musurf.h"
#include "tests/uniform.h"

enum { DRAWS = 1 << 16, TIMED = 4096, ROUNDS = 5, SAMPLERS = 5 };

static const char *const names[] = {"visible", "ndf",    "mixed",         "visible_uniform",
                                    "bounded", "folded", "folded_uniform"};
_Static_assert(sizeof names / sizeof names[0] == MU_SAMPLER_COUNT, "a name for each");

typedef struct group {
    const char *name;
    mu_ndf ndf;
    double alphas[4], gammas[3], maps[4][4], angles[5]; /* ended by 0, if shorter */
    mu_sampler samplers[SAMPLERS];
    int count;
} group;

#define STRETCH(s)                                                                                           \
    { 1 / (1 - (s)), 0, 0, 1 - (s) }
static const group groups[] = {
    {"ggx",
     MU_GGX,
     {0.1, 0.3, 0.6, 1},
     {2},
     {STRETCH(0), STRETCH(0.5), {1, 1, 0, 1}, {-0.5, 0, 0, 0.5}},
     {0, 30, 60, 80, 87},
     {MU_SAMPLE_VISIBLE, MU_SAMPLE_BOUNDED, MU_SAMPLE_NDF, MU_SAMPLE_MIXED, MU_SAMPLE_FOLDED},
     5},
    {"gtr",
     MU_GTR,
     {0.3},
     {0.1, 1, 4},
     {STRETCH(0), STRETCH(0.25), STRETCH(0.5), STRETCH(0.75)},
     {0, 30, 60, 75, 85},
     {MU_SAMPLE_MIXED, MU_SAMPLE_NDF, MU_SAMPLE_VISIBLE, MU_SAMPLE_VISIBLE_UNIFORM, MU_SAMPLE_FOLDED},
     5},
    {"beckmann",
     MU_BECKMANN,
     {0.1, 0.3},
     {2},
     {STRETCH(0), STRETCH(0.5)},
     {0, 30, 60, 75, 85},
     {MU_SAMPLE_MIXED, MU_SAMPLE_NDF, MU_SAMPLE_VISIBLE, MU_SAMPLE_FOLDED},
     4},
    {"std",
     MU_STD,
     {0.3},
     {1.7, 4},
     {STRETCH(0), STRETCH(0.5)},
     {0, 30, 60, 75, 85},
     {MU_SAMPLE_MIXED, MU_SAMPLE_NDF, MU_SAMPLE_VISIBLE, MU_SAMPLE_FOLDED},
     4},
};

typedef struct row {
    double mean, variance, largest, lost, ns;
} row;

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static void draw(const mu_closure_f *c, uniform *random, mu_sample_f *s) {
    const float u[3] = {uniform_float(random), uniform_float(random), uniform_float(random)};
    mu_sample_wi_f(c, u, s);
}

static void measure(const mu_closure_f *c, uint64_t seed, row *out) {
    uniform random = {seed};
    double squares = 0;
    *out = (row){.ns = INFINITY};
    for (int i = 0; i < DRAWS; i++) {
        mu_sample_f s;
        draw(c, &random, &s);
        const double weight = (double)s.weight[0];
        const double apart = weight - out->mean; /* Welford 1962 */
        out->mean += apart / (i + 1), squares += apart * (weight - out->mean), out->lost += s.rejected;
        out->largest = fmax(out->largest, weight);
    }
    out->variance = fmax(squares / DRAWS, 1e-9); /* less than that is rounding */
    out->lost /= DRAWS;
}

static void time_one(const mu_closure_f *c, uint64_t seed, row *out) {
    uniform random = {seed};
    const double start = now();
    for (int i = 0; i < TIMED; i++) {
        mu_sample_f s;
        draw(c, &random, &s);
        __asm__ volatile("" : : "r"(&s) : "memory");
    }
    out->ns = fmin(out->ns, (now() - start) / TIMED);
}

static void print(const group *g, const mu_definition *d, double theta, mu_sampler sampler, const row *r) {
    const double *m = d->transform;
    printf(
        "{\"group\": \"%s\", \"alpha\": %.9g, \"gamma\": %.9g, \"transform\": [[%.9g, %.9g], [%.9g, %.9g]], "
        "\"theta\": %.9g, \"sampler\": \"%s\", \"mean\": %.9g, \"variance\": %.6g, \"largest\": %.6g, "
        "\"lost\": %.6g, \"ns\": %.6g}\n",
        g->name, d->alpha, d->gamma, m[0], m[1], m[2], m[3], theta, names[sampler], r->mean, r->variance,
        r->largest, r->lost, r->ns);
}

/* One material and view; adds the logarithms of the ratios to the first sampler. */
static void compare(const group *g, const mu_definition *of, double theta, int json,
                    double logs[SAMPLERS][2]) {
    static _Alignas(64) unsigned char memory[SAMPLERS][65536];
    mu_closure_f closures[SAMPLERS];
    row rows[SAMPLERS];
    const double t = theta * 3.14159265358979323846 / 180, phi = 0.6;
    const float wo[3] = {(float)(sin(t) * cos(phi)), (float)(sin(t) * sin(phi)), (float)cos(t)};
    for (int k = 0; k < g->count; k++) {
        mu_definition d = *of;
        d.sampler = g->samplers[k];
        if (mu_surface_bytes_f(&d) > sizeof memory[k] ||
            !mu_bind_f(mu_surface_make_f(&d, memory[k]), wo, NULL, &closures[k]))
            exit(1);
        measure(&closures[k], 20260913u, &rows[k]);
    }
    for (int round = 0; round < ROUNDS; round++)
        for (int k = 0; k < g->count; k++) time_one(&closures[k], 20260914u + (uint64_t)round, &rows[k]);
    for (int k = 0; k < g->count; k++) {
        const double ratio = rows[k].variance / rows[0].variance;
        logs[k][0] += log(ratio), logs[k][1] += log(ratio * rows[k].ns / rows[0].ns);
        if (json) print(g, of, theta, g->samplers[k], &rows[k]);
    }
}

static void run(const group *g, int json) {
    double logs[SAMPLERS][2] = {{0}};
    int count = 0;
    for (int a = 0; a < 4 && g->alphas[a] > 0; a++)
        for (int c = 0; c < 3 && g->gammas[c] > 0; c++)
            for (int m = 0; m < 4 && g->maps[m][3] > 0; m++)
                for (int v = 0; v < 5; v++) {
                    mu_definition d = mu_definition_default();
                    d.ndf = g->ndf, d.alpha = g->alphas[a], d.gamma = g->gammas[c];
                    memcpy(d.transform, g->maps[m], sizeof d.transform);
                    compare(g, &d, g->angles[v], json, logs);
                    count++;
                }
    for (int k = 0; k < g->count && !json; k++)
        printf("%-10s %-16s %8.3f %8.3f\n", g->name, names[g->samplers[k]], exp(logs[k][0] / count),
               exp(logs[k][1] / count));
}

int main(int argc, char **argv) {
    const int json = argc > 1 && strcmp(argv[1], "--json") == 0;
    if (!json)
        printf("samplers in a white furnace, over the first of each group, geometric means\n%-10s %-16s %8s "
               "%8s\n",
               "", "", "variance", "x time");
    for (size_t i = 0; i < sizeof groups / sizeof groups[0]; i++) run(&groups[i], json);
    return 0;
}
