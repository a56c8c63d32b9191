/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * render_pass.c: threads, tiles and the order of samples.
 *
 * A pixel knows how many samples it has and takes the next ones in order, so a pass that was halted is simply
 * started again, and the tiles that were done already cost nothing.
 */
#include "core/render/render_pass.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { TILE = MU_PACKET }; /* pixels along its side: small, so that threads finish a pass together */

_Bool mu_pass_make(mu_pass *pass, mu_film *film, const mu_render_plan *plan, mu_error *error) {
    *pass = (mu_pass){.plan = plan, .film = film};
    pthread_condattr_t steady;
    if (pthread_mutex_init(&pass->lock, NULL)) return mu_fail(error, "out of memory");
    pthread_condattr_init(&steady);
    pthread_condattr_setclock(&steady, CLOCK_MONOTONIC);
    const int code = pthread_cond_init(&pass->change, &steady);
    pthread_condattr_destroy(&steady);
    if (code) {
        pthread_mutex_destroy(&pass->lock);
        return mu_fail(error, "out of memory");
    }
    pass->workers = calloc(plan->threads, sizeof *pass->workers);
    const size_t bytes = ((plan->scratch ? plan->scratch : 1) + 63) / 64 * 64;
    _Bool made = pass->workers != NULL;
    for (uint32_t i = 0; made && i < plan->threads; ++i) {
        pass->workers[i].pass = pass;
        pass->workers[i].scratch = aligned_alloc(64, bytes);
        made = pass->workers[i].scratch != NULL;
    }
    if (made) return 1;
    mu_pass_free(pass);
    return mu_fail(error, "out of memory for %u threads", plan->threads);
}

void mu_pass_free(mu_pass *pass) {
    for (uint32_t i = 0; pass->workers && i < pass->plan->threads; ++i) free(pass->workers[i].scratch);
    free(pass->workers);
    pass->workers = NULL;
    pthread_cond_destroy(&pass->change);
    pthread_mutex_destroy(&pass->lock);
}

typedef struct mu_tally {
    uint64_t samples, rays, refused;
} mu_tally;

/* One more sample for each pixel of a tile's row that lacks one. Pixels with the same number of samples go
 * together, which is all of them, since tiles are left between rows only: the packets are the same in every
 * run. */
static _Bool work_row(mu_pass *pass, uint32_t x, uint32_t x1, uint32_t y, void *scratch, mu_tally *tally) {
    const mu_render_plan *plan = pass->plan;
    mu_pixel *row = &pass->film->pixels[(size_t)y * pass->film->width];
    _Bool worked = 0;
    for (uint32_t count; x < x1; x += count) {
        const uint32_t sample = row[x].samples;
        for (count = 1; x + count < x1 && row[x + count].samples == sample;) ++count;
        if (sample >= pass->target) continue;
        mu_radiance radiance[MU_PACKET] = {{.rgb = {0}}};
        plan->sample(plan->context, plan->seed, x, y, count, sample, scratch, radiance);
        for (uint32_t i = 0; i < count; ++i) {
            tally->refused += (uint64_t)!mu_pixel_add(&row[x + i], &radiance[i]) + radiance[i].refused;
            tally->rays += radiance[i].rays;
        }
        tally->samples += count;
        worked = 1;
    }
    return worked;
}

/* One tile, row by row; leaves between rows when told to. */
static void work_tile(mu_pass *pass, uint64_t tile, void *scratch) {
    const mu_film *film = pass->film;
    const uint64_t across = (film->width + TILE - 1) / TILE;
    const uint32_t x0 = (uint32_t)(tile % across) * TILE, y0 = (uint32_t)(tile / across) * TILE;
    const uint32_t x1 = film->width - x0 < TILE ? film->width : x0 + TILE;
    const uint32_t y1 = film->height - y0 < TILE ? film->height : y0 + TILE;
    mu_tally tally = {0};
    for (uint32_t y = y0; y < y1 && !atomic_load_explicit(&pass->halt, memory_order_relaxed); ++y)
        while (work_row(pass, x0, x1, y, scratch, &tally)) continue;
    atomic_fetch_add_explicit(&pass->samples, tally.samples, memory_order_relaxed);
    atomic_fetch_add_explicit(&pass->rays, tally.rays, memory_order_relaxed);
    atomic_fetch_add_explicit(&pass->refused, tally.refused, memory_order_relaxed);
}

static void *work(void *argument) {
    mu_worker *self = argument;
    mu_pass *pass = self->pass;
    const uint64_t across = (pass->film->width + TILE - 1) / TILE,
                   down = (pass->film->height + TILE - 1) / TILE;
    while (!atomic_load_explicit(&pass->halt, memory_order_relaxed)) {
        const uint64_t tile = atomic_fetch_add_explicit(&pass->tile, 1, memory_order_relaxed);
        if (tile >= across * down) break;
        work_tile(pass, tile, self->scratch);
    }
    pthread_mutex_lock(&pass->lock);
    if (!--pass->working) pthread_cond_signal(&pass->change);
    pthread_mutex_unlock(&pass->lock);
    return NULL;
}

_Bool mu_pass_start(mu_pass *pass, uint32_t target, mu_error *error) {
    pass->target = target;
    pass->started = 0;
    pass->working = 0;
    atomic_store(&pass->tile, 0);
    atomic_store(&pass->halt, 0);
    int code = 0;
    pthread_mutex_lock(&pass->lock);
    for (uint32_t i = 0; i < pass->plan->threads; ++i) {
        code = pthread_create(&pass->workers[i].thread, NULL, work, &pass->workers[i]);
        if (code) break;
        pass->started += 1;
        pass->working += 1;
    }
    pthread_mutex_unlock(&pass->lock);
    return pass->started || mu_fail(error, "no thread could be started: %s", strerror(code));
}

_Bool mu_pass_wait(mu_pass *pass, double seconds) {
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    const double whole = floor(seconds);
    until.tv_sec += (time_t)whole;
    until.tv_nsec += (long)(1e9 * (seconds - whole));
    if (until.tv_nsec >= 1000000000L) {
        until.tv_nsec -= 1000000000L;
        until.tv_sec += 1;
    }
    pthread_mutex_lock(&pass->lock);
    while (pass->working && !pthread_cond_timedwait(&pass->change, &pass->lock, &until)) continue;
    const _Bool ended = !pass->working;
    pthread_mutex_unlock(&pass->lock);
    return ended;
}

void mu_pass_halt(mu_pass *pass) {
    atomic_store(&pass->halt, 1);
}

void mu_pass_end(mu_pass *pass) {
    for (uint32_t i = 0; i < pass->started; ++i) pthread_join(pass->workers[i].thread, NULL);
    pass->started = 0;
}
