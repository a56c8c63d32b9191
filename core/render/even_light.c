/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * even_light.c: see even_light.h. f cos, of directions along the lobe (even.h), converges fast where the lobe is smooth; a
 * random walk, whose f is noise, and a histogram, whose jumps are many, are better off by weights of their own samples, bounded
 * if random.
 *
 * Lattices of Fibonacci numbers of points, the one after the other: errors fall by more than 2 from each to the next (those of
 * 144 points are some 1e-3), so that two steps of which the first is below 4 `enough` and the second below 2 leave `enough`.
 */
#include "core/render/even_light.h"

#include <math.h>

#include "core/ibl/even.h"
#include "core/render/philox.h"

enum { FIRST = 89, SECOND = 144, DRAWN = 256, LEAST_BATCHES = 4 };

static void by_directions(const mu_even_source *s, const mu_ibl_even *even, mu_ibl_fibonacci lattice,
                          const double shift[2], double mean[3]) {
    mean[0] = mean[1] = mean[2] = 0;
    for (uint32_t i = 0; i < lattice.count; i++) {
        double u[2], wi[3], rgb[3];
        mu_ibl_fibonacci_at(lattice, shift, i, u);
        const double weight = mu_ibl_even_direction(even, u, wi) / lattice.count;
        if (!(weight > 0)) continue;
        s->toward(s->context, wi, rgb);
        for (int c = 0; c < 3; c++) mean[c] += weight * rgb[c];
    }
}

static mu_even_mean by_slopes(const mu_even_source *s, const double wo[3]) {
    mu_even_mean out = {{0, 0, 0}, 0};
    for (size_t i = 0; i < s->slope_count; i++) {
        double wi[3], rgb[3];
        const double weight = s->slopes[i][2] * mu_ibl_even_of_slope(wo, s->slopes[i], wi);
        if (!(weight > 0)) continue;
        s->toward(s->context, wi, rgb);
        for (int c = 0; c < 3; c++) out.rgb[c] += weight * rgb[c];
    }
    return out;
}

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
    static const double still[2] = {0, 0};
    mu_ibl_even even;
    mu_ibl_fibonacci lattice = mu_ibl_fibonacci_below(FIRST);
    mu_even_mean mean = {{0, 0, 0}, INFINITY};
    double before = INFINITY, next[3];
    mu_ibl_even_make(s->lobe, wo, &even);
    for (size_t calls = 0;; lattice = (mu_ibl_fibonacci){lattice.count, lattice.before + lattice.count}) {
        by_directions(s, &even, lattice, still, next);
        double step = lattice.count > FIRST ? 0 : INFINITY;
        for (int c = 0; c < 3; c++) {
            step = fmax(step, fabs(next[c] - mean.rgb[c]));
            mean.rgb[c] = next[c];
        }
        mean.error = lattice.count > SECOND ? fmax(step / 2, before / 4) : INFINITY;
        before = step, calls += lattice.count;
        if (mean.error <= effort->enough || calls + lattice.before + lattice.count > effort->most) return mean;
    }
}

mu_even_mean mu_even_light(const mu_even_source *s, const double wo[3], mu_even_effort *effort) {
    if (s->slopes) return by_slopes(s, wo);
    if (!s->lobe) return converge_by_samples(s, effort);
    const mu_even_mean mean = converge_by_directions(s, wo, effort);
    if (mean.error <= 2 * effort->enough) return mean; /* the other way would take as long for little */
    const mu_even_mean other = converge_by_samples(s, effort);
    effort->drawn = other.error < mean.error;
    return effort->drawn ? other : mean;
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
        by_directions(s, &even, lattice, shift, batch);
        add(&by[1], square[1], b, batch);
    }
    return by[by[1].error < by[0].error];
}
