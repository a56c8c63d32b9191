/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * povray_run.h: POV-Ray as a program of its own, in a private temporary folder that goes away with it.
 *
 * The program is $POVRAY or else povray on the PATH. SIGINT, SIGTERM and SIGHUP end it and remove the folder; then a run
 * fails with an empty error text, and the signal is left to the caller, unblocked but ignored no longer.
 */
#ifndef MU_POVRAY_RUN_H
#define MU_POVRAY_RUN_H

#include <stdint.h>
#include <stdio.h>

#include "core/render/error.h"

typedef struct mu_povray {
    char folder[4096];
} mu_povray;

/* POV-Ray's own name and version, as "POV-Ray 3.7.0.10"; false with an error if it is not there or does not say. */
_Bool mu_povray_version(char *out, size_t size, mu_error *error);

_Bool mu_povray_begin(mu_povray *run, mu_error *error);
/* The scene to be written, or NULL after an error. Closed by mu_povray_render. */
FILE *mu_povray_scene(const mu_povray *run, mu_error *error);
/* The image as a binary PPM whose values are linear, to be read after its header and closed; or NULL after an error. */
FILE *mu_povray_render(const mu_povray *run, FILE *scene, uint32_t width, uint32_t height, uint32_t threads,
                       mu_error *error);
void mu_povray_end(mu_povray *run);

#endif
