/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_random.c: the numbers of random.h are a function of their four arguments, uniform over pixels and
 * seeds, stratified over a pixel's samples, and unrelated between dimensions and pixels. Random comparisons:
 * 3 x 3 + 4.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "core/render/random.h"
#include "tests/moments.h"

/* A (0,2)-sequence: each of the first blocks of 2^k samples, from 0 and from 2^k, has exactly one point in
 * every elementary interval of area 2^-k. */
static void test_pairs_are_stratified(void **state) {
    (void)state;
    for (uint64_t seed = 0; seed < 64; seed++)
        for (uint32_t k = 0; k <= 8; k++)
            for (uint32_t a = 0; a <= k; a++)
                for (uint32_t block = 0; block < 2; block++) {
                    unsigned char seen[256] = {0};
                    for (uint32_t i = 0; i < 1u << k; i++) {
                        mu_random random = mu_random_start(seed, 3, 7, (block << k) + i);
                        random.dimension = (uint32_t)seed;
                        float u[2];
                        mu_random_pair(&random, u);
                        const uint32_t x = (uint32_t)(u[0] * (float)(1u << a));
                        const uint32_t y = (uint32_t)(u[1] * (float)(1u << (k - a)));
                        assert_int_equal(seen[x << (k - a) | y]++, 0);
                    }
                }
}

static void even(const double *seen, int cells, double expected, const char *what) {
    double chi2 = 0;
    for (int i = 0; i < cells; i++) chi2 += (seen[i] - expected) * (seen[i] - expected) / expected;
    const double p = p_of_chi2(chi2, cells - 1);
    print_message("%s: chi^2 %.1f of %d, p = %.3g\n", what, chi2, cells - 1, p);
    assert_true(p > significance_level());
}

/* At a fixed sample index, over pixels: pairs fill the square evenly; two pairs of one path, and the same
 * pair of two neighbouring pixels, fill the square of their first members evenly. */
static void test_numbers_are_even_over_pixels(void **state) {
    (void)state;
    enum { SIDE = 16, PIXELS = 1 << 20 };
    const uint32_t samples[3] = {0, 1, 37};
    for (int s = 0; s < 3; s++) {
        static double pair[SIDE * SIDE], paths[SIDE * SIDE], neighbours[SIDE * SIDE];
        memset(pair, 0, sizeof pair);
        memset(paths, 0, sizeof paths);
        memset(neighbours, 0, sizeof neighbours);
        for (uint32_t i = 0; i < PIXELS; i++) {
            mu_random random = mu_random_start(12, 2 * (i % 1024), i / 1024, samples[s]);
            mu_random next = mu_random_start(12, 2 * (i % 1024) + 1, i / 1024, samples[s]);
            float u[2], v[2], w[2];
            mu_random_pair(&random, u);
            mu_random_pair(&random, v);
            mu_random_pair(&next, w);
            const int x = (int)(u[0] * SIDE);
            pair[x * SIDE + (int)(u[1] * SIDE)]++;
            paths[x * SIDE + (int)(v[0] * SIDE)]++;
            neighbours[x * SIDE + (int)(w[0] * SIDE)]++;
        }
        const double expected = (double)PIXELS / (SIDE * SIDE);
        even(pair, SIDE * SIDE, expected, "a pair");
        even(paths, SIDE * SIDE, expected, "two pairs of a path");
        even(neighbours, SIDE * SIDE, expected, "two pixels");
    }
}

/* The estimates of an integral over two pairs and one single, from 16 samples each, are unbiased over pixels;
 * and the scheme earns its cost: its variance is below that of independent numbers. f = product of (1 + (2u -
 * 1) c) style smooth factors and one edge; integral 1/2. */
static double estimate(uint32_t pixel, _Bool independent) {
    double sum = 0;
    for (uint32_t sample = 0; sample < 16; sample++) {
        mu_random random = mu_random_start(13, pixel, 5, sample);
        random.independent = independent;
        float u[2], v[2];
        mu_random_pair(&random, u);
        mu_random_pair(&random, v);
        const float w = mu_random_one(&random);
        sum += u[0] + u[1] < 1 ? 4.0 * (double)(v[0] * v[1]) * 2.0 * (double)w : 0;
    }
    return sum / 16;
}

static void test_estimates_are_unbiased_and_quieter(void **state) {
    (void)state;
    moments scheme = {0, 0, 0}, plain = {0, 0, 0};
    for (uint32_t pixel = 0; pixel < 50000; pixel++) {
        accumulate(&scheme, estimate(pixel, 0));
        accumulate(&plain, estimate(pixel, 1));
    }
    agrees(&scheme, 0.5, 1e-6,
           "scrambled Sobol"); /* the 24-bit grid is short by half a step in each number */
    agrees(&plain, 0.5, 1e-6, "independent");
    const double ratio = (plain.squares / plain.n - pow(plain.sum / plain.n, 2)) /
                         (scheme.squares / scheme.n - pow(scheme.sum / scheme.n, 2));
    print_message("variance of independent numbers / of ours, 16 samples of 5 dimensions: %.2f\n", ratio);
    assert_true(ratio > 1.5);
}

static void test_numbers_depend_on_nothing_else(void **state) {
    (void)state;
    mu_random a = mu_random_start(7, 100, 200, 33), b = mu_random_start(7, 100, 200, 33);
    float u[2], v[2];
    mu_random_one(&b); /* draws are addressed by dimension, not by history */
    mu_random_pair(&a, u);
    b.dimension = 0;
    mu_random_pair(&b, v);
    assert_true(u[0] == v[0] && u[1] == v[1]);
    mu_random c = mu_random_start(8, 100, 200, 33), d = mu_random_start(7, 200, 100, 33);
    mu_random_pair(&c, u);
    assert_true(u[0] != v[0]);
    mu_random_pair(&d, u);
    assert_true(u[0] != v[0]);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pairs_are_stratified),
        cmocka_unit_test(test_numbers_are_even_over_pixels),
        cmocka_unit_test(test_estimates_are_unbiased_and_quieter),
        cmocka_unit_test(test_numbers_depend_on_nothing_else),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
