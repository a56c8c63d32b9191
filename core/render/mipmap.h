/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * mipmap.h: numbers over the texture square, several per texel, averaged over any parallelogram of texture coordinates.
 *
 * Levels are made once, by area (Williams 1983, "Pyramidal parametrics"), from the finest, whatever a file has besides:
 * what is averaged is not what the file holds, but what averages (covariance.h). A look-up goes along the longer axis of
 * the parallelogram's ellipse (as Feline does: McCormack et al. 1999) in trilinear probes. It allocates, locks and reads
 * nothing, and equal texels give exactly their value.
 *
 * The first row of texels is the top of the picture, at v = 1.
 */
#ifndef MU_MIPMAP_H
#define MU_MIPMAP_H

#include <stddef.h>
#include <stdint.h>

enum { MU_MIPMAP_CHANNELS = 8, MU_MIPMAP_LEVELS = 32 };

typedef enum mu_wrap { MU_WRAP_REPEAT, MU_WRAP_CLAMP, MU_WRAP_MIRROR } mu_wrap;

typedef struct mu_mipmap {
    int channels, levels;
    mu_wrap wrap;
    struct {
        int width, height;
        size_t at; /* of its first number in texels */
    } level[MU_MIPMAP_LEVELS];
    float *texels;
} mu_mipmap;

/* Room for `width` x `height` texels, to be filled from texels[0] on, row by row; false without memory. */
_Bool mu_mipmap_make(mu_mipmap *mipmap, int width, int height, int channels, mu_wrap wrap);
/* The other levels, once the finest is filled. */
void mu_mipmap_build(mu_mipmap *mipmap);
void mu_mipmap_free(mu_mipmap *mipmap);
size_t mu_mipmap_bytes(const mu_mipmap *mipmap);

/* One of the numbers of each texel may say how much the texel's part of the picture varies. */
typedef struct mu_mipmap_limit {
    int channel;
    double most; /* that may be averaged */
} mu_mipmap_limit;

/* [any] The mean over the parallelogram of these two half-axes about (u, v), all of the picture where they are not
 * finite; NULL: the finest level, between its texels. limit, or NULL: where a texel as large as the parallelogram varies by
 * more, the mean about (u, v) of as much as does not. */
void mu_mipmap_at(const mu_mipmap *mipmap, const double uv[2], const double axes[4],
                  const mu_mipmap_limit *limit, double *out);

#endif
