/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* generate.c: passes of remapping ranks and projecting; see generate.h. */
#include "core/surface/generate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/surface/noise.h"
#include "core/surface/rank.h"

static const double pi = 3.14159265358979323846;

struct mu_generator {
    mu_recipe recipe;
    size_t count;   /* cells */
    double *h;      /* per cell */
    float *wish;    /* per cell: quantiles in rising order */
    float *gx, *gy; /* per cell: by how much the differences to the next cell in x and y should change */
    mu_ranked *ranked, *spare;
    double *cosine;    /* of 2 pi a / n */
    double limit, cap; /* the quantile `clip`, and the steepest wish that is granted */
    double steepest;   /* over limit */
    uint32_t passes;
};

mu_generator *mu_generator_make(const mu_recipe *recipe) {
    mu_generator *g = calloc(1, sizeof *g);
    if (!g) return NULL;
    g->recipe = *recipe;
    g->count = (size_t)recipe->n * recipe->n;
    g->h = malloc(g->count * sizeof *g->h);
    g->wish = malloc(g->count * sizeof *g->wish);
    g->gx = malloc(g->count * sizeof *g->gx);
    g->gy = malloc(g->count * sizeof *g->gy);
    g->ranked = malloc(g->count * sizeof *g->ranked);
    g->spare = malloc(g->count * sizeof *g->spare);
    g->cosine = malloc(recipe->n * sizeof *g->cosine);
    if (!g->h || !g->wish || !g->gx || !g->gy || !g->ranked || !g->spare || !g->cosine) {
        mu_generator_free(g);
        return NULL;
    }
    g->limit = g->cap = mu_slope_quantile(&recipe->law, recipe->clip);
    for (size_t k = 0; k < g->count; k++) {
        const double u = ((double)k + 0.5) / (double)g->count;
        g->wish[k] = (float)mu_slope_quantile(&recipe->law, u < recipe->clip ? u : recipe->clip);
    }
    for (uint32_t a = 0; a < recipe->n; a++) g->cosine[a] = cos(2 * pi * a / recipe->n);
    return g;
}

void mu_generator_free(mu_generator *g) {
    if (!g) return;
    free(g->h);
    free(g->wish);
    free(g->gx);
    free(g->gy);
    free(g->ranked);
    free(g->spare);
    free(g->cosine);
    free(g);
}

mu_heightfield mu_generator_surface(const mu_generator *g) {
    return (mu_heightfield){g->h, g->recipe.n, g->recipe.n};
}

double mu_generator_steepest(const mu_generator *g) {
    return g->steepest;
}

/* Amplitude of the mode: the root of the Fourier transform of exp(-r^2/correlation^2). */
static double gaussian(const void *state, uint32_t a, uint32_t b) {
    const mu_generator *g = state;
    const double step = 2 * pi / g->recipe.n, t = g->recipe.correlation;
    const double kx = step * (a <= g->recipe.n / 2 ? a : a - (double)g->recipe.n), ky = step * b;
    return a || b ? exp(-t * t / 8 * (kx * kx + ky * ky)) : 0;
}

/* The inverse of the discrete Laplacian that two forward differences and their adjoints make. */
static double inverse_laplacian(const void *state, uint32_t a, uint32_t b) {
    const mu_generator *g = state;
    return a || b ? 1 / (4 - 2 * g->cosine[a] - 2 * g->cosine[b]) : 0;
}

/* Adds the field, times a factor, to the heights and rounds them to float, what the file will hold. */
static void add(mu_generator *g, double factor) {
    for (size_t k = 0; k < g->count; k++) g->h[k] = (double)(float)(g->h[k] + factor * (double)g->gx[k]);
}

static void find_steepest(mu_generator *g) {
    const mu_heightfield f = mu_generator_surface(g);
    double most = 0;
    for (uint32_t i = 0; i < f.nx; i++)
        for (uint32_t j = 0; j < f.nx; j++)
            for (int upper = 0; upper < 2; upper++) {
                double s[2];
                mu_facet_slope(&f, i, j, upper, s);
                most = fmax(most, s[0] * s[0] + s[1] * s[1]);
            }
    g->steepest = sqrt(most) / g->limit;
}

_Bool mu_generator_start(mu_generator *g, const mu_spectral *fft) {
    const mu_heightfield f = mu_generator_surface(g);
    for (size_t k = 0; k < g->count; k++) g->gx[k] = (float)mu_noise_normal(g->recipe.seed, k);
    if (!fft->apply(fft->context, g->gx, f.nx, gaussian, g)) return 0;
    memset(g->h, 0, g->count * sizeof *g->h);
    add(g, 1);

    /* As steep, in the mean of squares, as the law without its last hundredth. */
    double have = 0, want = 0;
    for (uint32_t i = 0; i < f.nx; i++)
        for (uint32_t j = 0; j < f.nx; j++) {
            double s[2];
            mu_facet_slope(&f, i, j, MU_LOWER, s);
            have += s[0] * s[0] + s[1] * s[1];
        }
    const double bulk = mu_slope_quantile(&g->recipe.law, fmin(0.99, g->recipe.clip));
    for (size_t k = 0; k < g->count; k++) {
        const double s = fmin((double)g->wish[k], bulk);
        want += s * s;
    }
    memset(g->h, 0, g->count * sizeof *g->h);
    if (have > 0) add(g, sqrt(want / have));
    g->cap = g->limit;
    g->passes = 0;
    find_steepest(g);
    return 1;
}

