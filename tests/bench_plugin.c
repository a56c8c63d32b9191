/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * bench_plugin.c: what one call through the plugin costs, in units of a bare GGX evaluation in C.
 *
 * Absolute times drift with the machine, so bare and plugin calls take turns within one run, and the figure
 * is the median over the rounds of the ratio within a round. 2048 pairs of cosine-distributed directions,
 * alpha 0.3, M general. First both are held to the same values: a wrong answer is not a fast one.
 */
#include "tests/abi_host.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum {
    PAIRS = 2048,
    CLOSURES = 16,
    EACH = PAIRS / CLOSURES,
    ROUNDS = 41,
    PASSES = 8,
    BYTES = 4096 + 320
}; /* closures staggered: at equal offsets of 4 KiB, stores to one delay loads from others */

static float wo[CLOSURES][3], wi[PAIRS][3], u[PAIRS][3];
static const float SLOTS[6] = {1, 0.5f, 0.2f, 1.5f, 0.3f, 1.7f};
static _Alignas(64) unsigned char closures[CLOSURES][BYTES];
static musurf_value values[PAIRS];
static musurf_sample samples[PAIRS];
static float bare[PAIRS][2];

/* Keeps the compiler from merging, vectorising or dropping the calls: each result is in memory before the
 * next. */
#define KEEP(pointer) __asm__ volatile("" : : "r"(pointer) : "memory")

/* GGX under M as an ellipse of slopes: S = alpha^2 (M M^T)^-1, and S^-1. h is not normalised. */
typedef struct ellipse {
    float s[3], inverse[3], norm; /* xx, xy, yy; 1 / (pi sqrt(det S)) */
} ellipse;

static ellipse ellipse_of(float alpha, const float m[4]) {
    const float xx = m[0] * m[0] + m[1] * m[1], xy = m[0] * m[2] + m[1] * m[3],
                yy = m[2] * m[2] + m[3] * m[3];
    const float det = xx * yy - xy * xy, a = alpha * alpha;
    return (ellipse){{a * yy / det, -a * xy / det, a * xx / det},
                     {xx / a, xy / a, yy / a},
                     1 / (3.14159265f * a / sqrtf(det))};
}

static inline float form(const float s[3], const float w[3]) {
    return s[0] * w[0] * w[0] + 2 * s[1] * w[0] * w[1] + s[2] * w[1] * w[1] + w[2] * w[2];
}

/* f |wi.z| and the pdf of visible-normal sampling: two square roots, one division. */
static inline void bare_eval(const ellipse *e, const float o[3], const float i[3], float out[2]) {
    const float h[3] = {o[0] + i[0], o[1] + i[1], o[2] + i[2]};
    const float h2 = h[0] * h[0] + h[1] * h[1] + h[2] * h[2], q = form(e->inverse, h);
    const float no = sqrtf(form(e->s, o)), ni = sqrtf(form(e->s, i));
    const float both = 2 * (no * i[2] + ni * o[2]), one = 2 * (no + o[2]);
    const float common = e->norm * h2 * h2 / (q * q * both * one);
    out[0] = common * one * i[2];
    out[1] = common * both;
}

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static void run_bare(const void *context) {
    const ellipse *e = context;
    for (int i = 0; i < PAIRS; i++) {
        bare_eval(e, wo[i / EACH], wi[i], bare[i]);
        KEEP(bare[i]);
    }
}

/* A row of the table: which call of which material. */
typedef struct row {
    const char *label, *words;
    enum { EVAL, EVAL_BATCH, SAMPLE, SAMPLE_BATCH, SETUP, SETUP_EVAL } call;
    double goal; /* ratio to bare; 0: none set */
    musurf_material *material;
    double ns[ROUNDS], ratio[ROUNDS];
} row;

static void setup_all(const musurf_material_type *type, const row *r) {
    for (int i = 0; i < CLOSURES; i++) {
        type->setup(r->material, wo[i], SLOTS, 0, closures[i]);
        KEEP(closures[i]);
    }
}

