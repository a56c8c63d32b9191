/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * render.h: fills a film with samples, on many threads, in passes.
 *
 * A pass brings every pixel to the same number of samples; between passes the stopping rules are asked.
 * Threads claim tiles and add samples to a pixel in the order of their index, so the film depends neither on
 * the number of threads nor on where a render was interrupted. Under a time limit it depends on how far the
 * machine got.
 */
#ifndef MU_RENDER_H
#define MU_RENDER_H

#include "core/render/film.h"
#include "core/render/integrator.h"

/* [any] One sample of each of up to MU_PACKET pixels: what mu_integrator_row is, with a context of the caller's. */
typedef void (*mu_sample_function)(const void *context, uint64_t seed, uint32_t x, uint32_t y, uint32_t count,
                                   uint32_t sample, void *scratch, mu_radiance *out);

#define MU_MOST_SAMPLES (1u << 24) /* per pixel */

typedef struct mu_render_plan {
    mu_sample_function sample;
    const void *context;
    size_t scratch; /* bytes per thread, aligned to 64 */
    uint64_t seed;
    uint32_t threads; /* at least 1 */
    uint32_t samples; /* stop at this many per pixel, at most MU_MOST_SAMPLES */
    double seconds;   /* stop before this much time has passed, but not before the first pass; 0: no limit */
    double noise;     /* stop when mu_film_noise falls to this, from 16 samples on; 0: no limit */
} mu_render_plan;

typedef struct mu_render_status {
    double seconds;   /* of this run */
    double fraction;  /* done, in [0, 1], an estimate unless `samples` alone limits */
    double remaining; /* seconds, an estimate; negative: unknown */
    uint32_t samples; /* per pixel, all of them */
    double noise;     /* at the last pass; negative: not known yet */
    double rays_per_second;
} mu_render_status;

/* Called on the thread that called mu_render. While `checkpoint` runs the film rests and may be saved. */
typedef struct mu_render_watch {
    void *context;
    /* Before the first sample, of an environment that is filtered in advance: so many of all materials are done; may be NULL. */
    void (*prepare)(void *context, uint32_t done, uint32_t count);
    _Bool (*stop)(void *context);                                  /* polled every 50 ms; may be NULL */
    void (*report)(void *context, const mu_render_status *status); /* every 100 ms; may be NULL */
    void (*checkpoint)(void *context, const mu_film *film);        /* may be NULL */
    double
        checkpoint_seconds; /* from one to the next; stretched so that saving takes 2 % of the time at most */
} mu_render_watch;

typedef enum mu_render_end { MU_RENDER_FAILED, MU_RENDER_STOPPED, MU_RENDER_DONE } mu_render_end;

/* Goes on from the samples that are in the film already. Stopped: some pixels may have one pass more than
 * others. */
mu_render_end mu_render(mu_film *film, const mu_render_plan *plan, const mu_render_watch *watch,
                        mu_error *error);

/* The number of samples at which the pass after `samples` ends. */
uint32_t mu_render_next(uint32_t samples);

#endif
