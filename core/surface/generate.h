/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * generate.h: periodic heightfields whose facets follow any isotropic slope distribution.
 *
 * It starts with a Gaussian random field of autocorrelation exp(-r^2/correlation^2). Each pass sorts the facets of
 * either family, L and U, by steepness, gives the k-th flattest the k-th quantile of the wanted law, its direction
 * kept but for a linear map that makes all directions together isotropic, and asks for the heights whose slopes come
 * closest to those wishes in the sense of least squares: a difference of two heights is shared by one L and one U
 * facet, so it is given the mean of what they wish, and a Poisson equation, solved by FFT, makes heights of the
 * differences. Passes overshoot by 1.7 (successive over-relaxation), which takes them half as many. Fitting both
 * families matters: if only L are fitted, U stay 1.5 % rms off the wanted masses at n = 256 for ever.
 *
 * No slope exceeds the quantile `clip` of the law: wishes are capped, a little lower if the projection overshoots.
 */
#ifndef MU_GENERATE_H
#define MU_GENERATE_H

#include "core/surface/heightfield.h"
#include "core/surface/quantile.h"

typedef struct mu_recipe {
    mu_slope_law law;
    uint32_t n;         /* even, 8 to 16384 */
    double correlation; /* in cells, > 0 */
    uint64_t seed;
    double clip; /* 0 < clip < 1 */
} mu_recipe;

/*
 * The FFT, which the caller brings: multiplies the field's discrete Fourier transform at (a, b), 0 <= a < n,
 * 0 <= b <= n/2 (the rest follows, the field being real), by response(state, a, b), in place. False if it could not.
 */
typedef _Bool (*mu_spectral_response)(void *context, float *field, uint32_t n,
                                      double (*response)(const void *state, uint32_t a, uint32_t b),
                                      const void *state);
typedef struct mu_spectral {
    mu_spectral_response apply;
    void *context;
} mu_spectral;

typedef struct mu_generator mu_generator;

/* NULL: out of memory (some 45 bytes per cell are asked for). The recipe is believed. */
mu_generator *mu_generator_make(const mu_recipe *recipe);
void mu_generator_free(mu_generator *generator);
/* The Gaussian field, its steepness the law's. False if the FFT failed. */
_Bool mu_generator_start(mu_generator *generator, const mu_spectral *fft);
_Bool mu_generator_pass(mu_generator *generator, const mu_spectral *fft);
/* Heights as they stand, each a float exactly; the steepest slope among them over the quantile `clip`. */
mu_heightfield mu_generator_surface(const mu_generator *generator);
double mu_generator_steepest(const mu_generator *generator);

#endif
