/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * image_read.h: pictures from files, through the module musurf_oiio.so that holds OpenImageIO.
 *
 * Opening OpenImageIO costs some 400 ms and 128 MB, so the module is opened here, when the first picture is
 * read, and not linked. search.h says where it is looked for.
 */
#ifndef MU_IMAGE_READ_H
#define MU_IMAGE_READ_H

#include "core/render/error.h"

/* Linear RGB, row by row from the top; free() it. Grey is repeated, alpha and further channels are left out.
 * NULL on failure: missing, truncated, of no known format, or of more than 2^27 pixels. */
float *mu_image_read(const char *file, int *width, int *height, mu_error *error);

/* The numbers of one channel of an OpenEXR image of scanlines, by its C core (image_plane.c), row by row from the top;
 * free() it. `channel` NULL: its only one. */
float *mu_image_read_plane(const char *file, const char *channel, int *width, int *height, mu_error *error);

/* `count` channels of any picture, side by side: as they are stored, but whole-number codes as fractions of the largest, which
 * are *step apart then; of floats that is 0. Those of these names; if it lacks one, that is an error where they are `named` by
 * the user, and else the first channels are taken, as they are where `names` is NULL. free() it. */
float *mu_image_read_channels(const char *file, const char *const *names, _Bool named, int count, int *width,
                              int *height, double *step, mu_error *error);

/* One channel of any picture as it is stored, through the module: whole-number codes stay what they are, nothing is decoded
 * or divided by alpha. `channel` NULL: its only one. */
double *mu_image_read_raw(const char *file, const char *channel, int *width, int *height, mu_error *error);

#endif
