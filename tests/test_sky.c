/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_sky.c: directions drawn from environment images and from the studio follow their pdf (chi^2), which
 * integrates to 1, is positive wherever there is light, and is what an escaping ray is told. Random
 * comparisons: 3.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <cmocka.h>

#include "core/render/light_parts.h"
#include "tests/significance.h"
#include "tests/uniform.h"

#define PI                       3.14159265358979323846
#define assert_near(a, b, bound) assert_true(fabs((double)(a) - (double)(b)) <= (double)(bound))

/* Dim noise, black patches, one sun 10^7 times brighter, as hostile as photographs get. */
static float *hostile_pixels(int width, int height, uint64_t seed) {
    uniform random = {seed};
    float *pixels = calloc((size_t)(width * height) * 3, sizeof *pixels);
    for (int i = 0; i < width * height; i++)
        for (int c = 0; c < 3 && i % 7 > 2; c++) pixels[3 * i + c] = uniform_float(&random);
    for (int c = 0; c < 3; c++) pixels[3 * (width * (height / 3) + width / 5) + c] = 1e7f;
    return pixels;
}

/* A mild one, in which chi^2 sees every cell. */
static float *mild_pixels(int width, int height, uint64_t seed) {
    uniform random = {seed};
    float *pixels = calloc((size_t)(width * height) * 3, sizeof *pixels);
    for (int i = 0; i < width * height * 3; i++) pixels[i] = 0.2f + 3 * uniform_float(&random);
    return pixels;
}

static mu_sky sky_from(float *pixels, int width, int height, float rotation) {
    const mu_light light = {.kind = MU_ENVIRONMENT, .rotation = rotation, .scale = {1, 2, 0.5f}};
    mu_sky sky;
    mu_error error = {.text = ""};
    assert_true(mu_sky_make_from_pixels(&sky, &light, pixels, width, height, &error));
    return sky;
}

static mu_sky studio(float rotation) {
    const mu_light light = {.kind = MU_STUDIO, .rotation = rotation, .scale = {1, 1, 1}};
    mu_sky sky;
    mu_error error = {.text = ""};
    assert_true(mu_sky_make_studio(&sky, &light, &error));
    return sky;
}

/* Solid angle of a row's cell, from the definition. */
static double cell_solid_angle(uint32_t row, uint32_t width, uint32_t height) {
    return 2 * PI / width * (cos(PI * row / height) - cos(PI * (row + 1) / height));
}

/* The density is constant in each cell, so the sum is the integral; each pdf is rounded five times or so. */
static void integrates_to_one(mu_sky *sky) {
    double sum = 0;
    const mu_sphere_table *table = &sky->table;
    for (uint32_t row = 0; row < table->height; row++)
        for (uint32_t column = 0; column < table->width; column++) {
            const float u = ((float)column + 0.5f) / (float)table->width;
            const float v = ((float)row + 0.5f) / (float)table->height;
            sum +=
                (double)mu_sphere_table_pdf(table, u, v) * cell_solid_angle(row, table->width, table->height);
        }
    assert_near(sum, 1, 1e-6);
    mu_sky_free(sky);
}

static void test_skies_integrate_to_one(void **state) {
    (void)state;
    mu_sky skies[] = {
        sky_from(hostile_pixels(33, 17, 1), 33, 17, 0), sky_from(hostile_pixels(256, 128, 2), 256, 128, 1),
        sky_from(mild_pixels(1, 1, 3), 1, 1, 0), sky_from(mild_pixels(2, 1, 3), 2, 1, 0), studio(2)};
    for (size_t i = 0; i < sizeof skies / sizeof skies[0]; i++) integrates_to_one(&skies[i]);
}

