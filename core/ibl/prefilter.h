/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * prefilter.h: an environment blurred by GGX lobes, level by level (Section 3). In float.
 *
 * Images are latitude-longitude, RGB, row by row from the top: v = theta / pi from +z down, u = 1/2 - phi / 2 pi, the middle
 * column towards +x. Radiance is constant in a pixel where areas are averaged, and interpolated between pixels' middles
 * where directions look it up.
 */
#ifndef MU_IBL_PREFILTER_H
#define MU_IBL_PREFILTER_H

#include <stddef.h>

enum { MU_IBL_LEVELS_MOST = 24 };

typedef struct mu_ibl_image {
    size_t width, height;
    float *rgb; /* 3 width height */
} mu_ibl_image;

/* `to` becomes what `from` holds, averaged by solid angle over each of its pixels. The sizes need not divide each other. */
void mu_ibl_average(const mu_ibl_image *from, mu_ibl_image *to);

/* `to` becomes what a cube map of six faces one below the other, each at least 2 pixels wide, holds (cube.c). */
void mu_ibl_from_cube(const mu_ibl_image *cube, mu_ibl_image *to);

/* Images of a size halved and rounded down until it is 1 x 1, as mip maps have it, each the average of the one before. */
typedef struct mu_ibl_pyramid {
    size_t levels;
    mu_ibl_image level[MU_IBL_LEVELS_MOST];
} mu_ibl_pyramid;

/* Floats that a pyramid of that size takes in all; and its images laid out in such memory, not filled. */
size_t mu_ibl_pyramid_floats(size_t width, size_t height);
void mu_ibl_pyramid_lay(mu_ibl_pyramid *pyramid, size_t width, size_t height, float *memory);

/* Bilinear in two levels, and linear between them; `level` from 0 to levels - 1. */
void mu_ibl_lookup(const mu_ibl_pyramid *pyramid, const float direction[3], float level, float rgb[3]);

/* One of the directions that a lobe is sampled in: towards `local`, in a frame whose z is the lobe's middle. */
typedef struct mu_ibl_tap {
    float local[3], weight, level;
} mu_ibl_tap;

/* The taps of the kernel of roughness alpha > 0 (Karis 2013: the normal and the view along the lobe's middle; weighted by the
 * cosine), on a pyramid whose largest image has `height` rows: half vectors from GGX's D cos at `count` Hammersley points, each
 * looked up at the level whose pixels are as large as its share of the sphere (Krivanek and Colbert 2008). Weights sum to 1.
 * Returns how many there are: those that reflect above the horizon. */
size_t mu_ibl_taps(float alpha, size_t count, size_t height, size_t levels, mu_ibl_tap *taps);

/* Row `row` of an image filtered by them. Any thread may do any row. */
void mu_ibl_filter_row(const mu_ibl_pyramid *pyramid, size_t taps, const mu_ibl_tap *tap, size_t row,
                       mu_ibl_image *out);

#endif
