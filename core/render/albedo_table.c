/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * albedo_table.c: nodes by an additive lattice (command_ibl_albedo.c); linear between them. Samplers that reject make it random:
 * then a table of many nodes stops, at 2e7 samples in all, short of the accuracy that others have at once.
 *
 * Albedos of smooth surfaces fall off within a cosine of about alpha from the horizon, and Fresnel's with the fifth power:
 * nodes are even in the cosine's root. Between 64 of them the error is that of (1/63)² / 8 of the second derivative, 3e-4
 * of one of 10. Around, a sine of twice the angle whose height is 1 is met to 1e-3 between 96; albedos move by less.
 */
#include "core/render/albedo_table.h"

#include <math.h>
#include <stdlib.h>

#include "core/render/philox.h"
#include "core/render/surface_rows.h"

#define TWO_PI 6.28318530717958647692

/* Ratio of neighbouring sigmas, in ln; and the most nodes for it. */
#define SIGMA_STEP 0.15f
enum { SIGMAS_MOST = 12, BATCH = 1024, LEAST_BATCHES = 2 };
#define ENOUGH 2e-4
/* The view of the node on the horizon. */
#define LEAST_COSINE 1e-4

typedef struct work {
    const mu_albedo_table *table;
    const mu_material *material;
    const musurf_map *map;
    double root[3]; /* of the moments before M: lower triangle; 0: a mirror, which no M makes rough */
    const mu_ibl_lobe_f *lobe;
    uint32_t most; /* batches */
} work;

/* Mean weight of what is reflected: batches of the lattice, each shifted at random, until their means' standard error is
 * ENOUGH, or `most` of them are made. */
static void mean_weight(const work *w, const float m[4], const float wo[3], uint64_t node, void *closure, float rgb[3]) {
    static const double step[3] = {0.7548776662466927, 0.5698402909980532, 0.4142135623730950};
    const musurf_material_type *type = w->material->type;
    double mean[3] = {0, 0, 0}, square[3] = {0, 0, 0};
    rgb[0] = rgb[1] = rgb[2] = 0;
    const uint32_t lobes = w->map ? w->map->setup(w->material->compiled, wo, m, NULL, 0, closure)
                                  : type->setup(w->material->compiled, wo, NULL, 0, closure);
    if (!lobes) return;
    for (uint32_t b = 0; b < w->most; b++) {
        double shift[3], sum[3] = {0, 0, 0}, worst = 0;
        mu_philox_uniforms(0, node * 4096 + b, shift);
        for (uint32_t i = 0; i < BATCH; i++) {
            float u[3];
            for (int k = 0; k < 3; k++) {
                const double place = shift[k] + i * step[k];
                u[k] = fminf((float)(place - floor(place)), 0x1.fffffep-1f);
            }
            musurf_sample s;
            type->sample(closure, u, MUSURF_ALL_LOBES, &s);
            for (int c = 0; c < 3 && s.lobe; c++) sum[c] += (double)s.weight[c];
        }
        for (int c = 0; c < 3; c++) { /* Welford */
            const double before = sum[c] / BATCH - mean[c];
            mean[c] += before / (b + 1.0);
            square[c] += before * (sum[c] / BATCH - mean[c]);
            worst = fmax(worst, square[c]);
        }
        if (b + 1 >= LEAST_BATCHES && worst <= ENOUGH * ENOUGH * (b + 1.0) * b) break;
    }
    for (int c = 0; c < 3; c++) rgb[c] = (float)mean[c];
}

/* [any] All cosines of an azimuth and two sigmas. */
static void fill(void *context, uint32_t row) {
    const work *w = context;
    const mu_albedo_table *t = w->table;
    const uint32_t azimuth = row % t->azimuths, second = row / t->azimuths % t->sigmas[1],
                   first = row / t->azimuths / t->sigmas[1];
    void *const closure = aligned_alloc(64, (w->material->plan.closure_bytes + 63u) / 64 * 64);
    float *rgb = t->rgb + (size_t)3 * row * t->cosines;
    float m[4];
    const double sigma[2] = {exp((double)(t->least[0] + (float)first * t->step[0])),
                             exp((double)(t->least[1] + (float)second * t->step[1]))};
    /* M = diag(1 / sigma) root^T: then M^-T root root^T M^-1 is diag(sigma²) */
    for (int k = 0; k < 2; k++) {
        m[2 * k] = (float)(k ? 0 : w->root[0] > 0 ? w->root[0] / sigma[0] : 1);
        m[2 * k + 1] = (float)(w->root[0] > 0 ? (k ? w->root[2] : w->root[1]) / sigma[k] : k);
    }
    const double phi = TWO_PI * azimuth / t->azimuths;
    for (uint32_t i = 0; i < t->cosines; i++, rgb += 3) {
        const double z = fmax((double)i * i / ((t->cosines - 1.0) * (t->cosines - 1.0)), LEAST_COSINE),
                     flat = sqrt((1 - z) * (1 + z));
        const float x = (float)(flat * cos(phi)), y = (float)(flat * sin(phi));
        const float *turn = w->lobe->turn;
        const float wo[3] = {w->map ? x : turn[0] * x - turn[1] * y, w->map ? y : turn[1] * x + turn[0] * y, (float)z};
        if (closure) mean_weight(w, m, wo, (uint64_t)row * t->cosines + i, closure, rgb);
        else rgb[0] = rgb[1] = rgb[2] = NAN;
    }
    free(closure);
}

