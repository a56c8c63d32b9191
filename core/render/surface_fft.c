/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * surface_fft.c: real fields forward, times the response, and back.
 *
 * Rows are transformed one by one; then each column goes forward, is multiplied and comes back while it is at hand; then
 * the rows come back. Two dimensions are put together here because kiss_fftndr_alloc of version 131.1.0 fails for all
 * sizes where memory must be aligned, Debian 12's among them.
 */
#include "core/render/surface_fft.h"

#include <kiss_fft.h>
#include <kiss_fftr.h>
#include <stdlib.h>

enum { BLOCK = 8 }; /* columns gathered together: a cache line of modes */

struct mu_fft {
    uint32_t n;
    kiss_fftr_cfg row_forward, row_back;
    kiss_fft_cfg forward, back;
    kiss_fft_cpx *modes;   /* n x (n/2 + 1) */
    kiss_fft_cpx *columns; /* (BLOCK + 1) x n, the last one the transform's */
};

mu_fft *mu_fft_make(uint32_t n) {
    mu_fft *fft = calloc(1, sizeof *fft);
    if (!fft) return NULL;
    fft->n = n;
    fft->row_forward = kiss_fftr_alloc((int)n, 0, NULL, NULL);
    fft->row_back = kiss_fftr_alloc((int)n, 1, NULL, NULL);
    fft->forward = kiss_fft_alloc((int)n, 0, NULL, NULL);
    fft->back = kiss_fft_alloc((int)n, 1, NULL, NULL);
    fft->modes = malloc((size_t)n * (n / 2 + 1) * sizeof *fft->modes);
    fft->columns = malloc((size_t)n * (BLOCK + 1) * sizeof *fft->columns);
    if (fft->row_forward && fft->row_back && fft->forward && fft->back && fft->modes && fft->columns)
        return fft;
    mu_fft_free(fft);
    return NULL;
}

void mu_fft_free(mu_fft *fft) {
    if (!fft) return;
    kiss_fft_free(fft->row_forward);
    kiss_fft_free(fft->row_back);
    kiss_fft_free(fft->forward);
    kiss_fft_free(fft->back);
    free(fft->modes);
    free(fft->columns);
    free(fft);
}

static _Bool apply(void *context, float *field, uint32_t n,
                   double (*response)(const void *state, uint32_t a, uint32_t b), const void *state) {
    mu_fft *fft = context;
    if (n != fft->n) return 0;
    const uint32_t width = n / 2 + 1;
    const double unit = 1 / ((double)n * n); /* neither direction divides */
    kiss_fft_cpx *const moved = fft->columns + (size_t)BLOCK * n;
    for (size_t a = 0; a < n; a++) kiss_fftr(fft->row_forward, field + a * n, fft->modes + a * width);
    for (uint32_t b0 = 0; b0 < width; b0 += BLOCK) {
        const uint32_t count = width - b0 < BLOCK ? width - b0 : BLOCK;
        for (size_t a = 0; a < n; a++)
            for (uint32_t b = 0; b < count; b++)
                fft->columns[(size_t)b * n + a] = fft->modes[a * width + b0 + b];
        for (uint32_t b = 0; b < count; b++) {
            kiss_fft_cpx *const column = fft->columns + (size_t)b * n;
            kiss_fft(fft->forward, column, moved);
            for (uint32_t a = 0; a < n; a++) {
                const float factor = (float)(unit * response(state, a, b0 + b));
                moved[a].r *= factor;
                moved[a].i *= factor;
            }
            kiss_fft(fft->back, moved, column);
        }
        for (size_t a = 0; a < n; a++)
            for (uint32_t b = 0; b < count; b++)
                fft->modes[a * width + b0 + b] = fft->columns[(size_t)b * n + a];
    }
    for (size_t a = 0; a < n; a++) kiss_fftri(fft->row_back, fft->modes + a * width, field + a * n);
    return 1;
}

mu_spectral mu_fft_spectral(mu_fft *fft) {
    return (mu_spectral){apply, fft};
}
