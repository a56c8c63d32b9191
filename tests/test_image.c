/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* test_image.c: EXR and PNG files of films, read back with OpenEXR's and libpng's own readers. */
#include <float.h>
#include <math.h>
#include <openexr.h>
#include <png.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/render/exr_write.h"
#include "core/render/image.h"
#include "core/render/image_read.h"
#include "core/render/integrator.h"
#include "tests/film_fixture.h"
#include "tests/uniform.h"

static const mu_image_info info = {
    .scene_file = "plates.json",
    .scene_text = "{\n  \"camera\": \"\xc2\xb5-surf\"\n}\n",
    .command = "musurf render plates.json -o plates.exr",
    .version = "0.1.0",
    .seed = UINT64_MAX,
    .samples = 3,
    .seconds = 12.5,
    .camera = {.kind = MU_PERSPECTIVE,
               .position = {1, 2, 3},
               .right = {1, 0, 0},
               .up = {0, 0, 1},
               .forward = {0, 1, 0},
               .half_height = 1},
};

typedef struct mu_picture {
    int32_t width, height;
    float *planes[16]; /* as float, whatever the file has */
    uint32_t *samples;
    const exr_attr_chlist_t *channels;
} mu_picture;

static void quiet(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code;
    print_message("OpenEXR: %s\n", message);
}

/* By OpenEXR's own reader, all channels in the file's order. */
static exr_context_t read_exr(const char *file, mu_picture *out) {
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.error_handler_fn = quiet;
    start.flags = EXR_CONTEXT_FLAG_STRICT_HEADER;
    exr_context_t exr;
    assert_int_equal(exr_start_read(&exr, file, &start), EXR_ERR_SUCCESS);
    exr_attr_box2i_t window, display;
    assert_int_equal(exr_get_data_window(exr, 0, &window), EXR_ERR_SUCCESS);
    assert_int_equal(exr_get_display_window(exr, 0, &display), EXR_ERR_SUCCESS);
    assert_memory_equal(&window, &display, sizeof window);
    assert_true(window.min.x == 0 && window.min.y == 0);
    out->width = window.max.x + 1;
    out->height = window.max.y + 1;
    assert_int_equal(exr_get_channels(exr, 0, &out->channels), EXR_ERR_SUCCESS);
    const size_t pixels = (size_t)out->width * (size_t)out->height;
    for (int c = 0; c < out->channels->num_channels; ++c) out->planes[c] = calloc(pixels, 4);
    int32_t lines;
    assert_int_equal(exr_get_scanlines_per_chunk(exr, 0, &lines), EXR_ERR_SUCCESS);
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    for (int y = 0; y < out->height; y += lines) {
        exr_chunk_info_t chunk;
        assert_int_equal(exr_read_scanline_chunk_info(exr, 0, y, &chunk), EXR_ERR_SUCCESS);
        if (y)
            exr_decoding_update(exr, 0, &chunk, &pipe);
        else
            exr_decoding_initialize(exr, 0, &chunk, &pipe);
        for (int c = 0; c < pipe.channel_count; ++c) {
            pipe.channels[c].decode_to_ptr = (uint8_t *)(out->planes[c] + (size_t)y * (size_t)out->width);
            pipe.channels[c].user_pixel_stride = 4;
            pipe.channels[c].user_line_stride = 4 * out->width;
            pipe.channels[c].user_bytes_per_element = 4;
            if (pipe.channels[c].data_type != EXR_PIXEL_UINT)
                pipe.channels[c].user_data_type = EXR_PIXEL_FLOAT;
        }
        if (!y) assert_int_equal(exr_decoding_choose_default_routines(exr, 0, &pipe), EXR_ERR_SUCCESS);
        assert_int_equal(exr_decoding_run(exr, 0, &pipe), EXR_ERR_SUCCESS);
    }
    exr_decoding_destroy(exr, &pipe);
    return exr;
}

static void free_picture(mu_picture *image) {
    for (int c = 0; c < 16; ++c) free(image->planes[c]);
}

/* Round to the nearest half, ties to even, as the C compiler does it. */
static float to_half(float x) {
    return (float)(_Float16)x;
}

