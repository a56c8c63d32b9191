/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* exr_mip.c: mip-mapped OpenEXR images, which any program that reads textures reads. */
#include <string.h>

#include "core/render/exr_shrink.h"
#include "core/render/exr_write.h"

enum { TILE = 64, CHANNELS = 3 };

static exr_result_t put_tile(exr_context_t exr, exr_encode_pipeline_t *pipe, mu_exr_shrink *shrink,
                             const float *from, size_t row, _Bool first) {
    exr_result_t code = EXR_ERR_SUCCESS;
    for (int16_t c = 0; c < pipe->channel_count; c++) {
        exr_coding_channel_info_t *channel = &pipe->channels[c];
        const size_t index = channel->channel_name[0] == 'R' ? 0 : channel->channel_name[0] == 'G' ? 1 : 2;
        channel->encode_from_ptr = (const uint8_t *)(from + index);
        channel->user_pixel_stride = CHANNELS * sizeof(float);
        channel->user_line_stride = (int32_t)(row * CHANNELS * sizeof(float));
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
    }
    if (first) code = exr_encoding_choose_default_routines(exr, 0, pipe);
    if (first && !code) mu_exr_shrink_use(pipe, shrink);
    return code ? code : exr_encoding_run(exr, 0, pipe);
}

static exr_result_t put_levels(exr_context_t exr, const mu_exr_mip *mip) {
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    mu_exr_shrink shrink = {NULL};
    exr_result_t code = EXR_ERR_SUCCESS;
    _Bool first = 1;
    for (uint32_t l = 0; l < mip->levels && !code; l++) {
        const uint32_t width = mip->width >> l ? mip->width >> l : 1,
                       height = mip->height >> l ? mip->height >> l : 1;
        for (uint32_t y = 0; y < height && !code; y += TILE)
            for (uint32_t x = 0; x < width && !code; x += TILE, first = 0) {
                exr_chunk_info_t chunk;
                code = exr_write_tile_chunk_info(exr, 0, (int)(x / TILE), (int)(y / TILE), (int)l, (int)l,
                                                 &chunk);
                if (!code)
                    code = first ? exr_encoding_initialize(exr, 0, &chunk, &pipe)
                                 : exr_encoding_update(exr, 0, &chunk, &pipe);
                if (!code)
                    code = put_tile(exr, &pipe, &shrink, mip->pixels[l] + CHANNELS * ((size_t)y * width + x),
                                    width, first);
            }
    }
    exr_encoding_destroy(exr, &pipe);
    return code;
}

static exr_result_t put_mip(exr_context_t exr, const void *context) {
    static const char *const names[CHANNELS] = {"R", "G", "B"};
    const mu_exr_mip *mip = context;
    int part = -1;
    exr_result_t code = exr_add_part(exr, mip->part, EXR_STORAGE_TILED, &part);
    code = code ? code
                : exr_initialize_required_attr_simple(exr, 0, (int32_t)mip->width, (int32_t)mip->height,
                                                      EXR_COMPRESSION_ZIP);
    code = code ? code
                : exr_set_tile_descriptor(exr, 0, TILE, TILE, EXR_TILE_MIPMAP_LEVELS, EXR_TILE_ROUND_DOWN);
    for (int c = 0; c < CHANNELS && !code; c++)
        code = exr_add_channel(exr, 0, names[c], EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    code = code ? code : exr_attr_set_envmap(exr, 0, "envmap", EXR_ENVMAP_LATLONG);
    code = code ? code : mip->head(exr, mip->context);
    code = code ? code : exr_write_header(exr);
    return code ? code : put_levels(exr, mip);
}

_Bool mu_exr_write_mip(const char *file, const mu_exr_mip *mip, mu_error *error) {
    return mu_exr_file(file, put_mip, mip, error);
}

static void keep_quiet(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

_Bool mu_exr_has_text(const char *file, const char *name, const char *text) {
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t exr = NULL;
    int32_t length = 0;
    const char *found = NULL;
    start.error_handler_fn = keep_quiet;
    if (exr_start_read(&exr, file, &start)) return 0;
    const _Bool same = !exr_attr_get_string(exr, 0, name, &length, &found) && strcmp(found, text) == 0;
    exr_finish(&exr);
    return same;
}