/* w, symmetric with rows (w[0], w[1]) and (w[1], w[2]): the map after which the unit vectors along the slopes have no
 * preferred axis. To first order in their covariance C - 1/2, which is all that passes that repeat it need. */
static void isotropy(const mu_generator *g, double w[3]) {
    const mu_heightfield f = mu_generator_surface(g);
    double xx = 0, xy = 0, all = 0;
    for (uint32_t i = 0; i < f.nx; i++)
        for (uint32_t j = 0; j < f.nx; j++)
            for (int upper = 0; upper < 2; upper++) {
                double s[2];
                mu_facet_slope(&f, i, j, upper, s);
                const double r2 = s[0] * s[0] + s[1] * s[1];
                if (r2 > 0) xx += s[0] * s[0] / r2, xy += s[0] * s[1] / r2, all++;
            }
    const double dx = all > 0 ? xx / all - 0.5 : 0, dxy = all > 0 ? xy / all : 0;
    w[0] = 1 - dx;
    w[1] = -dxy;
    w[2] = 1 + dx;
}

/* What the facets of one family wish, less what they have, half of it to each of the differences they are made of. */
static void wish(mu_generator *g, int upper, const double w[3]) {
    const mu_heightfield f = mu_generator_surface(g);
    for (uint32_t i = 0; i < f.nx; i++)
        for (uint32_t j = 0; j < f.nx; j++) {
            const size_t k = (size_t)i * f.nx + j;
            double s[2];
            mu_facet_slope(&f, i, j, upper, s);
            g->ranked[k] = (mu_ranked){(float)sqrt(s[0] * s[0] + s[1] * s[1]), (uint32_t)k};
        }
    mu_rank_sort(g->ranked, g->spare, g->count);
    for (size_t k = 0; k < g->count; k++) {
        const uint32_t index = g->ranked[k].index, i = index / f.nx, j = index % f.nx;
        double s[2];
        mu_facet_slope(&f, i, j, upper, s);
        const double x = w[0] * s[0] + w[1] * s[1], y = w[1] * s[0] + w[2] * s[1], r = sqrt(x * x + y * y);
        const double steep = fmin((double)g->wish[k], g->cap);
        const double dx = (r > 0 ? steep * x / r : steep) - s[0], dy = (r > 0 ? steep * y / r : 0) - s[1];
        const uint32_t next_i = i + 1 < f.nx ? i + 1 : 0, next_j = j + 1 < f.nx ? j + 1 : 0;
        g->gx[upper ? (size_t)i * f.nx + next_j : index] += (float)(0.5 * dx);
        g->gy[upper ? (size_t)next_i * f.nx + j : index] += (float)(0.5 * dy);
    }
}

/* The adjoint of the forward differences, applied to (gx, gy); the result replaces gx. */
static void diverge(mu_generator *g) {
    const uint32_t n = g->recipe.n;
    float *out = (float *)g->spare; /* free between two sorts, and larger */
    for (uint32_t i = 0; i < n; i++) {
        const size_t row = (size_t)i * n, before = (size_t)(i ? i - 1 : n - 1) * n;
        for (uint32_t j = 0; j < n; j++)
            out[row + j] =
                g->gx[before + j] - g->gx[row + j] + g->gy[row + (j ? j - 1 : n - 1)] - g->gy[row + j];
    }
    memcpy(g->gx, out, g->count * sizeof *g->gx);
}

_Bool mu_generator_pass(mu_generator *g, const mu_spectral *fft) {
    /* A law with a heavy tail is far away at first, and overshooting is for the end of a way. */
    const double overshoot = g->passes < 4 ? 1 : 1.7;
    double w[3];
    isotropy(g, w);
    memset(g->gx, 0, g->count * sizeof *g->gx);
    memset(g->gy, 0, g->count * sizeof *g->gy);
    wish(g, MU_LOWER, w);
    wish(g, MU_UPPER, w);
    diverge(g);
    if (!fft->apply(fft->context, g->gx, g->recipe.n, inverse_laplacian, g)) return 0;
    add(g, overshoot);
    find_steepest(g);
    if (++g->passes > 4 && g->steepest > 1) g->cap /= g->steepest;
    return 1;
}