static void test_density_is_positive_where_radiance_is(void **state) {
    (void)state;
    mu_sky skies[] = {sky_from(hostile_pixels(64, 32, 4), 64, 32, 0.7f), studio(0.3f)};
    uniform random = {5};
    for (int i = 0; i < 200000; i++) {
        const double z = 2 * uniform_double(&random) - 1, phi = 2 * PI * uniform_double(&random),
                     r = sqrt(1 - z * z);
        const mu_vec3 w = mu_v3((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
        for (int k = 0; k < 2; k++) {
            float radiance[3], pdf;
            mu_sky_escaped(&skies[k], w, radiance, &pdf);
            if (radiance[0] + radiance[1] + radiance[2] > 0) assert_true(pdf > 0);
        }
    }
    for (int k = 0; k < 2; k++) mu_sky_free(&skies[k]);
}

/* Drawn directions, binned by double arithmetic of our own in blocks of `step` x `step` cells, each halved
 * along u and along cos theta, against the density times the solid angle. */
static void follows_density(mu_sky *sky, float rotation, uint32_t step, uint64_t seed) {
    enum { DRAWS = 1000000 };
    const uint32_t width = sky->table.width, height = sky->table.height;
    const uint32_t across = 2 * width / step, down = 2 * height / step;
    double *expected = calloc((size_t)across * down, sizeof *expected),
           *seen = calloc((size_t)across * down, sizeof *seen);
    for (uint32_t row = 0; row < height; row++)
        for (uint32_t column = 0; column < width; column++) {
            const double theta = PI * (row + 0.5) / height,
                         phi = PI * (1 - 2 * (column + 0.5) / width) + (double)rotation;
            const mu_vec3 w =
                mu_v3((float)(sin(theta) * cos(phi)), (float)(sin(theta) * sin(phi)), (float)cos(theta));
            float radiance[3], pdf;
            mu_sky_escaped(sky, w, radiance, &pdf);
            const double share = (double)pdf * cell_solid_angle(row, width, height) * DRAWS;
            for (uint32_t half = 0; half < (step == 1 ? 4 : 1); half++) {
                const uint32_t i = step == 1 ? 2 * column + half % 2 : column * 2 / step;
                const uint32_t j = step == 1 ? 2 * row + half / 2 : row * 2 / step;
                expected[j * across + i] += step == 1 ? share / 4 : share;
            }
        }
    uniform random = {seed};
    for (int n = 0; n < DRAWS; n++) {
        const float u[2] = {uniform_float(&random), uniform_float(&random)};
        mu_vec3 w;
        float radiance[3], pdf;
        mu_sky_sample(sky, u, &w, radiance, &pdf);
        assert_near(mu_length(w), 1, 1e-5);
        const double phi = atan2((double)w.y, (double)w.x) - (double)rotation;
        double place = 0.5 - phi / (2 * PI);
        place -= floor(place);
        const double theta = atan2(hypot((double)w.x, (double)w.y), (double)w.z);
        const uint32_t row = (uint32_t)fmin(theta / PI * height, height - 1.0);
        const double top = cos(PI * row / height), bottom = cos(PI * (row + 1) / height);
        const uint32_t half = (top - (double)w.z) / (top - bottom) >= 0.5;
        const uint32_t i = (uint32_t)fmin(place * across, across - 1.0);
        seen[(step == 1 ? 2 * row + half : row * 2 / step) * across + i]++;
    }
    double chi2 = 0, freedom = -1;
    for (size_t k = 0; k < (size_t)across * down; k++) {
        assert_true(expected[k] >= 5);
        chi2 += (seen[k] - expected[k]) * (seen[k] - expected[k]) / expected[k];
        freedom++;
    }
    const double p = p_of_chi2(chi2, freedom);
    print_message("sky %u x %u: chi^2 %.1f of %.0f, p = %.3g\n", width, height, chi2, freedom, p);
    assert_true(p > significance_level());
    free(expected);
    free(seen);
    mu_sky_free(sky);
}

static void test_skies_follow_their_density(void **state) {
    (void)state;
    mu_sky even = sky_from(mild_pixels(16, 8, 6), 16, 8, 0.9f),
           odd = sky_from(mild_pixels(9, 5, 7), 9, 5, -2.f);
    mu_sky room = studio(1.1f);
    follows_density(&even, 0.9f, 1, 61);
    follows_density(&odd, -2.f, 1, 62);
    follows_density(&room, 1.1f, 16, 63);
}

/* What sampling says about a direction is what a ray that escapes along it is told, but for directions within
 * rounding of a cell's edge, where the neighbour may answer. */
static void test_sky_sample_and_lookup_agree(void **state) {
    (void)state;
    mu_sky skies[] = {sky_from(mild_pixels(64, 32, 8), 64, 32, 0.4f), studio(0.4f)};
    uniform random = {81};
    for (int k = 0; k < 2; k++) {
        int compared = 0;
        for (int n = 0; n < 100000; n++) {
            const float u[2] = {uniform_float(&random), uniform_float(&random)};
            mu_vec3 w;
            float radiance[3], pdf, again[3], pdf_again, x, y;
            mu_sky_sample(&skies[k], u, &w, radiance, &pdf);
            mu_sky_escaped(&skies[k], w, again, &pdf_again);
            /* Directions are exact to some 4e-7; radiance changes by at most 64/2 * 3.2 * 2 per unit of u
             * (mild). */
            for (int c = 0; c < 3; c++) assert_near(radiance[c], again[c], 4e-4);
            const float back = 0.4f;
            const mu_vec3 own =
                mu_v3(cosf(back) * w.x + sinf(back) * w.y, cosf(back) * w.y - sinf(back) * w.x, w.z);
            mu_sphere_table_locate(own, &x, &y);
            x = x * (float)skies[k].table.width - floorf(x * (float)skies[k].table.width);
            y = y * (float)skies[k].table.height - floorf(y * (float)skies[k].table.height);
            if (fabsf(x - 0.5f) > 0.499f || fabsf(y - 0.5f) > 0.499f) continue;
            assert_true(pdf == pdf_again);
            compared++;
        }
        assert_true(compared > 95000);
        mu_sky_free(&skies[k]);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_skies_integrate_to_one),
        cmocka_unit_test(test_density_is_positive_where_radiance_is),
        cmocka_unit_test(test_skies_follow_their_density),
        cmocka_unit_test(test_sky_sample_and_lookup_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
