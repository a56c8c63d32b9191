/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * film.h: sums per pixel, and what becomes of them.
 *
 * Reconstruction is by filter importance sampling: a pixel's samples are spread by the filter itself and weigh 1,
 * so that no thread ever writes to another's pixel and images are bit-identical for any number of threads.
 */
#ifndef MU_FILM_H
#define MU_FILM_H

#include <stdint.h>

#include "core/render/scene.h"

typedef struct mu_pixel {
    double rgb[3];      /* sums over samples */
    double luminance2;  /* sum of squares of luminance, for the variance */
    float albedo[3], normal[3];
    float alpha;
    uint32_t samples;
} mu_pixel;

typedef struct mu_film {
    uint32_t width, height;
    mu_pixel *pixels; /* row by row from the top */
    double seconds;   /* spent rendering, over all runs that contributed */
    uint64_t rays;
} mu_film;

_Bool mu_film_make(mu_film *film, uint32_t width, uint32_t height, mu_error *error);
void mu_film_free(mu_film *film);
/* Mean over pixels of (standard error of luminance / (luminance + 1e-3 of the image's mean)). Infinite under 2 samples. */
double mu_film_noise(const mu_film *film);

/* What goes into the header of the image besides pixels. */
typedef struct mu_image_info {
    const char *scene_file, *scene_text, *command, *version;
    uint64_t seed;
    uint32_t samples; /* per pixel */
    double seconds;
    mu_camera camera;
} mu_image_info;

/* EXR through OpenEXR's C core: R G B A, albedo.*, normal.*, samples, variance; ZIP. Written beside, then renamed. */
_Bool mu_image_write_exr(const char *file, const mu_film *film, const mu_film_settings *settings,
                         const mu_image_info *info, mu_error *error);
/* sRGB preview with the film's exposure and a soft shoulder; the same rule of beside-then-rename. */
_Bool mu_image_write_png(const char *file, const mu_film *film, const mu_film_settings *settings, mu_error *error);

/* The exact sums, so that a render can go on where it stopped. `key` must match: it is a digest of scene and seed. */
_Bool mu_film_save(const mu_film *film, const char *file, uint64_t key, mu_error *error);
_Bool mu_film_load(mu_film *film, const char *file, uint64_t key, mu_error *error);

#endif
