/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * even_light.c: see even_light.h. f cos, of directions along the lobe (even.h), converges fast where the lobe is smooth, and as
 * fast as it must where a tilt creases it; a random walk, whose f is noise, is better off by weights of its own samples, bounded
 * if random. What f jumps in, a histogram, knows its albedo itself, or nobody does.
 */
#include "core/render/even_light.h"

#include <math.h>

#include "core/ibl/even.h"
#include "core/render/philox.h"

enum { DRAWN = 256, LEAST_BATCHES = 4 };

static void by_samples(const mu_even_source *s, size_t first, size_t count, const double shift[3], double mean[3]) {
    mean[0] = mean[1] = mean[2] = 0;
    for (size_t i = 0; i < count; i++) {
        double u[3], rgb[3];
        mu_ibl_lattice(shift, first + i, u);
        s->drawn(s->context, u, rgb);
        for (int c = 0; c < 3; c++) mean[c] += rgb[c] / (double)count;
    }
}

/* One more batch (Welford); `square`: of what the batches are off. */
static void add(mu_even_mean *mean, double square[3], size_t before, const double batch[3]) {
    double worst = 0;
    for (int c = 0; c < 3; c++) {
        const double off = batch[c] - mean->rgb[c];
        mean->rgb[c] += off / (double)(before + 1);
        square[c] += off * (batch[c] - mean->rgb[c]);
        worst = fmax(worst, square[c]);
    }
    mean->error = before ? sqrt(worst / ((double)before * (double)(before + 1))) : INFINITY;
}

static mu_even_mean converge_by_samples(const mu_even_source *s, const mu_even_effort *effort) {
    mu_even_mean mean = {{0, 0, 0}, INFINITY};
    double square[3] = {0, 0, 0}, batch[3];
    for (size_t b = 0; b < LEAST_BATCHES || ((b + 1) * DRAWN <= effort->most && mean.error > effort->enough); b++) {
        by_samples(s, b * DRAWN, DRAWN, (const double[3]){0.5, 0.5, 0.5}, batch);
        add(&mean, square, b, batch);
    }
    return mean;
}

static mu_even_mean converge_by_directions(const mu_even_source *s, const double wo[3], const mu_even_effort *effort) {
    double value[EVEN_PARTS];
    mu_ibl_even even;
    mu_ibl_even_make(s->lobe, wo, &even);
    const double error = mu_ibl_even_mean(&even, s->toward, s->context, effort->enough, effort->most, value);
    return (mu_even_mean){{value[0], value[1], value[2]}, error};
}

mu_even_mean mu_even_light(const mu_even_source *s, const double wo[3], const mu_even_effort *effort) {
    mu_even_mean mean = {{0, 0, 0}, 0};
    if (s->known && s->known(s->context, effort->enough, mean.rgb)) return mean;
    if (!s->lobe) return converge_by_samples(s, effort);
    return converge_by_directions(s, wo, effort);
}

mu_even_mean mu_even_light_shifted(const mu_even_source *s, const double wo[3], size_t batches, size_t each,
                                   unsigned long long seed, unsigned long long index) {
    const mu_ibl_fibonacci lattice = mu_ibl_fibonacci_below(each > 2 ? each : 2);
    mu_even_mean by[2] = {{{0, 0, 0}, INFINITY}, {{0, 0, 0}, INFINITY}};
    double square[2][3] = {{0, 0, 0}, {0, 0, 0}}, batch[3], shift[3];
    mu_ibl_even even;
    if (s->lobe) mu_ibl_even_make(s->lobe, wo, &even);
    for (size_t b = 0; b < batches; b++) {
        mu_philox_uniforms(seed, index * batches + b, shift);
        by_samples(s, 0, s->lobe ? each : 2 * each, shift, batch);
        add(&by[0], square[0], b, batch);
        if (!s->lobe) continue;
        double value[EVEN_PARTS];
        mu_ibl_even_by(&even, lattice, shift, s->toward, s->context, value);
        add(&by[1], square[1], b, value);
    }
    return by[by[1].error < by[0].error];
}
