/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surroundings.c: see surroundings.h. Built as core/render/filtered.c does it, from formulas instead of a file. */
#include "scripts/page/surroundings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/render/light_parts.h"
#include "scripts/page/material.h"

enum { FINE = 2 };

typedef void radiance(const float w[3], float rgb[3]);

static void studio(const float w[3], float rgb[3]) {
    mu_studio_radiance(mu_v3(w[0], w[1], w[2]), rgb);
}

/* A clear evening: blue above, warm at the horizon, a sun of 4 degrees, 30 degrees up at azimuth -60, over dark
 * ground. */
static void sky(const float w[3], float rgb[3]) {
    static const float zenith[3] = {0.10f, 0.22f, 0.50f}, horizon[3] = {0.95f, 0.80f, 0.62f},
                       ground[3] = {0.09f, 0.075f, 0.06f}, sun[3] = {0.43301270f, -0.75f, 0.5f};
    const float up = sqrtf(fmaxf(w[2], 0)), edge = fminf(fmaxf(w[2] * 40 + 0.5f, 0), 1);
    const float to_sun = w[0] * sun[0] + w[1] * sun[1] + w[2] * sun[2];
    const float glow = expf(12 * (to_sun - 1)), disc = fminf(fmaxf((to_sun - 0.99756f) / 0.0006f, 0), 1);
    const float warm[3] = {90 * disc + 1.3f * glow, 78 * disc + 0.85f * glow, 56 * disc + 0.4f * glow};
    for (int c = 0; c < 3; c++)
        rgb[c] = (1 - edge) * ground[c] + edge * (horizon[c] + (zenith[c] - horizon[c]) * up + warm[c]);
}

/* Round lamps of 3 degrees every 30 degrees of azimuth and elevation in the dark: each shows the lobe. */
static void lamps(const float w[3], float rgb[3]) {
    const float step = 0.52359878f, elevation = asinf(fminf(fmaxf(w[2], -1), 1)),
                azimuth = atan2f(w[1], w[0]);
    const float e = step * roundf(elevation / step), a = step * roundf(azimuth / step);
    const float near = cosf(e) * (cosf(a) * w[0] + sinf(a) * w[1]) + sinf(e) * w[2];
    const float lit = fminf(fmaxf((near - 0.99863f) / 0.0006f, 0), 1), hue = 2 * a;
    for (int c = 0; c < 3; c++) rgb[c] = 0.02f + lit * (14 + 6 * cosf(hue - 2.0943951f * (float)c));
}

/* Even light: what comes back is the directional albedo. */
static void even(const float w[3], float rgb[3]) {
    (void)w;
    rgb[0] = rgb[1] = rgb[2] = 0.8f;
}

static radiance *const kinds[] = {studio, sky, lamps, even};
const char *page_surroundings_name(int kind) {
    static const char *const names[] = {"studio", "sky", "lamps", "even", NULL};
    return names[kind];
}

/* Each texel the mean of FINE² directions. */
static void fill(mu_ibl_square *to, radiance *of) {
    for (size_t row = 0; row < to->side; row++)
        for (size_t column = 0; column < to->side; column++) {
            float *const texel = mu_ibl_texel(to, row, column);
            for (int c = 0; c < 4; c++) texel[c] = 0;
            for (size_t k = 0; k < FINE * FINE; k++) {
                float w[3], rgb[3];
                mu_ibl_globe_direction(((float)column + ((float)(k % FINE) + 0.5f) / FINE) / (float)to->side,
                                       ((float)row + ((float)(k / FINE) + 0.5f) / FINE) / (float)to->side, w);
                of(w, rgb);
                for (int c = 0; c < 3; c++) texel[c] += rgb[c] / (FINE * FINE);
            }
        }
    mu_ibl_globe_border(to);
}

static void filter(mu_ibl_globe *globe, const mu_ibl_globe *from) {
    mu_ibl_tap taps[MU_IBL_CHAIN_TAPS];
    const size_t rows = (size_t)lround((double)from->level[0].side * sqrt(3.14159265358979323846) / 2);
    for (size_t l = 1; l < globe->levels; l++) {
        const double linear = (double)l / (double)(globe->levels - 1);
        const size_t count = mu_ibl_taps((float)(linear * linear), mu_ibl_chain_taps(l), rows, from->levels, taps);
        for (size_t row = 0; row < globe->level[l].side; row++)
            mu_ibl_globe_filter_row(from, count, taps, row, &globe->level[l]);
        mu_ibl_globe_border(&globe->level[l]);
    }
}

page_surroundings *page_surroundings_new(int kind, int size) {
    const size_t side = (size_t)size;
    size_t sides[MU_IBL_LEVELS_MOST], half[MU_IBL_LEVELS_MOST], halves = 0;
    const size_t levels = mu_ibl_chain_sides(side, sides);
    for (; side >> halves >= 4; halves++) half[halves] = side >> halves;
    page_surroundings *s = calloc(1, sizeof *s);
    float *sharp = aligned_alloc(16, mu_ibl_globe_floats(halves, half) * sizeof *sharp);
    if (s) s->memory = aligned_alloc(16, mu_ibl_globe_floats(levels, sides) * sizeof *s->memory);
    if (!s || !sharp || !s->memory) {
        free(sharp);
        if (s) free(s->memory);
        free(s);
        return NULL;
    }
    mu_ibl_globe from;
    mu_ibl_globe_lay(&s->globe, levels, sides, s->memory);
    mu_ibl_globe_lay(&from, halves, half, sharp);
    fill(&from.level[0], kinds[kind]);
    for (size_t l = 1; l < halves; l++) mu_ibl_globe_halve(&from.level[l - 1], &from.level[l]);
    memcpy(s->memory, sharp, 4 * (side + 2) * (side + 2) * sizeof *sharp);
    filter(&s->globe, &from);
    free(sharp);
    return s;
}

void page_surroundings_free(page_surroundings *s) {
    if (!s) return;
    free(s->memory);
    free(s);
}