static void run_row(const musurf_material_type *type, const row *r) {
    for (int i = 0; i < PAIRS; i++) {
        unsigned char *closure = closures[i / EACH];
        switch (r->call) {
        case EVAL:
            type->eval(closure, wi[i], MUSURF_ALL_LOBES, &values[i]);
            break;
        case SAMPLE:
            type->sample(closure, u[i], MUSURF_ALL_LOBES, &samples[i]);
            break;
        case SETUP:
            type->setup(r->material, wi[i], SLOTS, 0, closure);
            break;
        case SETUP_EVAL:
            type->setup(r->material, wi[PAIRS - 1 - i], SLOTS, 0, closure);
            type->eval(closure, wi[i], MUSURF_ALL_LOBES, &values[i]);
            break;
        case EVAL_BATCH:
            type->eval_batch(closure, 0, wi[i], sizeof wi[0], MUSURF_ALL_LOBES, &values[i], sizeof values[0],
                             EACH);
            i += EACH - 1;
            break;
        case SAMPLE_BATCH:
            type->sample_batch(closure, 0, u[i], sizeof u[0], MUSURF_ALL_LOBES, &samples[i],
                               sizeof samples[0], EACH);
            i += EACH - 1;
            break;
        }
        KEEP(values);
        KEEP(samples);
    }
}

static int by_size(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *numbers) {
    qsort(numbers, ROUNDS, sizeof *numbers, by_size);
    return numbers[ROUNDS / 2];
}

/* The plugin's GGX must be the bare one: f |wi.z| and pdf to 1e-3. */
static int same_values(const musurf_material_type *type, const row *r, const ellipse *e) {
    setup_all(type, r);
    for (int i = 0; i < PAIRS; i++) {
        musurf_value value;
        type->eval(closures[i / EACH], wi[i], MUSURF_ALL_LOBES, &value);
        bare_eval(e, wo[i / EACH], wi[i], bare[i]);
        if (fabsf(value.f[0] - bare[i][0]) > 1e-3f * bare[i][0] ||
            fabsf(value.pdf - bare[i][1]) > 1e-3f * bare[i][1]) {
            fprintf(stderr, "bench_plugin: pair %d: plugin f %g pdf %g, bare f %g pdf %g\n", i,
                    (double)value.f[0], (double)value.pdf, (double)bare[i][0], (double)bare[i][1]);
            return 0;
        }
    }
    return 1;
}

