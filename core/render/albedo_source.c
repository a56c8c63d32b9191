/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* albedo_source.c: see albedo_source.h. */
#include "core/render/albedo_source.h"

#include <stddef.h>

static void toward(void *context, const double wi[3], double rgb[EVEN_PARTS]) {
    const mu_albedo_bound *b = context;
    musurf_value value;
    b->type->eval(b->closure, (const float[3]){(float)wi[0], (float)wi[1], (float)wi[2]}, MUSURF_ALL_LOBES, &value);
    for (int c = 0; c < 3; c++) rgb[c] = value.lobes ? (double)value.f[c] : 0;
}

static void drawn(void *context, const double u[3], double rgb[3]) {
    const mu_albedo_bound *b = context;
    musurf_sample s;
    b->type->sample(b->closure, (const float[3]){(float)u[0], (float)u[1], (float)u[2]}, MUSURF_ALL_LOBES, &s);
    for (int c = 0; c < 3; c++) rgb[c] = s.lobe ? (double)s.weight[c] : 0;
}

/* An albedo may be off by 1e-3. Of 49 histograms, each at its worst of 143 views, 2 enough (2e-4) left 3e-4 in the median and 7e-4 at
 * most (cells.c), in two thirds of the time that 1e-4 takes. */
static _Bool known(void *context, double enough, double rgb[3]) {
    const mu_albedo_bound *b = context;
    return b->slopes->albedo(b->closure, 2 * enough, rgb) != 0;
}

/* Lobes of a smaller alpha are asked by samples, whose weights hardly differ there. A direction in float is rounded by up to 2^-25, that
 * over alpha of the lobe, and f is off by twice that or more, at random: by 6e-4 and more here, by 1e-4 in the mean of some hundred. */
#define LEAST_ALPHA 1e-4

mu_even_source mu_albedo_source(mu_albedo_bound *bound, const mu_ibl_lobe_d *lobe) {
    const musurf_slopes *s = bound->slopes;
    const _Bool tells = s && s->size > offsetof(musurf_slopes, albedo) && s->albedo;
    const _Bool resolved = lobe->sigma[1] * 1.41421356237309505 >= LEAST_ALPHA;
    return (mu_even_source){.context = bound, .toward = toward, .drawn = drawn, .lobe = resolved ? lobe : NULL, .known = tells ? known : NULL};
}
