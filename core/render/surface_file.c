/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_file.c: writes heightfields, by OpenEXR's C core: one scanline part, ZIP, channel "Y". */
#include "core/render/surface_file.h"

#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/render/exr_shrink.h"
#include "core/render/output.h"

static void keep_quiet(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

static int64_t take(exr_const_context_t context, void *data, const void *bytes, uint64_t size,
                    uint64_t offset, exr_stream_error_func_ptr_t report) {
    (void)context, (void)report;
    return mu_output_write(data, bytes, size, offset) ? (int64_t)size : -1;
}

static exr_result_t put_law(exr_context_t exr, const mu_slope_law *law) {
    exr_result_t code = exr_attr_set_string(exr, 0, "ndf", mu_slope_names()[law->kind]);
    if (!code && law->kind != MU_SLOPE_PHONG) code = exr_attr_set_double(exr, 0, "alpha", law->alpha);
    if (!code && (law->kind == MU_SLOPE_GTR || law->kind == MU_SLOPE_STD))
        code = exr_attr_set_double(exr, 0, "gamma", law->gamma);
    if (!code && law->kind == MU_SLOPE_PHONG) code = exr_attr_set_double(exr, 0, "exponent", law->exponent);
    return code;
}

static exr_result_t put_head(exr_context_t exr, uint32_t n, const mu_surface_info *info) {
    int part = -1;
    char number[32];
    exr_result_t code = exr_add_part(exr, "surface", EXR_STORAGE_SCANLINE, &part);
    code = code ? code
                : exr_initialize_required_attr_simple(exr, 0, (int32_t)n, (int32_t)n, EXR_COMPRESSION_ZIP);
    code = code ? code : exr_add_channel(exr, 0, "Y", EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1);
    code = code ? code : exr_attr_set_string(exr, 0, "software", "musurf " MUSURF_VERSION);
    code = code ? code
                : exr_attr_set_string(exr, 0, "layout",
                                      "heights; scanline = x, pixel in it = y, cell 1, periodic");
    if (code || !info) return code;
    code = exr_attr_set_string(exr, 0, "command", info->command);
    code = code ? code : put_law(exr, &info->recipe->law);
    snprintf(number, sizeof number, "%llu",
             (unsigned long long)info->recipe->seed); /* EXR has no 64-bit integers */
    code = code ? code : exr_attr_set_string(exr, 0, "seed", number);
    code = code ? code : exr_attr_set_double(exr, 0, "correlation", info->recipe->correlation);
    code = code ? code : exr_attr_set_double(exr, 0, "clip", info->recipe->clip);
    code = code ? code : exr_attr_set_int(exr, 0, "passes", (int32_t)info->passes);
    code = code ? code : exr_attr_set_double(exr, 0, "deviationLower", info->deviation[0]);
    code = code ? code : exr_attr_set_double(exr, 0, "deviationUpper", info->deviation[1]);
    return code ? code : exr_attr_set_double(exr, 0, "steepestSlope", info->steepest);
}

static exr_result_t put_heights(exr_context_t exr, const mu_heightfield *f, float *block) {
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    mu_exr_shrink shrink = {NULL};
    exr_result_t code = EXR_ERR_SUCCESS;
    for (uint32_t i = 0; i < f->n && !code;) {
        exr_chunk_info_t chunk;
        code = exr_write_scanline_chunk_info(exr, 0, (int)i, &chunk);
        if (code) break;
        code =
            i ? exr_encoding_update(exr, 0, &chunk, &pipe) : exr_encoding_initialize(exr, 0, &chunk, &pipe);
        if (code) break;
        const size_t count = (size_t)chunk.height * f->n, from = (size_t)i * f->n;
        for (size_t k = 0; k < count; k++) block[k] = (float)f->h[from + k];
        pipe.channels[0].encode_from_ptr = (const uint8_t *)block;
        pipe.channels[0].user_pixel_stride = sizeof(float);
        pipe.channels[0].user_line_stride = (int32_t)(f->n * sizeof(float));
        pipe.channels[0].user_bytes_per_element = sizeof(float);
        pipe.channels[0].user_data_type = EXR_PIXEL_FLOAT;
        if (!i) code = exr_encoding_choose_default_routines(exr, 0, &pipe);
        if (!i && !code) mu_exr_shrink_use(&pipe, &shrink);
        if (!code) code = exr_encoding_run(exr, 0, &pipe);
        i += (uint32_t)chunk.height;
    }
    exr_encoding_destroy(exr, &pipe);
    return code;
}

_Bool mu_surface_write(const char *file, const mu_heightfield *f, const mu_surface_info *info,
                       mu_error *error) {
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
    code = code ? code : put_head(exr, f->n, info);
    code = code ? code : exr_write_header(exr);
    code = code ? code : exr_get_scanlines_per_chunk(exr, 0, &lines);
    float *block = code ? NULL : malloc((size_t)lines * f->n * sizeof *block);
    if (!code) code = block ? put_heights(exr, f, block) : EXR_ERR_OUT_OF_MEMORY;
    free(block);
    if (started) {
        const exr_result_t last = exr_finish(&exr); /* writes the table of blocks */
        code = code ? code : last;
    }
    if (!code || output.trouble) return mu_output_commit(&output, error);
    mu_output_discard(&output);
    return mu_fail(error, "%s: cannot be written: %s", file, exr_get_default_error_message(code));
}