int main(void) {
    const musurf_material_type *type = abi_type(1);
    for (uint32_t i = 0; i < PAIRS; i++) {
        float *w[2] = {wi[i], i < CLOSURES ? wo[i] : NULL};
        for (uint32_t k = 0; k < 2 && w[k]; k++) { /* cosine-distributed, nothing special among them */
            float v[3];
            abi_uniforms(2 * i + k, v);
            const float radius = sqrtf(v[0]), phi = 6.2831853f * v[1];
            w[k][0] = radius * cosf(phi), w[k][1] = radius * sinf(phi), w[k][2] = sqrtf(1 - v[0]);
        }
        abi_uniforms(i + 100000, u[i]);
    }
#define GENERAL "transform=1,0.5,0.2,1.5 fresnel=none"
    static row rows[] = {
        {.label = "GGX eval", .words = "ndf=ggx alpha=0.3 " GENERAL, .call = EVAL, .goal = 2.4},
        {.label = "GTR 1.7 eval", .words = "ndf=gtr alpha=0.3 gamma=1.7 " GENERAL, .call = EVAL, .goal = 12},
        {.label = "GTR 3.5 eval", .words = "ndf=gtr alpha=0.3 gamma=3.5 " GENERAL, .call = EVAL, .goal = 12},
        {.label = "Beckmann eval", .words = "ndf=beckmann alpha=0.3 " GENERAL, .call = EVAL},
        {.label = "GGX eval, M = 1", .words = "ndf=ggx alpha=0.3 fresnel=none", .call = EVAL},
        {.label = "GGX eval, batch", .words = "ndf=ggx alpha=0.3 " GENERAL, .call = EVAL_BATCH},
        {.label = "GTR 1.7 eval, batch", .words = "ndf=gtr alpha=0.3 gamma=1.7 " GENERAL, .call = EVAL_BATCH},
        {.label = "GGX sample", .words = "ndf=ggx alpha=0.3 " GENERAL, .call = SAMPLE},
        {.label = "GTR 1.7 sample", .words = "ndf=gtr alpha=0.3 gamma=1.7 " GENERAL, .call = SAMPLE},
        {.label = "Beckmann sample", .words = "ndf=beckmann alpha=0.3 " GENERAL, .call = SAMPLE},
        {.label = "GGX sample, batch", .words = "ndf=ggx alpha=0.3 " GENERAL, .call = SAMPLE_BATCH},
        {.label = "GGX setup", .words = "ndf=ggx alpha=0.3 " GENERAL, .call = SETUP},
        {.label = "GTR 1.7 setup", .words = "ndf=gtr alpha=0.3 gamma=1.7 " GENERAL, .call = SETUP},
        {.label = "GGX varying M, setup+eval",
         .words = "ndf=ggx alpha=0.3 transform=@0 fresnel=none",
         .call = SETUP_EVAL},
        {.label = "GTR varying M, setup+eval",
         .words = "ndf=gtr alpha=0.3 gamma=1.7 transform=@0 fresnel=none",
         .call = SETUP_EVAL}};
    enum { COUNT = sizeof rows / sizeof rows[0] };
    const ellipse e = ellipse_of(0.3f, SLOTS);
    for (int r = 0; r < COUNT; r++) {
        rows[r].material = abi_material(type, NULL, rows[r].words);
        if (!rows[r].material || abi_plan(type, rows[r].material).closure_bytes > BYTES) {
            fprintf(stderr, "bench_plugin: %s: refused, or its closure is larger than %d bytes\n",
                    rows[r].words, BYTES);
            return 1;
        }
    }
    if (!same_values(type, &rows[0], &e)) return 1;

    static double bare_ns[ROUNDS];
    for (int round = -2; round < ROUNDS; round++) { /* two to warm up */
        for (int r = 0; r < COUNT; r++) {
            setup_all(type, &rows[r]);
            const double start = now();
            for (int pass = 0; pass < PASSES; pass++) run_bare(&e);
            const double middle = now();
            for (int pass = 0; pass < PASSES; pass++) run_row(type, &rows[r]);
            const double end = now();
            if (round < 0) continue;
            rows[r].ns[round] = (end - middle) / (PASSES * PAIRS);
            rows[r].ratio[round] = (end - middle) / (middle - start);
            bare_ns[round] = (middle - start) / (PASSES * PAIRS);
        }
    }
    int missed = 0;
    printf("one call through the plugin, against a bare GGX evaluation; medians of %d rounds\n", ROUNDS);
    printf("%-28s %8s %8s %8s\n", "", "ns", "ratio", "goal");
    printf("%-28s %8.1f %8.2f\n", "bare GGX eval + pdf", median(bare_ns), 1.0);
    for (int r = 0; r < COUNT; r++) {
        const double ns = median(rows[r].ns), ratio = median(rows[r].ratio);
        printf("%-28s %8.1f %8.2f", rows[r].label, ns, ratio);
        if (rows[r].goal > 0) {
            printf(" %8.1f  %s", rows[r].goal, ratio <= rows[r].goal ? "reached" : "MISSED");
            missed |= ratio > rows[r].goal;
        }
        printf("\n");
        type->release(rows[r].material);
    }
    return missed ? 1 : 0;
}
