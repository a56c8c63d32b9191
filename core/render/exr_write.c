/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* exr_write.c: see exr_write.h. */
#include "core/render/exr_write.h"

#include <stdlib.h>
#include <string.h>

#include "core/render/exr_shrink.h"
#include "core/render/output.h"

/* Errors come back as codes; this only keeps the library from printing. It must not ask the context for its user data:
 * while writing, the context is locked. */
static void keep_quiet(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

static int64_t take(exr_const_context_t context, void *data, const void *bytes, uint64_t size,
                    uint64_t offset, exr_stream_error_func_ptr_t report) {
    (void)context, (void)report;
    return mu_output_write(data, bytes, size, offset) ? (int64_t)size : -1;
}

exr_result_t mu_exr_put_text(exr_context_t exr, const char *name, const char *text) {
    return text ? exr_attr_set_string(exr, 0, name, text) : EXR_ERR_SUCCESS;
}

static exr_result_t put_head(exr_context_t exr, const mu_exr_image *image) {
    int part = -1;
    exr_result_t code = exr_add_part(exr, image->part, EXR_STORAGE_SCANLINE, &part);
    code = code ? code
                : exr_initialize_required_attr_simple(exr, 0, (int32_t)image->width, (int32_t)image->height,
                                                      EXR_COMPRESSION_ZIP);
    for (size_t c = 0; c < image->channel_count && !code; c++)
        code = exr_add_channel(exr, 0, image->channels[c].name, image->channels[c].stored, image->treatment,
                               1, 1);
    code = code ? code : image->head(exr, image->context);
    return code ? code : exr_write_header(exr);
}

/* The library keeps channels in alphabetical order. */
static void point_to(const mu_exr_image *image, exr_encode_pipeline_t *pipe, const mu_exr_element *block,
                     size_t stride) {
    for (int16_t c = 0; c < pipe->channel_count; c++) {
        exr_coding_channel_info_t *channel = &pipe->channels[c];
        size_t index = 0;
        while (strcmp(image->channels[index].name, channel->channel_name)) index++;
        channel->encode_from_ptr = (const uint8_t *)(block + index * stride);
        channel->user_pixel_stride = sizeof(mu_exr_element);
        channel->user_line_stride = (int32_t)(image->width * sizeof(mu_exr_element));
        channel->user_bytes_per_element = sizeof(mu_exr_element);
        channel->user_data_type =
            image->channels[index].stored == EXR_PIXEL_UINT ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
    }
}

static exr_result_t put_lines(exr_context_t exr, const mu_exr_image *image, mu_exr_element *block,
                              uint32_t lines) {
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t code = EXR_ERR_SUCCESS;
    const size_t stride = (size_t)image->width * lines;
    mu_exr_shrink shrink = {NULL};
    for (uint32_t y = 0; y < image->height && !code; y += lines) {
        exr_chunk_info_t chunk;
        code = exr_write_scanline_chunk_info(exr, 0, (int)y, &chunk);
        if (code) break;
        code =
            y ? exr_encoding_update(exr, 0, &chunk, &pipe) : exr_encoding_initialize(exr, 0, &chunk, &pipe);
        if (code) break;
        image->fill(image->context, y, (uint32_t)chunk.height, stride, block);
        point_to(image, &pipe, block, stride);
        if (!y) code = exr_encoding_choose_default_routines(exr, 0, &pipe);
        if (!y && !code) mu_exr_shrink_use(&pipe, &shrink);
        if (!code) code = exr_encoding_run(exr, 0, &pipe);
    }
    exr_encoding_destroy(exr, &pipe);
    return code;
}

_Bool mu_exr_file(const char *file, exr_result_t (*write)(exr_context_t exr, const void *context),
                  const void *context, mu_error *error) {
    mu_output output;
    if (!mu_output_open(&output, file, error)) return 0;
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.error_handler_fn = keep_quiet;
    start.user_data = &output;
    start.write_fn = take;
    exr_context_t exr = NULL;
    exr_result_t code = exr_start_write(&exr, file, EXR_WRITE_FILE_DIRECTLY, &start);
    if (!code) {
        code = write(exr, context);
        const exr_result_t last = exr_finish(&exr); /* writes the table of blocks */
        code = code ? code : last;
    }
    if (!code || output.trouble) return mu_output_commit(&output, error);
    mu_output_discard(&output);
    return mu_fail(error, "%s: cannot be written: %s", file, exr_get_default_error_message(code));
}

static exr_result_t put_image(exr_context_t exr, const void *context) {
    const mu_exr_image *image = context;
    int32_t lines = 0;
    exr_result_t code = put_head(exr, image);
    code = code ? code : exr_get_scanlines_per_chunk(exr, 0, &lines);
    if (code) return code;
    mu_exr_element *block = calloc((size_t)lines * image->width * image->channel_count, sizeof *block);
    code = block ? put_lines(exr, image, block, (uint32_t)lines) : EXR_ERR_OUT_OF_MEMORY;
    free(block);
    return code;
}

_Bool mu_exr_write(const char *file, const mu_exr_image *image, mu_error *error) {
    return mu_exr_file(file, put_image, image, error);
}