static void exr_round_trip(_Bool half) {
    mu_error error = {.text = ""};
    mu_film film = noise_film(53, 37, 3); /* three blocks of 16 lines, the last one short */
    const mu_film_settings settings = {.width = 53, .height = 37, .half = half};
    const char *file = in_folder(half ? "half.exr" : "float.exr");
    assert_true(mu_image_write_exr(file, &film, &settings, &info, &error));
    mu_picture image = {.width = 0};
    exr_context_t exr = read_exr(file, &image);
    assert_true(image.width == 53 && image.height == 37);

    static const char *const names[] = {"A",        "B",        "G",        "R",
                                        "albedo.B", "albedo.G", "albedo.R", "normal.X",
                                        "normal.Y", "normal.Z", "samples",  "variance"};
    assert_int_equal(image.channels->num_channels, 12);
    for (int c = 0; c < 12; ++c) {
        assert_string_equal(image.channels->entries[c].name.str, names[c]);
        const int kind = c == 10 ? EXR_PIXEL_UINT : c == 11 || !half ? EXR_PIXEL_FLOAT : EXR_PIXEL_HALF;
        assert_int_equal(image.channels->entries[c].pixel_type, kind);
    }
    for (size_t i = 0; i < 53 * 37; ++i) {
        const mu_pixel *pixel = &film.pixels[i];
        double rgb[3];
        mu_pixel_rgb(pixel, rgb);
        const float expected[12] = {(float)(pixel->hits / 3.0),
                                    (float)rgb[2],
                                    (float)rgb[1],
                                    (float)rgb[0],
                                    pixel->albedo[2],
                                    pixel->albedo[1],
                                    pixel->albedo[0],
                                    pixel->normal[0],
                                    pixel->normal[1],
                                    pixel->normal[2],
                                    0,
                                    (float)mu_pixel_variance(pixel)};
        for (int c = 0; c < 12; ++c) {
            const float wanted = half && c < 10 ? to_half(expected[c]) : expected[c];
            if (c == 10) {
                uint32_t samples;
                memcpy(&samples, &image.planes[c][i], 4);
                assert_int_equal(samples, 3);
            } else if (!(image.planes[c][i] == wanted)) {
                fail_msg("%s of pixel %zu: %.9g instead of %.9g", names[c], i, (double)image.planes[c][i],
                         (double)wanted);
            }
        }
    }

    const char *const texts[][2] = {{"scene", info.scene_text},         {"sceneFile", "plates.json"},
                                    {"command", info.command},          {"software", "musurf 0.1.0"},
                                    {"softwareVersion", "0.1.0"},       {"seed", "18446744073709551615"},
                                    {"cameraProjection", "perspective"}};
    for (size_t t = 0; t < sizeof texts / sizeof *texts; ++t) {
        const char *text = NULL;
        int32_t length = 0;
        assert_int_equal(exr_attr_get_string(exr, 0, texts[t][0], &length, &text), EXR_ERR_SUCCESS);
        assert_int_equal(length, strlen(texts[t][1]));
        assert_memory_equal(text, texts[t][1], (size_t)length);
    }
    int32_t samples;
    double seconds;
    float fov;
    exr_attr_v3f_t forward;
    assert_int_equal(exr_attr_get_int(exr, 0, "samples", &samples), EXR_ERR_SUCCESS);
    assert_int_equal(exr_attr_get_double(exr, 0, "seconds", &seconds), EXR_ERR_SUCCESS);
    assert_int_equal(exr_attr_get_float(exr, 0, "cameraFovVertical", &fov), EXR_ERR_SUCCESS);
    assert_int_equal(exr_attr_get_v3f(exr, 0, "cameraForward", &forward), EXR_ERR_SUCCESS);
    assert_int_equal(samples, 3);
    assert_true(seconds == 12.5 && fov == 90); /* half height 1 is tan 45 degrees */
    assert_true(forward.x == 0 && forward.y == 1 && forward.z == 0);
    exr_compression_t compression;
    assert_int_equal(exr_get_compression(exr, 0, &compression), EXR_ERR_SUCCESS);
    assert_int_equal(compression, EXR_COMPRESSION_ZIP);
    exr_finish(&exr);
    free_picture(&image);
    mu_film_free(&film);
}

static void exr_float(void **state) {
    (void)state;
    exr_round_trip(0);
}
static void exr_half(void **state) {
    (void)state;
    exr_round_trip(1);
}

enum { NOISE_WIDTH = 64, NOISE_BLOCKS = 2000, NOISE_LINES = 16 * NOISE_BLOCKS };

static exr_result_t no_head(exr_context_t exr, const void *context) {
    (void)exr, (void)context;
    return EXR_ERR_SUCCESS;
}

static void fill_noise(void *context, uint32_t y, uint32_t lines, size_t stride, mu_exr_element *out) {
    (void)stride;
    memcpy(out, (const uint32_t *)context + (size_t)y * NOISE_WIDTH,
           (size_t)lines * NOISE_WIDTH * sizeof *out);
}

/*
 * Blocks of random bits that zeros make a little shorter compressed, or not, or just as long: 1024 floats of which
 * 0 to 39 are 0. Of the two thousand some dozens are just as long; the library would write those as no one reads them.
 */
static void exr_incompressible(void **state) {
    (void)state;
    uniform random = {20};
    mu_error error = {.text = ""};
    uint32_t *bits = calloc((size_t)NOISE_LINES * NOISE_WIDTH, sizeof *bits);
    for (size_t k = 0; k < (size_t)NOISE_LINES * NOISE_WIDTH; ++k) bits[k] = (uint32_t)uniform_bits(&random);
    for (size_t block = 0; block < NOISE_BLOCKS; ++block)
        memset(bits + block * 16 * NOISE_WIDTH, 0, block % 40 * sizeof *bits);
    const mu_exr_channel channel = {"Y", EXR_PIXEL_FLOAT};
    const mu_exr_image image = {.part = "noise",
                                .width = NOISE_WIDTH,
                                .height = NOISE_LINES,
                                .treatment = EXR_PERCEPTUALLY_LINEAR,
                                .channels = &channel,
                                .channel_count = 1,
                                .head = no_head,
                                .fill = fill_noise,
                                .context = bits};
    int width, height;
    assert_true(mu_exr_write(in_folder("noise.exr"), &image, &error));
    float *read = mu_image_read_plane(in_folder("noise.exr"), NULL, &width, &height, &error);
    assert_true(read && width == NOISE_WIDTH && height == NOISE_LINES);
    assert_memory_equal(read, bits, (size_t)NOISE_LINES * NOISE_WIDTH * sizeof *bits);
    free(read);
    free(bits);
}

