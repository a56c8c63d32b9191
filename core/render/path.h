/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * path.h: the path tracer behind integrator.h, with what only comparisons need to choose.
 *
 * At each scattering event a light (direct.h) and the BSDF are both sampled; the two are combined by the power heuristic
 * of Veach, "Robust Monte Carlo methods for light transport simulation", 1997, section 9.2.4.
 */
#ifndef MU_PATH_H
#define MU_PATH_H

#include "core/render/integrator.h"
#include "core/render/random.h"

typedef struct mu_path_options { /* all zero: what mu_integrator_row does by default */
    enum { MU_BOTH, MU_BSDF_ONLY, MU_LIGHT_ONLY } strategy;
    _Bool independent; /* random numbers without stratification */
} mu_path_options;

/* The camera ray through pixel (x, y), counted from the top left, spread by the film's filter; u in [0,1)^2.
 */
mu_ray mu_camera_ray(const mu_camera *camera, const mu_film_settings *film, uint32_t x, uint32_t y,
                     const float u[2]);

/* One sample of one pixel. */
void mu_path_pixel(const mu_tracer *tracer, const mu_path_options *options, uint64_t seed, uint32_t x,
                   uint32_t y, uint32_t sample, void *scratch, mu_radiance *out);
/* mu_integrator_row with options. */
void mu_path_row(const mu_tracer *tracer, const mu_path_options *options, uint64_t seed, uint32_t x,
                 uint32_t y, uint32_t count, uint32_t sample, void *scratch, mu_radiance *out);

#endif
