/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_environment.c: environment images end up the right way round, broken pixels are clamped, and broken
 * files are refused with one line. The images are written here byte by byte (Radiance and TIFF), not by our
 * code or OpenImageIO.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>

#include "core/render/image_read.h"
#include "core/render/light_parts.h"

static char folder[] = "/tmp/musurf_environment_XXXXXX";

static const char *path(const char *name) {
    static char buffer[256];
    snprintf(buffer, sizeof buffer, "%s/%s", folder, name);
    return buffer;
}

static const char *write_file(const char *name, const void *bytes, size_t count) {
    FILE *file = fopen(path(name), "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, count, file), count);
    assert_int_equal(fclose(file), 0);
    return path(name);
}

/* Uncompressed little-endian TIFF of 32-bit float RGB. */
static const char *write_tiff(const char *name, const float *pixels, uint32_t width, uint32_t height,
                              size_t cut) {
    enum { ENTRIES = 11 };
    static unsigned char bytes[65536];
    const uint32_t data = width * height * 12, directory = 8 + data, extra = directory + 2 + ENTRIES * 12 + 4;
    const uint32_t head[2] = {0x002a4949, directory};
    memset(bytes, 0, sizeof bytes);
    memcpy(bytes, head, 8);
    memcpy(bytes + 8, pixels, data);
    const uint32_t entry[ENTRIES][4] = {/* tag, type, count, value */
                                        {256, 4, 1, width}, {257, 4, 1, height},   {258, 3, 3, extra},
                                        {259, 3, 1, 1},     {262, 3, 1, 2},        {273, 4, 1, 8},
                                        {277, 3, 1, 3},     {278, 4, 1, height},   {279, 4, 1, data},
                                        {284, 3, 1, 1},     {339, 3, 3, extra + 6}};
    bytes[directory] = ENTRIES;
    for (int i = 0; i < ENTRIES; i++) {
        const uint32_t words[3] = {entry[i][0] | entry[i][1] << 16, entry[i][2], entry[i][3]};
        memcpy(bytes + directory + 2 + 12 * i, words, 12);
    }
    const uint16_t samples[6] = {32, 32, 32, 3, 3, 3}; /* bits, and the format: IEEE float */
    memcpy(bytes + extra, samples, 12);
    return write_file(name, bytes, cut ? cut : extra + 12);
}

/* Radiance's flat pixels: mantissas and a shared exponent; 128 with exponent 129 is 1. */
static const char *write_radiance(const char *name, const unsigned char (*pixels)[4], int width, int height) {
    unsigned char bytes[1024];
    const int head = snprintf((char *)bytes, sizeof bytes,
                              "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n", height, width);
    memcpy(bytes + head, pixels, (size_t)(width * height) * 4);
    return write_file(name, bytes, (size_t)head + (size_t)(width * height) * 4);
}

static mu_sky environment(const char *file, float rotation) {
    char name[256];
    snprintf(name, sizeof name, "%s", file);
    const mu_light light = {.kind = MU_ENVIRONMENT, .image = name, .rotation = rotation, .scale = {1, 1, 1}};
    mu_sky sky;
    mu_error error = {.text = ""};
    if (!mu_sky_make_environment(&sky, &light, &error)) fail_msg("%s", error.text);
    return sky;
}

/* Four columns by two rows: red, green, blue, white above; black below. The centres of the columns lie at
 * phi = 135, 45, -45 and -135 degrees, 45 degrees up. */
static void test_orientation(void **state) {
    (void)state;
    const unsigned char pixels[8][4] = {
        {128, 0, 0, 129}, {0, 128, 0, 129}, {0, 0, 128, 129}, {128, 128, 128, 129}};
    const float expected[4][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}};
    const char *file = write_radiance("four.hdr", pixels, 4, 2);
    for (int turn = 0; turn < 4; turn++) {
        mu_sky sky = environment(file, 1.57079633f * (float)turn);
        for (int column = 0; column < 4; column++) {
            const float phi = 0.78539816f * (float)(3 - 2 * column) + 1.57079633f * (float)turn;
            const mu_vec3 up = mu_v3(cosf(phi) * sqrtf(0.5f), sinf(phi) * sqrtf(0.5f), sqrtf(0.5f));
            float radiance[3], pdf;
            mu_sky_escaped(&sky, up, radiance, &pdf);
            /* Bilinear between centres: directions are off by some 1e-7 of pixels a quarter turn wide. */
            for (int c = 0; c < 3; c++) assert_true(fabsf(radiance[c] - expected[column][c]) < 1e-5f);
            mu_sky_escaped(&sky, mu_v3(up.x, up.y, -up.z), radiance, &pdf);
            for (int c = 0; c < 3; c++) assert_true(fabsf(radiance[c]) < 1e-5f);
        }
        mu_sky_free(&sky);
    }
}

