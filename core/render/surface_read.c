/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_read.c: reads heightfields, by OpenEXR's C core. Nothing a header says is believed before it is checked. */
#include <errno.h>
#include <math.h>
#include <openexr.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "core/render/surface_file.h"

static void keep_quiet(exr_const_context_t context, exr_result_t code, const char *message) {
    (void)context, (void)code, (void)message;
}

static _Bool check_head(exr_context_t exr, const char *file, uint32_t *n, exr_attr_box2i_t *window,
                        mu_error *error) {
    int parts = 0;
    exr_storage_t storage;
    const exr_attr_chlist_t *channels = NULL;
    if (exr_get_count(exr, &parts) || exr_get_storage(exr, 0, &storage) ||
        exr_get_channels(exr, 0, &channels) || exr_get_data_window(exr, 0, window))
        return mu_fail(error, "%s: its header is damaged", file);
    if (parts != 1 || storage != EXR_STORAGE_SCANLINE)
        return mu_fail(error, "%s: a heightfield is an EXR of one scanline part; this has %d %s", file, parts,
                       parts == 1 ? "part that is tiled or deep" : "parts");
    if (channels->num_channels != 1)
        return mu_fail(error, "%s: a heightfield has one channel; this has %d", file, channels->num_channels);
    if (channels->entries[0].pixel_type != EXR_PIXEL_FLOAT)
        return mu_fail(error, "%s: heights are 32-bit floats; channel \"%s\" is %s", file,
                       channels->entries[0].name.str,
                       channels->entries[0].pixel_type == EXR_PIXEL_HALF ? "half" : "of whole numbers");
    const int64_t width = (int64_t)window->max.x - window->min.x + 1,
                  height = (int64_t)window->max.y - window->min.y + 1;
    if (width != height || width < MU_SURFACE_LEAST || width > MU_SURFACE_MOST)
        return mu_fail(error, "%s: is %lld x %lld; a heightfield is n x n, n from %d to %d", file,
                       (long long)width, (long long)height, MU_SURFACE_LEAST, MU_SURFACE_MOST);
    if (channels->entries[0].x_sampling != 1 || channels->entries[0].y_sampling != 1)
        return mu_fail(error, "%s: its channel is subsampled", file);
    *n = (uint32_t)width;
    return 1;
}

static exr_result_t get_lines(exr_context_t exr, const exr_attr_box2i_t *window, uint32_t n, float *out) {
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    exr_result_t code = EXR_ERR_SUCCESS;
    int32_t lines = 0;
    code = exr_get_scanlines_per_chunk(exr, 0, &lines);
    for (uint32_t i = 0; i < n && !code; i += (uint32_t)lines) {
        exr_chunk_info_t chunk;
        code = exr_read_scanline_chunk_info(exr, 0, window->min.y + (int)i, &chunk);
        if (code) break;
        code =
            i ? exr_decoding_update(exr, 0, &chunk, &pipe) : exr_decoding_initialize(exr, 0, &chunk, &pipe);
        if (code) break;
        pipe.channels[0].decode_to_ptr = (uint8_t *)(out + (size_t)i * n);
        pipe.channels[0].user_pixel_stride = sizeof(float);
        pipe.channels[0].user_line_stride = (int32_t)(n * sizeof(float));
        pipe.channels[0].user_bytes_per_element = sizeof(float);
        pipe.channels[0].user_data_type = EXR_PIXEL_FLOAT;
        if (!i) code = exr_decoding_choose_default_routines(exr, 0, &pipe);
        if (!code) code = exr_decoding_run(exr, 0, &pipe);
    }
    exr_decoding_destroy(exr, &pipe);
    return code;
}

static double *get_heights(exr_context_t exr, const char *file, uint32_t *n, mu_error *error) {
    exr_attr_box2i_t window;
    if (!check_head(exr, file, n, &window, error)) return NULL;
    const size_t count = (size_t)*n * *n;
    float *lines = calloc(count, sizeof *lines);
    double *h = malloc(count * sizeof *h);
    _Bool good = lines && h;
    if (!good) mu_fail(error, "%s: not enough memory for %u x %u heights", file, *n, *n);
    if (good && get_lines(exr, &window, *n, lines))
        good = mu_fail(error, "%s: is truncated or damaged", file);
    for (size_t k = 0; good && k < count; k++) {
        h[k] = (double)lines[k];
        if (!isfinite(h[k]))
            good = mu_fail(error, "%s: the height at x = %zu, y = %zu is not finite", file, k / *n, k % *n);
    }
    free(lines);
    if (good) return h;
    free(h);
    return NULL;
}

double *mu_surface_read(const char *file, uint32_t *n, mu_error *error) {
    struct stat status;
    if (stat(file, &status)) {
        mu_fail(error, "%s: cannot be opened: %s", file, strerror(errno));
        return NULL;
    }
    if (!S_ISREG(status.st_mode)) {
        mu_fail(error, "%s: is not a regular file", file);
        return NULL;
    }
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.error_handler_fn = keep_quiet;
    exr_context_t exr = NULL;
    const exr_result_t code = exr_start_read(&exr, file, &start);
    if (code) {
        mu_fail(error, "%s: cannot be read as an EXR image: %s", file, exr_get_default_error_message(code));
        return NULL;
    }
    double *h = get_heights(exr, file, n, error);
    exr_finish(&exr);
    return h;
}
