/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * film.h: sums per pixel, and what becomes of them.
 *
 * Reconstruction is by filter importance sampling: a pixel's samples are spread by the filter itself and
 * weigh 1, so that no thread ever writes to another's pixel and images are bit-identical for any number of
 * threads. A pixel takes its samples in the order of their index, one addition each, so it does not matter
 * either in how many sittings they were taken.
 */
#ifndef MU_FILM_H
#define MU_FILM_H

#include <stdint.h>

#include "core/render/scene.h"

struct mu_radiance;

/* Samples of a pixel are stratified, so their own variance tells too much. Those of one block of consecutive ones are
 * stratified among themselves, and blocks are close to independent of each other: the variance of the blocks' sums
 * counts most of what stratification gains. Below MU_BLOCKS of them that would be too rough a guess. */
enum { MU_BLOCK = 16, MU_BLOCKS = 8 };

typedef struct mu_pixel {
    double rgb[3];              /* sums over samples */
    double luminance2;          /* sum of squares of luminance (Rec. 709), for the variance */
    double block;               /* luminance of the block that is not full yet */
    double block2;              /* sum of squares of the full blocks' luminance */
    float albedo[3], normal[3]; /* means over samples: a float sum would stall after millions of them */
    uint32_t hits;              /* samples whose camera ray hit something */
    uint32_t samples;
} mu_pixel;

typedef struct mu_film {
    uint32_t width, height;
    mu_pixel *pixels; /* row by row from the top */
    double seconds;   /* spent rendering, over all runs that contributed */
    uint64_t rays;
    uint64_t refused; /* samples, or contributions to them, that were not finite; they count as black */
} mu_film;

/* Black, without samples. A film that this machine's memory cannot hold is refused. */
_Bool mu_film_make(mu_film *film, uint32_t width, uint32_t height, mu_error *error);
void mu_film_free(mu_film *film);
/* The smallest and the largest number of samples of any pixel. */
void mu_film_samples(const mu_film *film, uint32_t *least, uint32_t *most);
/* Mean over pixels of (standard error of luminance / (luminance + 1e-3 of the image's mean)). Infinite under
 * 2 samples, 0 for a black image. */
double mu_film_noise(const mu_film *film);

/* False if the sample was not finite and counted as black. */
_Bool mu_pixel_add(mu_pixel *pixel, const struct mu_radiance *sample);
/* Mean radiance. */
void mu_pixel_rgb(const mu_pixel *pixel, double rgb[3]);
/* Variance of the mean luminance: the square of its standard error; on the safe side, and far so below MU_BLOCK *
 * MU_BLOCKS samples where they count as independent. 0 under 2 samples, where it is unknown. */
double mu_pixel_variance(const mu_pixel *pixel);

/* The exact sums, so that a render can go on where it stopped. `key` must match: it is a digest of scene and
 * seed. */
_Bool mu_film_save(const mu_film *film, const char *file, uint64_t key, mu_error *error);
/* Into a film made with the same size, which stays without samples if the file is refused. */
_Bool mu_film_load(mu_film *film, const char *file, uint64_t key, mu_error *error);

#endif
