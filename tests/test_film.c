/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* test_film.c: the sums of a film, its noise, and checkpoints, against closed forms and against damage. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "core/render/integrator.h"
#include "tests/film_fixture.h"

/* ---------------------------------------------------------------------------------------------------- sums
 */

/* Grey samples 1, 2, 3, 4, 5 have mean 3 and variance 2.5, so the variance of the mean is 1/2. */
static void pixel_statistics(void **state) {
    (void)state;
    mu_pixel pixel = {.samples = 0};
    for (int i = 1; i <= 5; ++i) {
        const float v = (float)i;
        const mu_radiance sample = {
            .rgb = {v, v, v}, .albedo = {v, 0, 1}, .normal = {0, -v, 0}, .hit = i > 2};
        assert_true(mu_pixel_add(&pixel, &sample));
    }
    double rgb[3];
    mu_pixel_rgb(&pixel, rgb);
    assert_true(rgb[0] == 3 && rgb[1] == 3 && rgb[2] == 3);
    /* The three weights of luminance add up to 1 within an ulp or so, squared and summed a few times. */
    assert_true(fabs(mu_pixel_variance(&pixel) - 0.5) < 20 * DBL_EPSILON);
    /* Means kept in float, five steps: half an ulp of 5 each. */
    assert_true(fabsf(pixel.albedo[0] - 3) < 10 * FLT_EPSILON && pixel.albedo[2] == 1 &&
                pixel.albedo[1] == 0);
    assert_true(fabsf(pixel.normal[1] + 3) < 10 * FLT_EPSILON);
    assert_int_equal(pixel.samples, 5);
    assert_int_equal(pixel.hits, 3);
}

/* Sixteen samples 0 ... 15 again and again, in any order within a block, always have the same mean: what is
 * left is nothing. Blocks whose sums are 1, 2, ... K have mean (K + 1) / 2 and variance K (K + 1) / 12, a
 * 16th of it per sample; three samples more belong to no full block. */
static void stratified_samples_are_not_independent(void **state) {
    (void)state;
    enum { K = 9 };
    mu_pixel even = {.samples = 0}, rising = {.samples = 0};
    for (int i = 0; i < K * MU_BLOCK + 3; ++i) {
        const float level = (float)(7 * i % MU_BLOCK),
                    step = i % MU_BLOCK == 5 ? (float)(1 + i / MU_BLOCK) : 0;
        mu_pixel_add(&even, &(mu_radiance){.rgb = {level, level, level}});
        mu_pixel_add(&rising, &(mu_radiance){.rgb = {step, step, step}});
        if (i + 1 == MU_BLOCK * MU_BLOCKS - 1) assert_true(mu_pixel_variance(&even) > 0.1);
    }
    /* Squares of 120 and sums of nine of them, rounded. */
    assert_true(mu_pixel_variance(&even) < 100 * DBL_EPSILON);
    const double expected = (K + 1) / 12.0 / (MU_BLOCK * MU_BLOCK);
    assert_true(fabs(mu_pixel_variance(&rising) - expected) < 100 * DBL_EPSILON * expected);
}

static void not_finite_counts_as_black(void **state) {
    (void)state;
    mu_pixel pixel = {.samples = 0};
    const mu_radiance good = {.rgb = {1, 1, 1}, .albedo = {1, 1, 1}, .hit = 1};
    mu_radiance bad[] = {good, good, good};
    bad[0].rgb[1] = NAN;
    bad[1].rgb[2] = INFINITY;
    bad[2].normal[0] = NAN;
    assert_true(mu_pixel_add(&pixel, &good));
    for (int i = 0; i < 3; ++i) assert_false(mu_pixel_add(&pixel, &bad[i]));
    double rgb[3];
    mu_pixel_rgb(&pixel, rgb);
    assert_true(rgb[0] == 0.25 && rgb[1] == 0.25 && rgb[2] == 0.25);
    /* Three steps in float, each rounded by half an ulp of 1/2 at most, twice. */
    assert_true(fabsf(pixel.albedo[0] - 0.25f) < 2 * FLT_EPSILON && pixel.normal[0] == 0);
    assert_true(isfinite(mu_pixel_variance(&pixel)));
}

/* Every pixel has n samples, half of them 0 and half 2: mean 1, standard error sqrt(1/(n - 1)); the noise
 * divides by 1 + 1e-3. */
static void noise_of_coin_tosses(void **state) {
    (void)state;
    mu_film film;
    mu_error error = {.text = ""};
    assert_true(mu_film_make(&film, 7, 5, &error));
    const uint32_t n = 64;
    for (uint32_t s = 0; s < n; ++s) {
        for (int i = 0; i < 35; ++i) {
            const float v = s % 2 ? 2.0f : 0.0f;
            mu_pixel_add(&film.pixels[i], &(mu_radiance){.rgb = {v, v, v}});
        }
        if (s == 0) assert_true(isinf(mu_film_noise(&film)));
    }
    const double expected = sqrt(1.0 / (n - 1)) / 1.001;
    assert_true(fabs(mu_film_noise(&film) / expected - 1) < 1e-12);
    mu_film_free(&film);
    assert_true(mu_film_make(&film, 3, 3, &error));
    for (int i = 0; i < 18; ++i) mu_pixel_add(&film.pixels[i % 9], &(mu_radiance){.hit = 0});
    assert_true(mu_film_noise(&film) == 0); /* black and sure of it */
    mu_film_free(&film);
}

