/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * musurf_sampler.c: which sampler serves a material best, by measurement when it is compiled: the variance of its weights
 * in a white furnace over four views. Visible normals win nearly always; where tails are very long, normals near the
 * horizon reflect downward and are lost, and three directions in ten drawn uniformly are better. Of ggx, bounded ones win.
 */
#include <math.h>

#include "plugin/musurf_compiled.h"

enum { VIEWS = 4, SAMPLES = 1024 };

/* The sum over the views of variance / mean² of one sample's weight; u is the R3 sequence (Roberts 2018). */
static double noise_of(const mu_surface_d *surface, mu_sampler sampler) {
    static const double angles[VIEWS] = {0.1, 0.6, 1.1, 1.4};
    double noise = 0;
    for (int v = 0; v < VIEWS; v++) {
        const double azimuth = 0.7 + v,
                     wo[3] = {sin(angles[v]) * cos(azimuth), sin(angles[v]) * sin(azimuth), cos(angles[v])};
        double sum = 0, squares = 0;
        mu_closure_d closure;
        if (!mu_bind_d(surface, wo, NULL, &closure)) return INFINITY;
        for (int i = 0; i < SAMPLES; i++) {
            const double u[3] = {fmod(0.5 + i * 0.8191725133961645, 1), fmod(0.5 + i * 0.6710436067037893, 1),
                                 fmod(0.5 + i * 0.5497004779019703, 1)};
            mu_sample_d s;
            mu_sample_with_d(&closure, sampler, u, &s);
            const double weight = s.rejected ? 0 : (s.weight[0] + s.weight[1] + s.weight[2]) / 3;
            sum += weight, squares += weight * weight;
        }
        const double mean = sum / SAMPLES;
        noise += mean > 0 ? squares / SAMPLES / (mean * mean) - 1 : 0;
    }
    return noise;
}

mu_sampler musurf_choose_sampler(const mu_definition *definition, void *memory) {
    static const mu_sampler samplers[] = {MU_SAMPLE_VISIBLE, MU_SAMPLE_VISIBLE_UNIFORM, MU_SAMPLE_BOUNDED,
                                          MU_SAMPLE_FOLDED, MU_SAMPLE_FOLDED_UNIFORM};
    mu_sampler best = MU_SAMPLE_VISIBLE; /* of what transmits: the others know reflection alone */
    double least = INFINITY;
    for (size_t i = 0; i < sizeof samplers / sizeof samplers[0]; i++) {
        mu_definition d = *definition;
        mu_complaint why;
        d.sampler = samplers[i];
        if (!mu_definition_check(&d, &why)) continue;
        d.multiple = MU_SINGLE; /* what is added is smooth whichever draws */
        const double noise = noise_of(mu_surface_make_d(&d, memory), d.sampler);
        if (noise < least) least = noise, best = d.sampler;
    }
    return best;
}
