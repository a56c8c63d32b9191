/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* image_png.c: the preview: 8-bit sRGB over black, as it stands in the film (the background is part of it).
 */
#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/image.h"
#include "core/render/output.h"

typedef struct mu_png {
    mu_output output;
    uint64_t offset;
    char trouble[128]; /* libpng's own words, if it gave up */
} mu_png;

static void take(png_structp png, png_bytep data, size_t bytes) {
    mu_png *self = png_get_io_ptr(png);
    if (!mu_output_write(&self->output, data, bytes, self->offset)) png_error(png, "write failed");
    self->offset += bytes;
}
static void flush(png_structp png) {
    (void)png;
}

static void complain(png_structp png, png_const_charp message) {
    mu_png *self = png_get_error_ptr(png);
    strncpy(self->trouble, message, sizeof self->trouble - 1);
    png_longjmp(png, 1);
}
static void ignore(png_structp png, png_const_charp message) {
    (void)png, (void)message;
}

static void put_text(png_structp png, png_infop head, const char *key, const char *text) {
    if (!text) return;
    /* libpng wants them writable, but does not write. iTXt: UTF-8. */
    png_text chunk = {.compression = PNG_ITXT_COMPRESSION_NONE,
                      .key = (char *)(uintptr_t)key,
                      .text = (char *)(uintptr_t)text,
                      .itxt_length = strlen(text)};
    png_set_text(png, head, &chunk, 1);
}

/* Everything that may longjmp, with nothing local that lives across it. */
static _Bool encode(png_structp png, png_infop head, const mu_film *film, const mu_film_settings *settings,
                    const mu_image_info *info, png_bytep row) {
    if (setjmp(png_jmpbuf(png))) return 0;
    const double gain = exp2((double)settings->exposure);
    png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_IHDR(png, head, film->width, film->height, 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, head, PNG_sRGB_INTENT_PERCEPTUAL);
    put_text(png, head, "Software", info->version);
    put_text(png, head, "Source", info->scene_file);
    put_text(png, head, "Comment", info->command);
    png_write_info(png, head);
    for (uint32_t y = 0; y < film->height; ++y) {
        for (uint32_t x = 0; x < film->width; ++x) {
            double rgb[3];
            mu_pixel_rgb(&film->pixels[(size_t)y * film->width + x], rgb);
            for (int c = 0; c < 3; ++c)
                row[3 * (size_t)x + (size_t)c] = mu_tone_srgb8(mu_tone_curve(gain * rgb[c]));
        }
        png_write_row(png, row);
    }
    png_write_end(png, head);
    return 1;
}

_Bool mu_image_write_png(const char *file, const mu_film *film, const mu_film_settings *settings,
                         const mu_image_info *info, mu_error *error) {
    mu_png self = {.offset = 0};
    if (!mu_output_open(&self.output, file, error)) return 0;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &self, complain, ignore);
    png_infop head = png ? png_create_info_struct(png) : NULL;
    png_bytep row = malloc(3 * (size_t)film->width);
    _Bool made = 0;
    if (head && row) {
        png_set_write_fn(png, &self, take, flush);
        made = encode(png, head, film, settings, info, row);
    } else {
        strcpy(self.trouble, "out of memory");
    }
    free(row);
    png_destroy_write_struct(&png, &head);
    if (made || self.output.trouble) return mu_output_commit(&self.output, error);
    mu_output_discard(&self.output);
    return mu_fail(error, "%s: cannot be written: %s", file, self.trouble);
}