/* Values beyond what the channel can hold become its largest number, never infinity; unsampled pixels are
 * black. */
static void exr_extremes(void **state) {
    (void)state;
    mu_error error = {.text = ""};
    for (int half = 0; half < 2; ++half) {
        mu_film film;
        assert_true(mu_film_make(&film, 2, 1, &error));
        for (int i = 0; i < 2; ++i)
            mu_pixel_add(&film.pixels[0], &(mu_radiance){.rgb = {FLT_MAX, i ? 0 : FLT_MAX, 70000}});
        const mu_film_settings settings = {.width = 2, .height = 1, .half = half};
        assert_true(mu_image_write_exr(in_folder("big.exr"), &film, &settings, &info, &error));
        mu_picture image = {.width = 0};
        exr_context_t exr = read_exr(in_folder("big.exr"), &image);
        assert_true(image.planes[3][0] == (half ? 65504 : FLT_MAX));
        assert_true(image.planes[1][0] == (half ? 65504 : 70000));
        assert_true(isfinite(image.planes[11][0]));
        for (int c = 0; c < 12; ++c) assert_true(image.planes[c][1] == 0);
        exr_finish(&exr);
        free_picture(&image);
        mu_film_free(&film);
    }
}

static void tone_curve(void **state) {
    (void)state;
    double last = -1;
    for (int i = 0; i <= 50000; ++i) { /* to 5: 1 - y = 0.2 e^-21 is still far above rounding */
        const double x = i * 1e-4, y = mu_tone_curve(x);
        assert_true(y > last && y < 1);
        if (x <= 0.8) assert_true(y == x);
        last = y;
    }
    const double h = 1e-6; /* the same slope on both sides of the knee: 1 within h/(2 0.2) */
    assert_true(fabs((mu_tone_curve(0.8 + h) - mu_tone_curve(0.8)) / h - 1) < 5 * h);
    assert_true(mu_tone_curve(HUGE_VAL) == 1 && mu_tone_curve(-1) == 0 && mu_tone_curve((double)NAN) == 0);
    /* IEC 61966-2-1: code 188 is linear 0.5 (0.735357 x 255 = 187.5), code 10 lies near the linear foot. */
    assert_int_equal(mu_tone_srgb8(0), 0);
    assert_int_equal(mu_tone_srgb8(1), 255);
    assert_int_equal(mu_tone_srgb8(0.5), 188);
    assert_int_equal(mu_tone_srgb8(0.18), 118);
    assert_int_equal(mu_tone_srgb8(0.003), 10);
    for (int code = 0; code < 256; ++code) { /* the standard's inverse returns every code */
        const double s = code / 255.0, linear = s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
        assert_int_equal(mu_tone_srgb8(linear), code);
    }
}

static void png_holds_the_curve(void **state) {
    (void)state;
    mu_error error = {.text = ""};
    mu_film film;
    const uint32_t width = 512;
    assert_true(mu_film_make(&film, width, 2, &error));
    for (uint32_t i = 0; i < 2 * width; ++i) {
        const float v = (float)(i % width) / 128; /* 0 ... 4 */
        mu_pixel_add(&film.pixels[i], &(mu_radiance){.rgb = {v, v / 2, 0}});
    }
    const mu_film_settings settings = {.width = width, .height = 2, .exposure = -1};
    assert_true(mu_image_write_png(in_folder("a.png"), &film, &settings, &info, &error));
    png_image png = {.version = PNG_IMAGE_VERSION};
    assert_true(png_image_begin_read_from_file(&png, in_folder("a.png")));
    assert_true(png.width == width && png.height == 2 && png.format == PNG_FORMAT_RGB);
    unsigned char *pixels = malloc(PNG_IMAGE_SIZE(png));
    assert_true(png_image_finish_read(&png, NULL, pixels, 0, NULL));
    for (uint32_t i = 0; i < 2 * width; ++i) {
        const double v = (i % width) / 128.0 / 2; /* exposure -1: half */
        assert_int_equal(pixels[3 * i], mu_tone_srgb8(mu_tone_curve(v)));
        assert_int_equal(pixels[3 * i + 1], mu_tone_srgb8(mu_tone_curve(v / 2)));
        assert_int_equal(pixels[3 * i + 2], 0);
    }
    free(pixels);
    mu_film_free(&film);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exr_float),    cmocka_unit_test(exr_half),
        cmocka_unit_test(exr_extremes), cmocka_unit_test(exr_incompressible),
        cmocka_unit_test(tone_curve),   cmocka_unit_test(png_holds_the_curve),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
