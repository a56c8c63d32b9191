/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* ibl_prefilter.h: an environment image made the chain of levels that image-based lighting looks up. */
#ifndef MU_IBL_PREFILTER_COMMAND_H
#define MU_IBL_PREFILTER_COMMAND_H

#include <stdint.h>

#include "core/render/error.h"

typedef struct mu_prefilter {
    const char *image, *output;
    uint32_t samples, threads;
    uint32_t height; /* of level 0; less if the image is smaller */
    /* How far it is, now and then, from any thread: rows times their share of the work. NULL: nobody asks. */
    void (*progress)(void *context, double fraction);
    void *context;
} mu_prefilter;

/* Levels that differ in roughness, of a chain of that height: alpha_lin = l / (levels - 1). */
uint32_t mu_prefilter_levels(uint32_t height);

/* Writes `output`, unless it is there and was made from this very image with these settings: *kept says so. */
_Bool mu_prefilter_run(const mu_prefilter *job, _Bool *kept, mu_error *error);

#endif
