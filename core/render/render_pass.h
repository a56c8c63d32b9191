/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* render_pass.h: the threads that bring every pixel of a film to a given number of samples. Used by render.c.
 */
#ifndef MU_RENDER_PASS_H
#define MU_RENDER_PASS_H

#include <pthread.h>
#include <stdatomic.h>

#include "core/render/render.h"

typedef struct mu_worker {
    struct mu_pass *pass;
    pthread_t thread;
    void *scratch;
} mu_worker;

typedef struct mu_pass {
    const mu_render_plan *plan;
    mu_film *film; /* a thread writes only to the pixels of the tile that it has claimed */
    uint32_t target;
    mu_worker *workers; /* plan->threads of them */
    uint32_t started;
    atomic_uint_fast64_t tile;                   /* the next to be claimed */
    atomic_uint_fast64_t samples, rays, refused; /* since mu_pass_make */
    atomic_bool halt;
    pthread_mutex_t lock;
    pthread_cond_t change;
    uint32_t working; /* under lock */
} mu_pass;

_Bool mu_pass_make(mu_pass *pass, mu_film *film, const mu_render_plan *plan, mu_error *error);
void mu_pass_free(mu_pass *pass);
/* Starts as many threads as it can get, up to the plan's; fails only if there is none. */
_Bool mu_pass_start(mu_pass *pass, uint32_t target, mu_error *error);
/* Waits at most `seconds` for the end of the work; true if all tiles are done or the threads were halted. */
_Bool mu_pass_wait(mu_pass *pass, double seconds);
/* Makes the threads leave after the pixel they are at. */
void mu_pass_halt(mu_pass *pass);
/* Joins the threads; the film rests. */
void mu_pass_end(mu_pass *pass);

#endif
