/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* surface_fft.h: the FFT that making surfaces asks for, by KISS FFT in single precision. */
#ifndef MU_SURFACE_FFT_H
#define MU_SURFACE_FFT_H

#include "core/surface/generate.h"

typedef struct mu_fft mu_fft;

/* For n x n fields, n even. NULL: out of memory. */
mu_fft *mu_fft_make(uint32_t n);
void mu_fft_free(mu_fft *fft);
mu_spectral mu_fft_spectral(mu_fft *fft);

#endif
