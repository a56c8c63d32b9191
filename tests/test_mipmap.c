/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_mipmap.c: means over parallelograms of a picture, and covariances to M and back. What is known without any of it:
 * equal texels, ramps (which every symmetric mean leaves alone), stripes along and across, and closed forms of spreads.
 */
#include "core/render/covariance.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>
#include <cmocka.h>

#include "tests/uniform.h"

static const mu_wrap wraps[] = {MU_WRAP_REPEAT, MU_WRAP_CLAMP, MU_WRAP_MIRROR};

static mu_mipmap make(int width, int height, mu_wrap wrap, float (*value)(int x, int y)) {
    mu_mipmap m;
    assert_true(mu_mipmap_make(&m, width, height, 1, wrap));
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) m.texels[y * width + x] = value(x, y);
    mu_mipmap_build(&m);
    return m;
}

static double at(const mu_mipmap *m, double u, double v, double a, double b, double c, double d) {
    double out[MU_MIPMAP_CHANNELS];
    mu_mipmap_at(m, (const double[2]){u, v}, (const double[4]){a, b, c, d}, NULL, out);
    return out[0];
}

static float third(int x, int y) {
    (void)x, (void)y;
    return 1.f / 3;
}

static void test_equal_texels_are_their_value(void **state) {
    (void)state;
    uniform random = {1};
    for (int k = 0; k < 3; k++) {
        mu_mipmap m = make(37, 22, wraps[k], third);
        for (int i = 0; i < 2000; i++) {
            double r[6];
            for (int j = 0; j < 6; j++) r[j] = uniform_double(&random) * 4 - 2;
            const double size = pow(10, uniform_double(&random) * 8 - 6);
            assert_true(at(&m, r[0], r[1], r[2] * size, r[3] * size, r[4] * size, r[5] * size) ==
                        (double)(1.f / 3));
        }
        assert_true(at(&m, NAN, INFINITY, 1, 0, 0, 1) == (double)(1.f / 3));
        assert_true(at(&m, 0.5, 0.5, INFINITY, 0, 0, NAN) == (double)(1.f / 3));
        assert_true(at(&m, 0.5, 0.5, 0, 0, 0, 0) == (double)(1.f / 3));
        mu_mipmap_free(&m);
    }
}

static float noise(int x, int y) {
    uint32_t h = (uint32_t)x * 2654435761u ^ (uint32_t)y * 2246822519u;
    h = (h ^ h >> 15) * 2246822519u;
    return (float)(h >> 8) * 0x1p-24f;
}

static void test_the_coarsest_level_is_the_mean(void **state) {
    (void)state;
    static const int sizes[][2] = {{64, 64}, {1, 1}, {37, 22}, {5, 200}, {1, 7}};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        double mean = 0;
        mu_mipmap m = make(sizes[k][0], sizes[k][1], MU_WRAP_REPEAT, noise);
        const size_t count = (size_t)sizes[k][0] * (size_t)sizes[k][1];
        for (size_t i = 0; i < count; i++) mean += (double)m.texels[i] / (double)count;
        /* every level is rounded to float: 2^-24 of values below 1, at most 9 times */
        assert_true(fabs((double)m.texels[m.level[m.levels - 1].at] - mean) < 9 * 0x1p-24);
        assert_true(fabs(at(&m, 0.3, 0.7, INFINITY, 0, 0, 1) - mean) < 9 * 0x1p-24);
        mu_mipmap_free(&m);
    }
}

static float ramp(int x, int y) {
    return (float)x + 3 * (float)y;
}

/* v grows upwards, lines downwards. */
static void test_ramps_stay(void **state) {
    (void)state;
    mu_mipmap m = make(256, 256, MU_WRAP_CLAMP, ramp);
    uniform random = {2};
    for (int i = 0; i < 2000; i++) {
        const double u = 0.4 + 0.2 * uniform_double(&random), v = 0.4 + 0.2 * uniform_double(&random);
        const double size = 0.1 * uniform_double(&random), turn = 6.28 * uniform_double(&random), thin = uniform_double(&random);
        const double c = size * cos(turn), s = size * sin(turn);
        const double expected = u * 256 - 0.5 + 3 * ((1 - v) * 256 - 0.5);
        assert_true(fabs(at(&m, u, v, c, s, -thin * s, thin * c) - expected) < 1e-3);
    }
    mu_mipmap_free(&m);
}

static float stripes(int x, int y) {
    (void)y;
    return (float)(x / 8 % 2);
}

/* Stripes 8 texels wide stay where the parallelogram is long along them, whatever its corner, and go where it lies across. */
static void test_long_footprints(void **state) {
    (void)state;
    mu_mipmap m = make(256, 256, MU_WRAP_REPEAT, stripes);
    const double u = 12.0 / 256, t = 0.5 / 256, l = 16.0 / 256; /* the middle of a bright one */
    assert_true(at(&m, u, 0.3, t, 0, 0, l) == 1);
    assert_true(at(&m, u, 0.3, t, l, t, -l) == 1);
    assert_true(fabs(at(&m, u, 0.3, l, 0, 0, t) - 0.5) < 0.1);
    assert_true(fabs(at(&m, u, 0.3, l, 0, 0, l) - 0.5) < 0.1);
    mu_mipmap_free(&m);
}

