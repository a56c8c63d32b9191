/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* image_plane.c: numbers in an OpenEXR image of one channel (heights, a histogram), by OpenEXR's C core: no module is opened
 * for them. */
#include <openexr.h>
#include <stdlib.h>

#include "core/render/image_read.h"

enum { MOST_PIXELS = 1 << 27 };

static void keep_quiet(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

/* One channel of whole scanlines, not subsampled, whose window fits. */
static exr_result_t read_head(exr_const_context_t exr, int *width, int *height, const char **wrong) {
    exr_storage_t storage;
    exr_attr_box2i_t window;
    const exr_attr_chlist_t *channels;
    exr_result_t code = exr_get_storage(exr, 0, &storage);
    code = code ? code : exr_get_channels(exr, 0, &channels);
    code = code ? code : exr_get_data_window(exr, 0, &window);
    if (code) return code;
    const int64_t w = (int64_t)window.max.x - window.min.x + 1, h = (int64_t)window.max.y - window.min.y + 1;
    if (storage != EXR_STORAGE_SCANLINE) *wrong = "is not stored by scanlines";
    if (channels->num_channels != 1) *wrong = "has more than one channel; one is needed";
    if (channels->num_channels != 1 || channels->entries[0].x_sampling != 1 ||
        channels->entries[0].y_sampling != 1)
        *wrong = *wrong ? *wrong : "is subsampled";
    if (w < 1 || h < 1 || w > MOST_PIXELS || h > MOST_PIXELS || w * h > MOST_PIXELS) *wrong = "is too large";
    *width = (int)w, *height = (int)h;
    return code;
}

static exr_result_t read_pixels(exr_const_context_t exr, float *pixels, int width) {
    exr_attr_box2i_t window;
    int32_t lines = 1;
    exr_result_t code = exr_get_data_window(exr, 0, &window);
    code = code ? code : exr_get_scanlines_per_chunk(exr, 0, &lines);
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    for (int y = window.min.y; !code && y <= window.max.y; y += lines) {
        exr_chunk_info_t chunk;
        const _Bool first = y == window.min.y;
        code = exr_read_scanline_chunk_info(exr, 0, y, &chunk);
        if (!code)
            code = first ? exr_decoding_initialize(exr, 0, &chunk, &pipe)
                         : exr_decoding_update(exr, 0, &chunk, &pipe);
        if (code) break;
        exr_coding_channel_info_t *channel = &pipe.channels[0];
        channel->decode_to_ptr = (uint8_t *)(pixels + (size_t)(y - window.min.y) * (size_t)width);
        channel->user_pixel_stride = sizeof *pixels;
        channel->user_line_stride = (int32_t)((size_t)width * sizeof *pixels);
        channel->user_bytes_per_element = sizeof *pixels;
        channel->user_data_type = EXR_PIXEL_FLOAT;
        if (first) code = exr_decoding_choose_default_routines(exr, 0, &pipe);
        code = code ? code : exr_decoding_run(exr, 0, &pipe);
    }
    exr_decoding_destroy(exr, &pipe);
    return code;
}

float *mu_image_read_plane(const char *file, int *width, int *height, mu_error *error) {
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.error_handler_fn = keep_quiet;
    exr_context_t exr = NULL;
    const char *wrong = NULL;
    float *pixels = NULL;
    exr_result_t code = exr_start_read(&exr, file, &start);
    const _Bool started = !code;
    code = code ? code : read_head(exr, width, height, &wrong);
    if (!code && !wrong) {
        pixels = malloc((size_t)*width * (size_t)*height * sizeof *pixels);
        code = pixels ? read_pixels(exr, pixels, *width) : EXR_ERR_OUT_OF_MEMORY;
    }
    if (started) exr_finish(&exr);
    if (!code && !wrong) return pixels;
    free(pixels);
    mu_fail(error, "%s: %s%s", file, wrong ? wrong : "cannot be read as an OpenEXR image: ",
            wrong ? "" : exr_get_default_error_message(code));
    return NULL;
}