static void place_sigmas(mu_albedo_table *t, const mu_ibl_lobe_f *low, const mu_ibl_lobe_f *high) {
    for (int k = 0; k < 2; k++) {
        const float range = logf(high->sigma[k] / low->sigma[k]);
        t->least[k] = logf(low->sigma[k]);
        if (!(range > 1e-4f)) {
            t->least[k] += range / 2;
            continue;
        }
        const float wanted = ceilf(range / SIGMA_STEP) + 1;
        t->sigmas[k] = wanted < SIGMAS_MOST ? (uint32_t)wanted : SIGMAS_MOST;
        t->step[k] = range / (float)(t->sigmas[k] - 1);
    }
}

_Bool mu_albedo_table_make(mu_albedo_table *t, const mu_material *material, const musurf_map *map,
                           const musurf_moments *still, const mu_ibl_lobe_f *low, const mu_ibl_lobe_f *high,
                           uint32_t threads, mu_error *error) {
    *t = (mu_albedo_table){.cosines = 64, .azimuths = 96, .sigmas = {1, 1}};
    if (!(material->plan.needs & MUSURF_NEEDS_TANGENT)) t->azimuths = 1;
    work w = {.table = t, .material = material, .map = map, .lobe = low};
    if (map && low->sigma[1] > 0) { /* else there is no M that makes it of a mirror: the identity stands for all */
        w.root[0] = sqrt(still->xx), w.root[1] = still->xx > 0 ? still->xy / w.root[0] : 0;
        w.root[2] = sqrt(fmax(still->yy - w.root[1] * w.root[1], 0));
        place_sigmas(t, low, high);
    }
    if (t->sigmas[0] * t->sigmas[1] > 1) t->cosines = 32, t->azimuths = 24;
    const uint32_t nodes = t->sigmas[0] * t->sigmas[1] * t->azimuths * t->cosines, affordable = (1u << 14) / nodes;
    w.most = affordable < LEAST_BATCHES ? LEAST_BATCHES : affordable < 512 ? affordable : 512;
    t->rgb = malloc(mu_albedo_table_bytes(t));
    if (!t->rgb) return mu_fail(error, "not enough memory for a table of albedos");
    mu_rows(t->sigmas[0] * t->sigmas[1] * t->azimuths, threads, fill, &w);
    for (size_t i = 0; i < mu_albedo_table_bytes(t) / sizeof(float); i++)
        if (!isfinite(t->rgb[i])) return mu_fail(error, "a table of albedos could not be made");
    return 1;
}

void mu_albedo_table_free(mu_albedo_table *t) {
    free(t->rgb);
    t->rgb = NULL;
}

size_t mu_albedo_table_bytes(const mu_albedo_table *t) {
    return 3 * sizeof(float) * t->cosines * t->azimuths * t->sigmas[0] * t->sigmas[1];
}

/* A node and the share of the one after it. */
typedef struct place {
    uint32_t node;
    float share;
} place;

static place between(float at, uint32_t count) {
    if (!(at > 0) || count < 2) return (place){0, 0};
    if (!(at < (float)(count - 1))) return (place){count - 2, 1};
    const uint32_t node = (uint32_t)at;
    return (place){node, at - (float)node};
}

void mu_albedo_table_at(const mu_albedo_table *t, const mu_ibl_lobe_f *lobe, const float wo[3], float rgb[3]) {
    const place z = between(sqrtf(fmaxf(wo[2], 0)) * (float)(t->cosines - 1), t->cosines);
    place around = {0, 0};
    if (t->azimuths > 1) {
        const float x = lobe->turn[0] * wo[0] + lobe->turn[1] * wo[1],
                    y = lobe->turn[0] * wo[1] - lobe->turn[1] * wo[0];
        const float turns = atan2f(y, x) * (float)(1 / TWO_PI), at = (turns < 0 ? turns + 1 : turns) * (float)t->azimuths;
        const uint32_t node = (uint32_t)at;
        around = (place){node, at - (float)node};
    }
    place s[2] = {{0, 0}, {0, 0}};
    for (int k = 0; k < 2; k++)
        if (t->sigmas[k] > 1) s[k] = between((logf(lobe->sigma[k]) - t->least[k]) / t->step[k], t->sigmas[k]);
    rgb[0] = rgb[1] = rgb[2] = 0;
    for (uint32_t corner = 0; corner < 8; corner++) {
        const uint32_t i = corner & 1, j = corner >> 1 & 1, k = corner >> 2;
        const float weight = (i ? s[0].share : 1 - s[0].share) * (j ? s[1].share : 1 - s[1].share) *
                             (k ? around.share : 1 - around.share);
        if (!(weight > 0)) continue;
        const uint32_t row = ((s[0].node + i) * t->sigmas[1] + s[1].node + j) * t->azimuths +
                             (around.node + k) % t->azimuths;
        const float *a = t->rgb + (size_t)3 * (row * t->cosines + z.node);
        for (int c = 0; c < 3; c++) rgb[c] += weight * ((1 - z.share) * a[c] + z.share * a[3 + c]);
    }
}
