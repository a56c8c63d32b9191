/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* image_plane.c: numbers in one channel of an OpenEXR image (heights, a histogram), by OpenEXR's C core: no module is opened for
 * them. Nothing a header says is believed before it is checked. */
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/image_read.h"

enum { MOST_PIXELS = 1 << 27 };

static void keep_quiet(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

typedef struct mu_plane_head {
    int width, height, top;
    int chosen; /* index of the channel */
} mu_plane_head;

/* Names of the channels for a message, as far as there is room. */
static void list(const exr_attr_chlist_t *channels, char *out, size_t size) {
    size_t length = 0;
    out[0] = 0;
    for (int c = 0; c < channels->num_channels && length < size; c++)
        length += (size_t)snprintf(out + length, size - length, "%s%s", c ? ", " : "",
                                   channels->entries[c].name.str);
}

static _Bool choose(const exr_attr_chlist_t *channels, const char *file, const char *name, int *chosen,
                    mu_error *error) {
    char names[200];
    list(channels, names, sizeof names);
    *chosen = name || channels->num_channels != 1 ? -1 : 0;
    for (int c = 0; name && c < channels->num_channels; c++)
        if (!strcmp(channels->entries[c].name.str, name)) *chosen = c;
    if (*chosen < 0 && name) return mu_fail(error, "%s: has no channel \"%s\", but %s", file, name, names);
    if (*chosen < 0) return mu_fail(error, "%s: has more than one channel; one is needed of %s", file, names);
    const exr_attr_chlist_entry_t *entry = &channels->entries[*chosen];
    return (entry->x_sampling == 1 && entry->y_sampling == 1) ||
           mu_fail(error, "%s: its channel is subsampled", file);
}

static _Bool read_head(exr_const_context_t exr, const char *file, const char *name, mu_plane_head *head,
                       mu_error *error) {
    exr_storage_t storage;
    exr_attr_box2i_t window;
    const exr_attr_chlist_t *channels;
    if (exr_get_storage(exr, 0, &storage) || exr_get_channels(exr, 0, &channels) ||
        exr_get_data_window(exr, 0, &window))
        return mu_fail(error, "%s: its header is damaged", file);
    const int64_t w = (int64_t)window.max.x - window.min.x + 1, h = (int64_t)window.max.y - window.min.y + 1;
    if (storage != EXR_STORAGE_SCANLINE) return mu_fail(error, "%s: is not stored by scanlines", file);
    if (w < 1 || h < 1 || w > MOST_PIXELS || h > MOST_PIXELS || w * h > MOST_PIXELS)
        return mu_fail(error, "%s: is too large", file);
    *head = (mu_plane_head){.width = (int)w, .height = (int)h, .top = window.min.y};
    return choose(channels, file, name, &head->chosen, error);
}

static exr_result_t read_pixels(exr_const_context_t exr, const mu_plane_head *head, float *pixels) {
    int32_t lines = 1;
    exr_result_t code = exr_get_scanlines_per_chunk(exr, 0, &lines);
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    for (int y = 0; !code && y < head->height; y += lines) {
        exr_chunk_info_t chunk;
        code = exr_read_scanline_chunk_info(exr, 0, head->top + y, &chunk);
        if (!code)
            code = y ? exr_decoding_update(exr, 0, &chunk, &pipe)
                     : exr_decoding_initialize(exr, 0, &chunk, &pipe);
        if (code) break;
        exr_coding_channel_info_t *channel = &pipe.channels[head->chosen]; /* the others are left out */
        channel->decode_to_ptr = (uint8_t *)(pixels + (size_t)y * (size_t)head->width);
        channel->user_pixel_stride = sizeof *pixels;
        channel->user_line_stride = (int32_t)((size_t)head->width * sizeof *pixels);
        channel->user_bytes_per_element = sizeof *pixels;
        channel->user_data_type = EXR_PIXEL_FLOAT;
        if (!y) code = exr_decoding_choose_default_routines(exr, 0, &pipe);
        code = code ? code : exr_decoding_run(exr, 0, &pipe);
    }
    exr_decoding_destroy(exr, &pipe);
    return code;
}

float *mu_image_read_plane(const char *file, const char *channel, int *width, int *height, mu_error *error) {
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.error_handler_fn = keep_quiet;
    exr_context_t exr = NULL;
    mu_plane_head head = {0};
    exr_result_t code = exr_start_read(&exr, file, &start);
    if (code) {
        mu_fail(error, "%s: cannot be read as an OpenEXR image: %s", file,
                exr_get_default_error_message(code));
        return NULL;
    }
    float *pixels = NULL;
    if (read_head(exr, file, channel, &head, error)) {
        pixels = calloc((size_t)head.width * (size_t)head.height, sizeof *pixels);
        if (!pixels)
            mu_fail(error, "%s: not enough memory for %d x %d pixels", file, head.width, head.height);
        code = pixels ? read_pixels(exr, &head, pixels) : EXR_ERR_SUCCESS;
    }
    exr_finish(&exr);
    *width = head.width, *height = head.height;
    if (!code) return pixels;
    free(pixels);
    mu_fail(error, "%s: is truncated or damaged: %s", file, exr_get_default_error_message(code));
    return NULL;
}
