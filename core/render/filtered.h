/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * filtered.h: the light around a scene (environment, studio or constant) filtered for every roughness, in memory: a chain of
 * squares (core/ibl/globe.h) in world space, the light's turn and scale included. Level l of n is for alpha_lin = l / (n - 1).
 */
#ifndef MU_FILTERED_H
#define MU_FILTERED_H

#include "core/ibl/globe.h"
#include "core/render/light.h"

/* What a chain for these lights takes. */
size_t mu_filtered_levels(const mu_lights *lights);
size_t mu_filtered_bytes(const mu_lights *lights);

/* The chain's memory, to be freed; NULL on failure. */
float *mu_filtered_make(mu_ibl_globe *globe, const mu_lights *lights, uint32_t threads, mu_error *error);

#endif
