/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * exr_write.h: OpenEXR images by OpenEXR's C core: one scanline part, ZIP, blocks of lines filled as they are written.
 *
 * The library writes through mu_output, so that a full disk is an error with a reason and never a broken image.
 */
#ifndef MU_EXR_WRITE_H
#define MU_EXR_WRITE_H

#include <openexr.h>
#include <stddef.h>
#include <stdint.h>

#include "core/render/error.h"

typedef struct mu_exr_channel {
    const char *name;
    exr_pixel_type_t stored; /* EXR_PIXEL_UINT is given as count, the others as number */
} mu_exr_channel;

typedef union mu_exr_element { /* four bytes of a line: what the library's packing reads */
    float number;
    uint32_t count;
} mu_exr_element;

typedef struct mu_exr_image {
    const char *part;
    uint32_t width, height;
    exr_perceptual_treatment_t treatment;
    const mu_exr_channel *channels;
    size_t channel_count;
    /* Attributes, besides those that every image must have. */
    exr_result_t (*head)(exr_context_t exr, const void *context);
    /* Lines y ... y + lines - 1: element x + width l of channel c goes to out[c stride + x + width l]. */
    void (*fill)(void *context, uint32_t y, uint32_t lines, size_t stride, mu_exr_element *out);
    void *context;
} mu_exr_image;

/* By the rule of output.h. */
_Bool mu_exr_write(const char *file, const mu_exr_image *image, mu_error *error);

/* The file around what `write` puts into it: header, blocks. By the rule of output.h. */
_Bool mu_exr_file(const char *file, exr_result_t (*write)(exr_context_t exr, const void *context),
                  const void *context, mu_error *error);

/* RGB of floats as a mip map: tiles of 64 x 64, ZIP, sizes halved and rounded down to 1 x 1 (exr_mip.c). */
typedef struct mu_exr_mip {
    const char *part;
    uint32_t width, height, levels;
    const float *const *pixels; /* of each level, row by row from the top */
    exr_result_t (*head)(exr_context_t exr, const void *context);
    const void *context;
} mu_exr_mip;

_Bool mu_exr_write_mip(const char *file, const mu_exr_mip *mip, mu_error *error);

/* A text attribute of a file's first part; false if there is none of that value: no file, no EXR, another text. */
_Bool mu_exr_has_text(const char *file, const char *name, const char *text);

/* A text attribute; none if `text` is NULL. */
exr_result_t mu_exr_put_text(exr_context_t exr, const char *name, const char *text);

#endif