static void test_broken_pixels_are_clamped(void **state) {
    (void)state;
    float pixels[24];
    for (int i = 0; i < 24; i++) pixels[i] = 0.5f;
    pixels[0] = NAN;
    pixels[4] = -3;
    pixels[8] = INFINITY;
    pixels[23] = 3e38f;
    mu_sky sky = environment(write_tiff("broken.tif", pixels, 4, 2, 0), 0);
    assert_true(sky.pixels[0] == 0 && sky.pixels[4] == 0 && sky.pixels[1] == 0.5f);
    assert_true(sky.pixels[8] == sky.pixels[23] && sky.pixels[8] > 1e11f && sky.pixels[8] < 1e13f);
    assert_true(isfinite(sky.fluence) && sky.fluence > 0);
    for (int i = 0; i < 1000; i++) {
        const float u[2] = {(float)i / 1000, (float)(i * 7 % 1000) / 1000};
        mu_vec3 w;
        float radiance[3] = {0, 0, 0}, pdf;
        mu_sky_sample(&sky, u, &w, radiance, &pdf);
        assert_true(isfinite(pdf) && pdf > 0 && isfinite(radiance[0] + radiance[1] + radiance[2]));
    }
    mu_sky_free(&sky);
}

static void count_warnings(void *context, const char *text) {
    print_message("%s\n", text);
    ++*(int *)context;
}

/* A trace of a negative is no news; one that can be seen is, and so is NaN. */
static void test_what_is_clamped_is_told(void **state) {
    (void)state;
    static const float values[] = {0, -0.0004f, -0.4f, NAN, INFINITY};
    for (int i = 0; i < 5; i++) {
        int warnings = 0;
        float pixels[24];
        for (int k = 0; k < 24; k++) pixels[k] = 0.5f;
        pixels[7] = values[i];
        char file[512];
        snprintf(file, sizeof file, "%s", write_tiff("trace.tif", pixels, 4, 2, 0));
        const mu_light light = {.kind = MU_ENVIRONMENT, .image = file, .scale = {1, 1, 1}};
        mu_error error = {.warn = count_warnings, .context = &warnings};
        mu_sky sky;
        assert_true(mu_sky_make_environment(&sky, &light, &error));
        assert_true(i == 4 ? sky.pixels[7] > 1e11f : sky.pixels[7] == 0);
        assert_int_equal(warnings, i > 1);
        mu_sky_free(&sky);
    }
}

static void refuses(const char *file, const char *expected) {
    mu_error error = {.text = ""};
    int width, height;
    float *pixels = mu_image_read(file, &width, &height, &error);
    if (pixels) fail_msg("%s was read", file);
    print_message("%s\n", error.text);
    assert_non_null(strstr(error.text, expected));
    assert_null(strchr(error.text, '\n'));
}

static void test_broken_files_are_refused(void **state) {
    (void)state;
    float pixels[24] = {0};
    refuses(path("missing.exr"), "no such file");
    refuses(folder, "not a regular file");
    refuses(write_file("empty.exr", "", 0), "empty.exr");
    refuses(write_file("noise.exr", "v/1\x01 this is no OpenEXR file at all", 34), "noise.exr");
    refuses(write_file("words.hdr", "hello", 5), "words.hdr");
    refuses(write_tiff("cut.tif", pixels, 4, 2, 60), "cut.tif");
    const char huge[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 200000 +X 400000\n";
    refuses(write_file("huge.hdr", huge, sizeof huge - 1), "huge.hdr");
    const char truncated[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 64 +X 4\n12341234";
    refuses(write_file("short.hdr", truncated, sizeof truncated - 1), "truncated");
}

/* Without the module the message says where it was looked for; nothing else needs it. */
static void test_missing_module_is_named(void **state) {
    (void)state;
    char kept[4096];
    snprintf(kept, sizeof kept, "%s", getenv("MUSURF_PLUGIN_PATH"));
    setenv("MUSURF_PLUGIN_PATH", folder, 1);
    refuses("any.exr", "musurf_oiio.so");
    write_file("musurf_oiio.so", "not a library", 13);
    refuses("any.exr", "does not load");
    setenv("MUSURF_PLUGIN_PATH", kept, 1);
}

static int set_up(void **state) {
    (void)state;
    const char *build = getenv("BUILD");
    setenv("MUSURF_PLUGIN_PATH", build ? build : "build", 1);
    return mkdtemp(folder) ? 0 : -1;
}

static int tear_down(void **state) {
    (void)state;
    char command[300];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command) ? -1 : 0;
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_orientation),
        cmocka_unit_test(test_broken_pixels_are_clamped),
        cmocka_unit_test(test_what_is_clamped_is_told),
        cmocka_unit_test(test_broken_files_are_refused),
        cmocka_unit_test(test_missing_module_is_named),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
