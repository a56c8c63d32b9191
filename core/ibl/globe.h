/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * globe.h: radiance from all directions as a chain of squares, each the sphere by way of an octahedron. In float.
 *
 * A direction w goes to w / (|x| + |y| + |z|), whose x, y fill a square: its inner half from above, what is folded over
 * the diagonals from below (Praun and Hoppe 2003, "Spherical parametrization and remeshing"). A look-up takes neither
 * sines nor arctangents, and no pole crowds. Squares have a border of one texel that repeats what lies across the edge, so
 * that bilinear reads need to know nothing of it. Texels are four floats, the last unused.
 */
#ifndef MU_IBL_GLOBE_H
#define MU_IBL_GLOBE_H

#include "core/ibl/prefilter.h"

typedef struct mu_ibl_square {
    size_t side;
    float *texels; /* (side + 2)² */
} mu_ibl_square;

typedef struct mu_ibl_globe {
    size_t levels;
    mu_ibl_square level[MU_IBL_LEVELS_MOST];
} mu_ibl_globe;

/* Squares of these sides, powers of two: floats that they take, and laid out in such memory (aligned to 16). */
size_t mu_ibl_globe_floats(size_t levels, const size_t *sides);
void mu_ibl_globe_lay(mu_ibl_globe *globe, size_t levels, const size_t *sides, float *memory);

/* The chain that reads are made of, from a square of the side `side`, a power of two of MU_IBL_CHAIN_LEAST or more: how many levels,
 * their sides, and how many taps level l >= 1 is worth, MU_IBL_CHAIN_TAPS at most. */
enum { MU_IBL_CHAIN_LEAST = 32, MU_IBL_CHAIN_TAPS = 384 };
size_t mu_ibl_chain_sides(size_t side, size_t sides[MU_IBL_LEVELS_MOST]);
size_t mu_ibl_chain_taps(size_t level);

/* The texel in a row and column; the direction of place (x, y) in [0, 1]². */
static inline float *mu_ibl_texel(const mu_ibl_square *square, size_t row, size_t column) {
    return square->texels + 4 * ((row + 1) * (square->side + 2) + column + 1);
}
void mu_ibl_globe_direction(float x, float y, float direction[3]);

/* Once all texels of a square are set. */
void mu_ibl_globe_border(mu_ibl_square *square);
/* `to` becomes the mean of `from`, of twice its side, by solid angle. */
void mu_ibl_globe_halve(const mu_ibl_square *from, mu_ibl_square *to);
/* A row of `to` becomes what the taps (prefilter.h) see in `from`. */
void mu_ibl_globe_filter_row(const mu_ibl_globe *from, size_t taps, const mu_ibl_tap *tap, size_t row,
                             mu_ibl_square *to);

/* Trilinear: adds the radiance from a direction, not necessarily a unit vector, times `weight` to rgb. `level` from 0 to
 * levels - 1. */
void mu_ibl_globe_add(const mu_ibl_globe *globe, const float direction[3], float level, float weight,
                      float rgb[4]);

/* The same of many; at most MU_IBL_BATCH of them. Where they look is worked out for several at a time. */
enum { MU_IBL_BATCH = 64 };
typedef struct mu_ibl_batch {
    size_t count;
    float x[MU_IBL_BATCH], y[MU_IBL_BATCH], z[MU_IBL_BATCH], level[MU_IBL_BATCH], weight[MU_IBL_BATCH];
} mu_ibl_batch;
void mu_ibl_globe_sum(const mu_ibl_globe *globe, const mu_ibl_batch *batch, float rgb[4]);

#endif
