/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * musurf_sampler.c: which sampler serves a material best, by measurement when it is compiled: the variance of its weights
 * in a white furnace over four views. Rough surfaces reflect visible normals near the horizon downward, where they are lost:
 * folded ones are better, with three directions in ten drawn uniformly where tails are very long, or bounded ones of ggx.
 */
#include <math.h>

#include "plugin/musurf_compiled.h"

enum { VIEWS = 4, SAMPLES = 256 };
#define WORTH 0.98 /* of the second moment: what another density per call, and no short plan, has to save */

/* The surface under test, in the precision it is shaded in: double has no tables, and takes its time. */
typedef struct trial {
    const mu_surface_f *in_float; /* or NULL */
    const mu_surface_d *in_double;
    union {
        mu_closure_f f;
        mu_closure_d d;
    } closure;
} trial;

static int bind(trial *t, const double wo[3]) {
    const float w[3] = {(float)wo[0], (float)wo[1], (float)wo[2]};
    return t->in_float ? mu_bind_f(t->in_float, w, NULL, &t->closure.f)
                       : mu_bind_d(t->in_double, wo, NULL, &t->closure.d);
}

/* The mean of the channels. */
static double weight_of(const trial *t, mu_sampler sampler, const double u[3]) {
    if (t->in_float) {
        const float v[3] = {(float)u[0], (float)u[1], (float)u[2]};
        mu_sample_f s;
        mu_sample_with_f(&t->closure.f, sampler, v, &s);
        return s.rejected ? 0 : (double)(s.weight[0] + s.weight[1] + s.weight[2]) / 3;
    }
    mu_sample_d s;
    mu_sample_with_d(&t->closure.d, sampler, u, &s);
    return s.rejected ? 0 : (s.weight[0] + s.weight[1] + s.weight[2]) / 3;
}

/* The mean over the views of variance / mean² of one sample's weight; u is the R3 sequence (Roberts 2018). */
static double noise_of(trial *t, mu_sampler sampler) {
    static const double angles[VIEWS] = {0.1, 0.6, 1.1, 1.4};
    double noise = 0;
    for (int v = 0; v < VIEWS; v++) {
        const double azimuth = 0.7 + v,
                     wo[3] = {sin(angles[v]) * cos(azimuth), sin(angles[v]) * sin(azimuth), cos(angles[v])};
        double sum = 0, squares = 0;
        if (!bind(t, wo)) return INFINITY;
        for (int i = 0; i < SAMPLES; i++) {
            const double u[3] = {fmod(0.5 + i * 0.8191725133961645, 1), fmod(0.5 + i * 0.6710436067037893, 1),
                                 fmod(0.5 + i * 0.5497004779019703, 1)};
            const double weight = weight_of(t, sampler, u);
            sum += weight, squares += weight * weight;
        }
        const double mean = sum / SAMPLES;
        noise += mean > 0 ? squares / SAMPLES / (mean * mean) - 1 : 0;
    }
    return noise / VIEWS;
}

/* One surface serves all samplers but the bounded one. NAN: not for this definition. */
static double measure(trial *t, const mu_definition *definition, mu_sampler sampler, int in_float,
                      void *memory) {
    mu_definition d = *definition;
    mu_complaint why;
    d.sampler = sampler, d.multiple = MU_SINGLE; /* what is added is smooth whichever draws */
    if (!mu_definition_check(&d, &why)) return NAN;
    if (sampler == MU_SAMPLE_BOUNDED || (!t->in_float && !t->in_double)) {
        if (in_float)
            t->in_float = mu_surface_make_f(&d, memory);
        else
            t->in_double = mu_surface_make_d(&d, memory);
    }
    return noise_of(t, sampler);
}

mu_sampler musurf_choose_sampler(const mu_definition *definition, int in_float, void *memory,
                                 double *least_noise) {
    static const mu_sampler samplers[] = {MU_SAMPLE_FOLDED, MU_SAMPLE_FOLDED_UNIFORM,
                                          MU_SAMPLE_VISIBLE_UNIFORM, MU_SAMPLE_BOUNDED};
    mu_sampler best = MU_SAMPLE_VISIBLE; /* of what transmits: the others know reflection alone */
    if (definition->transmission) return best;
    trial t = {0};
    double least = INFINITY, visible = NAN;
    for (size_t i = 0; i < sizeof samplers / sizeof samplers[0]; i++) {
        const double noise = measure(&t, definition, samplers[i], in_float, memory);
        if (i == 0) visible = noise_of(&t, MU_SAMPLE_VISIBLE);
        if (noise < least) least = noise, best = samplers[i];
    }
    /* Light of variance L² makes noise of (1 + noise)(1 + L²) - 1 */
    if (!(1 + least < WORTH * (1 + visible))) least = visible, best = MU_SAMPLE_VISIBLE;
    *least_noise = visible > 0 ? least / visible : 1;
    return best;
}
