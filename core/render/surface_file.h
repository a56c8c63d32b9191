/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * surface_file.h: heightfields as musurf writes them: one-channel float EXR, periodic, cell size 1; scanline i is x, pixel j
 * in it is y. By the rule of output.h. They are read by surface_source.h; what has
 * another form is brought into this one by `musurf surface read`.
 */
#ifndef MU_SURFACE_FILE_H
#define MU_SURFACE_FILE_H

#include <stdint.h>

#include "core/render/error.h"
#include "core/surface/generate.h"

/* What the header says of how a surface was made. */
typedef struct mu_surface_info {
    const mu_recipe *recipe; /* NULL: it was read from another file */
    const char *command;
    uint32_t passes;
    double deviation[2]; /* of L and U: relative rms of the masses of 20 equal bins */
    double steepest;     /* slope */
    _Bool open;          /* it does not repeat (surface_source.h) */
} mu_surface_info;

_Bool mu_surface_write(const char *file, const mu_heightfield *f, const mu_surface_info *info,
                       mu_error *error);

#endif