static void test_wraps(void **state) {
    (void)state;
    mu_mipmap repeat = make(16, 8, MU_WRAP_REPEAT, noise), clamp = make(16, 8, MU_WRAP_CLAMP, noise),
              mirror = make(16, 8, MU_WRAP_MIRROR, noise);
    uniform random = {3};
    for (int i = 0; i < 500; i++) {
        const double u = floor(64 * uniform_double(&random)) / 64,
                     v = floor(64 * uniform_double(&random)) / 64; /* exact when moved */
        assert_true(at(&repeat, u, v, 0, 0, 0, 0) == at(&repeat, u + 3, v - 2, 0, 0, 0, 0));
        assert_true(at(&mirror, u, v, 0, 0, 0, 0) == at(&mirror, 2 - u, -v, 0, 0, 0, 0));
        assert_true(at(&clamp, 0, v, 0, 0, 0, 0) == at(&clamp, -u, v, 0, 0, 0, 0));
        assert_true(at(&clamp, 1, v, 0, 0, 0, 0) == at(&clamp, 1 + u, v, 0, 0, 0, 0));
    }
    assert_true(at(&repeat, 0.5 / 16, 1 - 0.5 / 8, 0, 0, 0, 0) ==
                (double)noise(0, 0)); /* the first texel is top left */
    mu_mipmap_free(&repeat), mu_mipmap_free(&clamp), mu_mipmap_free(&mirror);
}

/* ------------------------------------------------------------------------------------------- covariance */

static void random_map(uniform *random, double m[4]) {
    do {
        for (int i = 0; i < 4; i++) m[i] = 4 * uniform_double(random) - 2;
    } while (fabs(m[0] * m[3] - m[1] * m[2]) < 0.1);
}

/* M M^T S = 1, to some roundings times the condition, here below 200; and M back, to the bit. */
static void test_covariance_and_back(void **state) {
    (void)state;
    uniform random = {4};
    for (int i = 0; i < 1000; i++) {
        double m[4], s[3], back[4];
        random_map(&random, m);
        mu_covariance_of(m, s);
        const double xx = m[0] * m[0] + m[1] * m[1], xy = m[0] * m[2] + m[1] * m[3],
                     yy = m[2] * m[2] + m[3] * m[3];
        assert_true(fabs(xx * s[0] + xy * s[1] - 1) < 1e-11 && fabs(xx * s[1] + xy * s[2]) < 1e-11);
        assert_true(fabs(xy * s[1] + yy * s[2] - 1) < 1e-11);
        mu_covariance_map(s, m, back);
        assert_memory_equal(m, back, sizeof m);
        /* another covariance, turned as m is: of M = H Q the part Q stays */
        const double wide[3] = {2 * s[0], 2 * s[1], 2 * s[2]};
        mu_covariance_map(wide, m, back);
        for (int k = 0; k < 4; k++) assert_true(fabs(back[k] - m[k] / sqrt(2)) < 1e-9);
    }
}

/* Of a mean that tells another width, S does; of a mirror, which side. */
static void test_the_mean_only_turns(void **state) {
    (void)state;
    const double s[3] = {4, 0, 1},
                 means[][4] = {{9, 0, 0, 9}, {0.1, 0, 0, 3}, {1, 0, 0, -1}, {0, -1, 1, 0}, {0, 0, 0, 0}};
    const double expected[][4] = {
        {0.5, 0, 0, 1}, {0.5, 0, 0, 1}, {0.5, 0, 0, -1}, {0, -0.5, 1, 0}, {0.5, 0, 0, 1}};
    for (int k = 0; k < 5; k++) {
        double m[4];
        mu_covariance_map(s, means[k], m);
        for (int i = 0; i < 4; i++) assert_true(fabs(m[i] - expected[k][i]) < 1e-15);
    }
}

/* Two roughnesses: the relative variance of alpha^2. Two directions across one another: S is their mean, (p + q) / 2 in
 * both, and E tr((S^-1 s)^2) / 2 - 1 = 2 (p^2 + q^2) / (p + q)^2 - 1. */
static void test_spread(void **state) {
    (void)state;
    const double pairs[2][2][3] = {{{0.01, 0, 0.01}, {0.16, 0, 0.16}}, {{0.01, 0, 0.16}, {0.16, 0, 0.01}}};
    const double expected[2] = {pow(0.075 / 0.085, 2), 2 * (0.0001 + 0.0256) / pow(0.17, 2) - 1};
    for (int k = 0; k < 2; k++) {
        mu_mipmap m;
        assert_true(mu_mipmap_make(&m, 2, 1, 8, MU_WRAP_REPEAT));
        for (int i = 0; i < 16; i++) m.texels[i] = 0;
        for (int i = 0; i < 2; i++)
            for (int c = 0; c < 3; c++) m.texels[8 * i + 4 + c] = (float)pairs[k][i][c];
        mu_mipmap_build(&m);
        assert_true(mu_covariance_spread(&m));
        assert_true(m.texels[7] < 1e-6f && m.texels[15] < 1e-6f);
        assert_true(fabs((double)m.texels[23] - expected[k]) < 1e-6);
        /* and that is what keeps it from being averaged */
        double out[MU_MIPMAP_CHANNELS];
        const double uv[2] = {0.25, 0.5}, axes[4] = {1, 0, 0, 2};
        mu_mipmap_at(&m, uv, axes, &(mu_mipmap_limit){7, expected[k] + 0.01}, out);
        assert_true(fabs(out[4] - 0.085) < 1e-7);
        mu_mipmap_at(&m, uv, axes, &(mu_mipmap_limit){7, expected[k] - 0.01}, out);
        assert_true(fabs(out[4] - 0.01) < 1e-7);
        mu_mipmap_free(&m);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_equal_texels_are_their_value),
        cmocka_unit_test(test_the_coarsest_level_is_the_mean),
        cmocka_unit_test(test_ramps_stay),
        cmocka_unit_test(test_long_footprints),
        cmocka_unit_test(test_wraps),
        cmocka_unit_test(test_covariance_and_back),
        cmocka_unit_test(test_the_mean_only_turns),
        cmocka_unit_test(test_spread),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
