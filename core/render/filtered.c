/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * filtered.c: by filtered importance sampling (prefilter.h) from a chain of halves.
 *
 * The sharpest square has twice as many texels a side as the image has rows, whose solid angles then are 0.2 to 1 of a
 * pixel's at the horizon. The others are those of mu_ibl_chain_sides.
 */
#include "core/render/filtered.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/surface_rows.h"

enum { LEAST = MU_IBL_CHAIN_LEAST, MOST = 1024, FINE = 2 };

static size_t side_of(const mu_lights *lights) {
    size_t side = LEAST;
    while (side < MOST && side < 2 * (size_t)mu_lights_rows(lights)) side *= 2;
    return side;
}

size_t mu_filtered_levels(const mu_lights *lights) {
    size_t sides[MU_IBL_LEVELS_MOST];
    return mu_ibl_chain_sides(side_of(lights), sides);
}

size_t mu_filtered_bytes(const mu_lights *lights) {
    size_t sides[MU_IBL_LEVELS_MOST];
    const size_t levels = mu_ibl_chain_sides(side_of(lights), sides);
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
    mu_ibl_tap taps[MU_IBL_CHAIN_TAPS];
    const size_t side = from->level[0].side;
    /* rows of a latitude-longitude image whose pixels are as large: those of (pi / rows)² are 4 pi / side² */
    const size_t rows = (size_t)lround((double)side * sqrt(3.14159265358979323846) / 2);
    for (size_t l = 1; l < globe->levels; l++) {
        const double linear = (double)l / (double)(globe->levels - 1);
        level_work w = {.from = from, .tap = taps, .to = &globe->level[l]};
        w.taps = mu_ibl_taps((float)(linear * linear), mu_ibl_chain_taps(l), rows, from->levels, taps);
        mu_rows((uint32_t)w.to->side, threads, filter_row, &w);
        mu_ibl_globe_border(w.to);
    }
}

float *mu_filtered_make(mu_ibl_globe *globe, const mu_lights *lights, uint32_t threads, mu_error *error) {
    size_t sides[MU_IBL_LEVELS_MOST], half[MU_IBL_LEVELS_MOST], halves = 0;
    const size_t side = side_of(lights), levels = mu_ibl_chain_sides(side, sides);
    for (; side >> halves >= 4; halves++) half[halves] = side >> halves;
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
