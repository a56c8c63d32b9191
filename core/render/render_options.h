/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* render_options.h: what the command line of `musurf render` asks for. */
#ifndef MU_RENDER_OPTIONS_H
#define MU_RENDER_OPTIONS_H

#include "core/render/options.h"

#define MU_READS_AUTO UINT64_MAX

typedef struct mu_render_options {
    const char *scene, *output, *png; /* borrowed from argv; output and png may be NULL */
    uint64_t samples;                 /* 0: not given */
    double seconds, noise;            /* 0: not given */
    uint32_t threads;
    uint32_t width, height; /* 0: not given */
    uint64_t seed, reads;             /* reads 0: not given; MU_READS_AUTO: as many as the lobe needs */
    int integrator;                   /* of mu_integrators; -1: not given */
    long long frame;                  /* MU_NO_FRAME: not given */
    double pose_time;                 /* -1: not given */
    _Bool seed_given, resume, explain, quiet;
    enum { MU_PROGRESS_AUTO, MU_PROGRESS_JSON, MU_PROGRESS_NONE } progress;
} mu_render_options;

extern const mu_usage mu_render_usage;

/* False: `exit` is the code to leave with, and whatever was to be said has been said. */
_Bool mu_render_options_read(mu_render_options *options, int argc, char **argv, int *exit);

/* --size and --progress, for other commands that render. False after a line on stderr. */
_Bool mu_render_size(const mu_options *given, uint32_t *width, uint32_t *height);
_Bool mu_render_progress(const mu_options *given, mu_render_options *options);

#endif
