/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * surface_file.h: heightfields as files: one-channel float EXR, n x n, periodic, cell size 1; scanline i is x, pixel j
 * in it is y. Written by the rule of output.h; read strictly.
 */
#ifndef MU_SURFACE_FILE_H
#define MU_SURFACE_FILE_H

#include <stdint.h>

#include "core/render/error.h"
#include "core/surface/generate.h"

enum { MU_SURFACE_LEAST = 2, MU_SURFACE_MOST = 16384 };

/* What the header says of how a surface was made. */
typedef struct mu_surface_info {
    const mu_recipe *recipe;
    const char *command;
    uint32_t passes;
    double deviation[2]; /* of L and U: relative rms of the masses of 20 equal bins */
    double steepest;     /* slope */
} mu_surface_info;

_Bool mu_surface_write(const char *file, const mu_heightfield *f, const mu_surface_info *info,
                       mu_error *error);
/* Heights in malloc'ed memory, all finite; NULL after an error. */
double *mu_surface_read(const char *file, uint32_t *n, mu_error *error);

#endif
