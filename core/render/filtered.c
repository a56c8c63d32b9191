/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * filtered.c: by filtered importance sampling (prefilter.h) from a chain of halves.
 *
 * The sharpest square has twice as many texels a side as the image has rows, whose solid angles then are 0.2 to 1 of a
 * pixel's at the horizon. It has log2 of that and half as many levels again: between two of the sharpest, whose texels are larger
 * than the lobe, reads interpolate worst. Each is as coarse as its lobe allows: a texel, (4 pi)^1/2 / side wide at the mean, is FINENESS
 * of its alpha at most, an eighth to a quarter of the lobe's width (2 alpha to either side), and there are 32 at least. What is small stays in the
 * processor's caches, where most of a read's time goes.
 *
 * A lobe of few texels needs few taps; of the others some are needed, or lamps that are a pixel small leave a pattern.
 */
#include "core/render/filtered.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/surface_rows.h"

enum { LEAST = 32, MOST = 1024, FINE = 2 };
#define FINENESS 0.8
static const size_t taps_of[] = {0, 96, 192, 384}; /* of levels; of all beyond: the last */
enum { TAPS = 384 };

static size_t side_of(const mu_lights *lights) {
    size_t side = LEAST;
    while (side < MOST && side < 2 * (size_t)mu_lights_rows(lights)) side *= 2;
    return side;
}

/* log2 of a power of two */
static size_t exponent(size_t side) {
    size_t n = 0;
    while (side >> (n + 1)) n++;
    return n;
}

size_t mu_filtered_levels(const mu_lights *lights) {
    return exponent(side_of(lights)) * 3 / 2 + 1;
}

/* Sides of the levels of a chain that starts with `side`. */
static void sides_of(size_t side, size_t levels, size_t sides[MU_IBL_LEVELS_MOST]) {
    const double whole = sqrt(4 * 3.14159265358979323846);
    for (size_t l = 0; l < levels; l++) {
        const double linear = (double)l / (double)(levels - 1);
        sides[l] = l ? LEAST : side;
        while (l && sides[l] < side && (double)sides[l] * FINENESS * linear * linear < whole) sides[l] *= 2;
    }
}

size_t mu_filtered_bytes(const mu_lights *lights) {
    size_t sides[MU_IBL_LEVELS_MOST];
    const size_t levels = mu_filtered_levels(lights);
    sides_of(side_of(lights), levels, sides);
    return sizeof(float) * mu_ibl_globe_floats(levels, sides);
}

typedef struct level_work {
    const mu_lights *lights;
    const mu_ibl_globe *from;
    const mu_ibl_tap *tap;
    size_t taps;
    mu_ibl_square *to;
} level_work;

/* [any] Each texel the mean of FINE² directions. */
static void fill_row(void *context, uint32_t row) {
    const level_work *w = context;
    const float side = (float)w->to->side;
    for (size_t column = 0; column < w->to->side; column++) {
        float *const texel = mu_ibl_texel(w->to, row, column);
        memset(texel, 0, 4 * sizeof *texel);
        for (size_t k = 0; k < FINE * FINE; k++) {
            float direction[3], rgb[3], pdf;
            mu_ibl_globe_direction(((float)column + ((float)(k % FINE) + 0.5f) / FINE) / side,
                                   ((float)row + ((float)(k / FINE) + 0.5f) / FINE) / side, direction);
            mu_lights_escaped(w->lights, mu_v3(direction[0], direction[1], direction[2]), rgb, &pdf);
            for (size_t c = 0; c < 3; c++) texel[c] += rgb[c] / (FINE * FINE);
        }
    }
}

/* [any] */
static void filter_row(void *context, uint32_t row) {
    const level_work *w = context;
    mu_ibl_globe_filter_row(w->from, w->taps, w->tap, row, w->to);
}

static void filter(mu_ibl_globe *globe, const mu_ibl_globe *from, uint32_t threads) {
    mu_ibl_tap taps[TAPS];
    const size_t side = from->level[0].side;
    /* rows of a latitude-longitude image whose pixels are as large: those of (pi / rows)² are 4 pi / side² */
    const size_t rows = (size_t)lround((double)side * sqrt(3.14159265358979323846) / 2);
    for (size_t l = 1; l < globe->levels; l++) {
        const double linear = (double)l / (double)(globe->levels - 1);
        level_work w = {.from = from, .tap = taps, .to = &globe->level[l]};
        const size_t most = sizeof taps_of / sizeof taps_of[0] - 1;
        w.taps = mu_ibl_taps((float)(linear * linear), taps_of[l < most ? l : most], rows, from->levels, taps);
        mu_rows((uint32_t)w.to->side, threads, filter_row, &w);
        mu_ibl_globe_border(w.to);
    }
}

float *mu_filtered_make(mu_ibl_globe *globe, const mu_lights *lights, uint32_t threads, mu_error *error) {
    const size_t side = side_of(lights), levels = mu_filtered_levels(lights), halves = exponent(side) - 1;
    size_t sides[MU_IBL_LEVELS_MOST], half[MU_IBL_LEVELS_MOST];
    sides_of(side, levels, sides);
    for (size_t l = 0; l < halves; l++) half[l] = side >> l;
    const size_t floats = mu_ibl_globe_floats(levels, sides);
    /* rounded up: aligned memory comes in multiples of its alignment */
    float *memory = aligned_alloc(64, (floats * sizeof *memory + 63) / 64 * 64);
    float *sharp = malloc(mu_ibl_globe_floats(halves, half) * sizeof *sharp);
    if (memory && sharp) {
        mu_ibl_globe from;
        mu_ibl_globe_lay(globe, levels, sides, memory);
        mu_ibl_globe_lay(&from, halves, half, sharp);
        level_work w = {.lights = lights, .to = &from.level[0]};
        mu_rows((uint32_t)side, threads, fill_row, &w);
        mu_ibl_globe_border(&from.level[0]);
        for (size_t l = 1; l < halves; l++) mu_ibl_globe_halve(&from.level[l - 1], &from.level[l]);
        memcpy(memory, sharp, 4 * (side + 2) * (side + 2) * sizeof *memory);
        filter(globe, &from, threads);
    } else {
        mu_fail(error, "not enough memory for a filtered environment");
        free(memory);
        memory = NULL;
    }
    free(sharp);
    return memory;
}
