/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * image_exr.c: the film as an OpenEXR image, by OpenEXR's C core: one scanline part, ZIP blocks of 16 lines.
 *
 * The library writes through mu_output, so that a full disk is an error with a reason and never a broken
 * image.
 */
#include <float.h>
#include <math.h>
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/image.h"
#include "core/render/exr_shrink.h"
#include "core/render/output.h"

/* Errors come back as codes; this only keeps the library from printing. It must not ask the context for its
 * user data: while writing, the context is locked. */
static void keep_quiet(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

static int64_t take(exr_const_context_t context, void *data, const void *bytes, uint64_t size,
                    uint64_t offset, exr_stream_error_func_ptr_t report) {
    (void)context, (void)report;
    return mu_output_write(data, bytes, size, offset) ? (int64_t)size : -1;
}

/* ------------------------------------------------------------------------------------------------ channels
 */

enum { CHANNELS = 12 };
static const char *const channel_names[CHANNELS] = {"R",        "G",        "B",        "A",
                                                    "albedo.R", "albedo.G", "albedo.B", "normal.X",
                                                    "normal.Y", "normal.Z", "variance", "samples"};
enum { VARIANCE = 10, SAMPLES = 11 };

typedef union mu_element { /* four bytes of a line: what the library's packing reads */
    float number;
    uint32_t count;
} mu_element;

#define HALF_MAX 65504.0

static float bounded(double value, _Bool half) {
    const double most = half ? HALF_MAX : (double)FLT_MAX;
    return (float)(value > most ? most : value < -most ? -most : value);
}

/* True if the pixel is too bright for its kind of number. */
static _Bool fill(mu_element *out, size_t stride, const mu_pixel *pixel, _Bool half) {
    double rgb[3];
    mu_pixel_rgb(pixel, rgb);
    const _Bool clamped = half && fmax(rgb[0], fmax(rgb[1], rgb[2])) > HALF_MAX;
    for (size_t c = 0; c < 3; ++c) {
        out[c * stride].number = bounded(rgb[c], half);
        out[(4 + c) * stride].number = bounded((double)pixel->albedo[c], half);
        out[(7 + c) * stride].number = bounded((double)pixel->normal[c], half);
    }
    out[3 * stride].number = pixel->samples ? (float)((double)pixel->hits / pixel->samples) : 0;
    out[VARIANCE * stride].number = bounded(mu_pixel_variance(pixel), 0);
    out[SAMPLES * stride].count = pixel->samples;
    return clamped;
}

/* -------------------------------------------------------------------------------------------------- header
 */

static exr_result_t put_text(exr_context_t exr, const char *name, const char *text) {
    return text ? exr_attr_set_string(exr, 0, name, text) : EXR_ERR_SUCCESS;
}

static exr_result_t put_vector(exr_context_t exr, const char *name, mu_vec3 v) {
    const exr_attr_v3f_t value = {.x = v.x, .y = v.y, .z = v.z};
    return exr_attr_set_v3f(exr, 0, name, &value);
}

static exr_result_t put_camera(exr_context_t exr, const mu_camera *camera) {
    const _Bool perspective = camera->kind == MU_PERSPECTIVE;
    const double degrees = 360 / 3.14159265358979323846;
    exr_result_t code = put_text(exr, "cameraProjection", perspective ? "perspective" : "orthographic");
    code = code ? code : put_vector(exr, "cameraPosition", camera->position);
    code = code ? code : put_vector(exr, "cameraForward", camera->forward);
    code = code ? code : put_vector(exr, "cameraRight", camera->right);
    code = code ? code : put_vector(exr, "cameraUp", camera->up);
    if (code) return code;
    return perspective
               ? exr_attr_set_float(exr, 0, "cameraFovVertical", /* degrees */
                                    (float)(degrees * atan((double)camera->half_height)))
               : exr_attr_set_float(exr, 0, "cameraHeight", 2 * camera->half_height); /* world units */
}

static exr_result_t put_head(exr_context_t exr, const mu_film *film, const mu_film_settings *settings,
                             const mu_image_info *info) {
    static const exr_attr_chromaticities_t rec709 = {.64f, .33f, .30f, .60f, .15f, .06f, .3127f, .3290f};
    int part = -1;
    char number[32], software[128]; /* a text called "version" would break the reader: the name is reserved */
    exr_result_t code = exr_add_part(exr, "musurf", EXR_STORAGE_SCANLINE, &part);
    code = code ? code
                : exr_initialize_required_attr_simple(exr, 0, (int32_t)film->width, (int32_t)film->height,
                                                      EXR_COMPRESSION_ZIP);
    for (int c = 0; c < CHANNELS && !code; ++c) {
        const exr_pixel_type_t kind = c == SAMPLES                     ? EXR_PIXEL_UINT
                                      : c < VARIANCE && settings->half ? EXR_PIXEL_HALF
                                                                       : EXR_PIXEL_FLOAT;
        code = exr_add_channel(exr, 0, channel_names[c], kind, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    }
    snprintf(software, sizeof software, "musurf %s", info->version ? info->version : "");
    code = code ? code : put_text(exr, "software", software);
    code = code ? code : put_text(exr, "softwareVersion", info->version);
    code = code ? code : put_text(exr, "command", info->command);
    code = code ? code : put_text(exr, "sceneFile", info->scene_file);
    code = code ? code : put_text(exr, "scene", info->scene_text);
    snprintf(number, sizeof number, "%llu", (unsigned long long)info->seed); /* EXR has no 64-bit integers */
    code = code ? code : put_text(exr, "seed", number);
    code = code ? code : exr_attr_set_int(exr, 0, "samples", (int32_t)info->samples);
    code = code ? code : exr_attr_set_double(exr, 0, "seconds", info->seconds);
    code = code ? code : exr_attr_set_double(exr, 0, "noise", mu_film_noise(film));
    code = code ? code : exr_attr_set_chromaticities(exr, 0, "chromaticities", &rec709);
    return code ? code : put_camera(exr, &info->camera);
}

/* -------------------------------------------------------------------------------------------------- pixels
 */

static exr_result_t put_pixels(exr_context_t exr, const mu_film *film, _Bool half, mu_element *block,
                               size_t lines, size_t *clamped) {
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    mu_exr_shrink shrink = {NULL};
    exr_result_t code = EXR_ERR_SUCCESS;
    const size_t width = film->width, stride = width * lines; /* elements from one channel to the next */
    for (size_t y = 0; y < film->height && !code; y += lines) {
        exr_chunk_info_t chunk;
        code = exr_write_scanline_chunk_info(exr, 0, (int)y, &chunk);
        if (code) break;
        code =
            y ? exr_encoding_update(exr, 0, &chunk, &pipe) : exr_encoding_initialize(exr, 0, &chunk, &pipe);
        if (code) break;
        for (size_t i = 0; i < (size_t)chunk.height * width; ++i)
            *clamped += fill(block + i, stride, &film->pixels[y * width + i], half);
        for (int16_t c = 0; c < pipe.channel_count;
             ++c) { /* the library keeps channels in alphabetical order */
            exr_coding_channel_info_t *channel = &pipe.channels[c];
            size_t index = 0;
            while (strcmp(channel_names[index], channel->channel_name)) ++index;
            channel->encode_from_ptr = (const uint8_t *)(block + index * stride);
            channel->user_pixel_stride = sizeof(mu_element);
            channel->user_line_stride = (int32_t)(width * sizeof(mu_element));
            channel->user_bytes_per_element = sizeof(mu_element);
            channel->user_data_type = index == SAMPLES ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
        }
        if (!y) code = exr_encoding_choose_default_routines(exr, 0, &pipe);
        if (!y && !code) mu_exr_shrink_use(&pipe, &shrink);
        if (!code) code = exr_encoding_run(exr, 0, &pipe);
    }
    exr_encoding_destroy(exr, &pipe);
    return code;
}

_Bool mu_image_write_exr(const char *file, const mu_film *film, const mu_film_settings *settings,
                         const mu_image_info *info, mu_error *error) {
    mu_output output;
    if (!mu_output_open(&output, file, error)) return 0;
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.error_handler_fn = keep_quiet;
    start.user_data = &output;
    start.write_fn = take;
    exr_context_t exr = NULL;
    exr_result_t code = exr_start_write(&exr, file, EXR_WRITE_FILE_DIRECTLY, &start);
    const _Bool started = !code;
    int32_t lines = 0;
    size_t clamped = 0;
    code = code ? code : put_head(exr, film, settings, info);
    code = code ? code : exr_write_header(exr);
    code = code ? code : exr_get_scanlines_per_chunk(exr, 0, &lines);
    mu_element *block = code ? NULL : calloc((size_t)lines * film->width * CHANNELS, sizeof *block);
    if (!code)
        code = block ? put_pixels(exr, film, settings->half, block, (size_t)lines, &clamped)
                     : EXR_ERR_OUT_OF_MEMORY;
    free(block);
    if (started) {
        const exr_result_t last = exr_finish(&exr); /* writes the table of blocks */
        code = code ? code : last;
    }
    if (clamped)
        mu_warn(
            error,
            "%s: %zu pixels are brighter than %.0f and written as that; \"pixels\": \"float\" in the film "
            "would keep them",
            file, clamped, HALF_MAX);
    if (!code || output.trouble) return mu_output_commit(&output, error);
    mu_output_discard(&output);
    return mu_fail(error, "%s: cannot be written: %s", file, exr_get_default_error_message(code));
}