static void absurd_sizes_are_refused(void **state) {
    (void)state;
    const uint32_t sizes[][2] = {
        {0, 1}, {1, 0}, {UINT32_MAX, 1}, {1, UINT32_MAX}, {INT32_MAX, INT32_MAX}, {2000000, 2000000}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; ++i) {
        mu_film film;
        mu_error error = {.text = ""};
        assert_false(mu_film_make(&film, sizes[i][0], sizes[i][1], &error));
        assert_true(error.text[0]);
        mu_film_free(&film);
    }
}

/* --------------------------------------------------------------------------------------------- checkpoints
 */

static void checkpoint_returns_every_bit(void **state) {
    (void)state;
    mu_error error = {.text = ""};
    const char *file = in_folder("a.resume");
    mu_film film = noise_film(301, 67, 3), again; /* more than one batch of 2^14 pixels, the last one short */
    film.refused = 5;
    assert_true(mu_film_save(&film, file, 42, &error));
    assert_true(mu_film_make(&again, 301, 67, &error));
    assert_true(mu_film_load(&again, file, 42, &error));
    assert_memory_equal(again.pixels, film.pixels, 301 * 67 * sizeof(mu_pixel));
    assert_true(again.seconds == film.seconds && again.rays == film.rays && again.refused == film.refused);
    mu_film_free(&film);
    mu_film_free(&again);
}

static void refused(const char *file, uint32_t width, uint32_t height, uint64_t key, const char *word) {
    mu_film film;
    mu_error error = {.text = ""};
    assert_true(mu_film_make(&film, width, height, &error));
    assert_false(mu_film_load(&film, file, key, &error));
    if (!strstr(error.text, word)) fail_msg("'%s' does not say '%s'", error.text, word);
    assert_null(strchr(error.text, '\n'));
    for (size_t i = 0; i < (size_t)width * height; ++i) /* nothing of it stays in the film */
        assert_true(film.pixels[i].samples == 0 && film.pixels[i].rgb[0] == 0);
    mu_film_free(&film);
}

static void patch(const char *from, const char *to, long at, size_t keep, unsigned char flip) {
    static unsigned char bytes[1 << 16];
    FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
    assert_non_null(in);
    assert_non_null(out);
    const size_t size = fread(bytes, 1, sizeof bytes, in);
    bytes[at] ^= flip;
    fwrite(bytes, 1, keep < size ? keep : size, out);
    fclose(in);
    assert_int_equal(fclose(out), 0);
}

static void bad_checkpoints_are_refused(void **state) {
    (void)state;
    mu_error error = {.text = ""};
    const char *good = in_folder("good.resume"), *bad = in_folder("bad.resume");
    mu_film film = noise_film(20, 10, 2);
    assert_true(mu_film_save(&film, good, 7, &error));
    refused(good, 20, 10, 8, "another scene");
    refused(good, 10, 20, 7, "20 x 10 pixels");
    refused(in_folder("none.resume"), 20, 10, 7, "No such file");
    refused("/", 20, 10, 7, "");
    const size_t size = 64 + 20 * 10 * 64 + 4;
    for (size_t keep = 0; keep < size; keep += keep < 70 ? 1 : 997) { /* cut off anywhere */
        patch(good, bad, 0, keep, 0);
        refused(bad, 20, 10, 7, keep < 64 ? "no checkpoint" : "damaged");
    }
    for (size_t at = 0; at < size; at += at < 70 ? 1 : 331) { /* a bit flipped anywhere */
        patch(good, bad, (long)at, SIZE_MAX, 0x10);
        refused(bad, 20, 10, 7, "");
    }
    /* Sums that only a forger writes: the checksum is right, the numbers are not. */
    film.pixels[3].rgb[1] = NAN;
    assert_true(mu_film_save(&film, bad, 7, &error));
    refused(bad, 20, 10, 7, "no render makes");
    film.pixels[3].rgb[1] = 1;
    film.pixels[4].hits = 99;
    assert_true(mu_film_save(&film, bad, 7, &error));
    refused(bad, 20, 10, 7, "no render makes");
    mu_film_free(&film);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixel_statistics),
        cmocka_unit_test(stratified_samples_are_not_independent),
        cmocka_unit_test(not_finite_counts_as_black),
        cmocka_unit_test(noise_of_coin_tosses),
        cmocka_unit_test(absurd_sizes_are_refused),
        cmocka_unit_test(checkpoint_returns_every_bit),
        cmocka_unit_test(bad_checkpoints_are_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
