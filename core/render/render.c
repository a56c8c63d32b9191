/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* render.c: which pass comes next, when to stop, and what the watcher hears of it. Times in seconds of wall
 * clock. */
#include "core/render/render.h"

#include <math.h>
#include <time.h>

#include "core/render/render_pass.h"

enum { FEWEST_FOR_NOISE = 16 }; /* an estimate of the error from fewer samples is itself mostly noise */

typedef struct mu_state {
    mu_film *film;
    const mu_render_plan *plan;
    const mu_render_watch *watch;
    mu_pass pass;
    double start, worked;          /* when this run began; how long its threads worked */
    double reported, checkpointed; /* when that happened last */
    double interval;               /* between checkpoints */
    double noise, measured;        /* at the last pass that was asked, or negative; when */
    uint64_t before;               /* samples of the whole film before this run */
    uint32_t least, most;
} mu_state;

static double now(void) {
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Passes grow by a quarter, so that a rule that is asked between them overshoots by no more; and they stay
 * short enough to be watched. The sequence is fixed: --noise must stop at the same place however often it was
 * resumed. */
uint32_t mu_render_next(uint32_t samples) {
    const uint32_t quarter = samples / 4;
    return samples + (quarter < 1 ? 1 : quarter > 256 ? 256 : quarter);
}

static mu_render_status status(mu_state *state, double worked) {
    const mu_render_plan *plan = state->plan;
    const double pixels = (double)state->film->width * state->film->height;
    const double taken = (double)atomic_load(&state->pass.samples), elapsed = now() - state->start;
    const double samples = ((double)state->before + taken) / pixels; /* per pixel, on average */
    const double cost = taken > 0 ? worked * pixels / taken : -1; /* seconds for one sample of every pixel */
    double left = plan->samples - samples; /* samples per pixel until the first rule stops the render */
    double fraction = samples / plan->samples;
    if (plan->noise > 0 && state->noise > 0 && isfinite(state->noise)) {
        /* The standard error falls with the square root of the number of samples. */
        const double ratio = plan->noise / state->noise, need = state->least / (ratio * ratio);
        left = fmin(left, fmax(0, need - samples));
        fraction = fmax(fraction, fmin(1, samples / need));
    }
    double remaining = cost < 0 ? -1 : left * cost;
    if (plan->seconds > 0) {
        const double rest = fmax(0, plan->seconds - elapsed);
        remaining = remaining < 0 ? rest : fmin(remaining, rest);
        fraction = fmax(fraction, fmin(1, elapsed / plan->seconds));
    }
    return (mu_render_status){.seconds = elapsed,
                              .fraction = fmin(fraction, 1),
                              .remaining = remaining,
                              .samples = (uint32_t)samples,
                              .noise = state->noise,
                              .rays_per_second =
                                  worked > 0 ? (double)atomic_load(&state->pass.rays) / worked : 0};
}

static void report(mu_state *state, double worked) {
    if (!state->watch->report) return;
    const mu_render_status current = status(state, worked);
    state->watch->report(state->watch->context, &current);
    state->reported = now();
}

static _Bool told_to_stop(const mu_state *state) {
    return state->watch->stop && state->watch->stop(state->watch->context);
}

static _Bool checkpoint_due(const mu_state *state) {
    return state->watch->checkpoint && now() - state->checkpointed > state->interval;
}

static void checkpoint(mu_state *state) {
    const double begin = now();
    state->watch->checkpoint(state->watch->context, state->film);
    state->checkpointed = now();
    state->interval = fmax(state->watch->checkpoint_seconds, 50 * (state->checkpointed - begin));
}

/* Starts the threads and watches them until they are done or halted. */
static mu_render_end sitting(mu_state *state, uint32_t target, mu_error *error) {
    const uint64_t rays = atomic_load(&state->pass.rays), refused = atomic_load(&state->pass.refused);
    const double begin = now();
    mu_render_end end = MU_RENDER_DONE;
    if (!mu_pass_start(&state->pass, target, error)) return MU_RENDER_FAILED;
    while (!mu_pass_wait(&state->pass, 0.05)) {
        if (told_to_stop(state) || checkpoint_due(state)) {
            mu_pass_halt(&state->pass);
            end = MU_RENDER_STOPPED;
        } else if (now() - state->reported > 0.1) {
            report(state, state->worked + now() - begin);
        }
    }
    mu_pass_end(&state->pass);
    state->worked += now() - begin;
    state->film->seconds += now() - begin;
    state->film->rays += atomic_load(&state->pass.rays) - rays;
    state->film->refused += atomic_load(&state->pass.refused) - refused;
    return end;
}

/* Where the next pass ends; 0 if the render is done. */
static uint32_t next_target(mu_state *state) {
    const mu_render_plan *plan = state->plan;
    uint32_t target = mu_render_next(state->least);
    if (state->least < state->most) {
        target = state->most; /* a pass that was interrupted is finished first */
    } else {
        if (plan->noise > 0 && state->least >= FEWEST_FOR_NOISE && state->noise <= plan->noise) return 0;
        const double taken = (double)atomic_load(&state->pass.samples);
        if (plan->seconds > 0 && taken > 0) {
            /* Half of what would fit, so that the passes close in on the limit and the last ones are short.
             */
            const double pixels = (double)state->film->width * state->film->height;
            const double fit = (plan->seconds - (now() - state->start)) * taken / (state->worked * pixels);
            if (!(fit >= 1)) return 0;
            const double half = fmax(1, floor(fit / 2));
            if (half < target - state->least) target = state->least + (uint32_t)half;
        }
    }
    return state->least >= plan->samples ? 0 : target < plan->samples ? target : plan->samples;
}

/* The noise costs a walk over the film: after every pass if a rule needs it, else twice a second for the
 * watcher. */
static void measure_noise(mu_state *state) {
    const _Bool wanted = state->watch->report && (state->noise < 0 || now() - state->measured > 0.5);
    if (state->least < state->most || !(state->plan->noise > 0 || wanted)) return;
    state->noise = mu_film_noise(state->film);
    state->measured = now();
}

static mu_render_end run(mu_state *state, mu_error *error) {
    for (;;) {
        measure_noise(state);
        if (now() - state->reported > 0.1) report(state, state->worked);
        if (told_to_stop(state)) return MU_RENDER_STOPPED;
        if (checkpoint_due(state)) checkpoint(state);
        const uint32_t target = next_target(state);
        if (!target) return MU_RENDER_DONE;
        mu_render_end end = sitting(state, target, error);
        while (end == MU_RENDER_STOPPED && !told_to_stop(state)) { /* it was for a checkpoint */
            checkpoint(state);
            end = sitting(state, target, error);
        }
        if (end != MU_RENDER_DONE) return end;
        state->least = state->most = target;
    }
}

mu_render_end mu_render(mu_film *film, const mu_render_plan *plan, const mu_render_watch *watch,
                        mu_error *error) {
    mu_state state = {.film = film, .plan = plan, .watch = watch, .noise = -1};
    mu_film_samples(film, &state.least, &state.most);
    if (state.most > plan->samples) {
        mu_fail(error, "there are %u samples per pixel already, more than the %u asked for", state.most,
                plan->samples);
        return MU_RENDER_FAILED;
    }
    for (size_t i = 0; i < (size_t)film->width * film->height; ++i) state.before += film->pixels[i].samples;
    if (!mu_pass_make(&state.pass, film, plan, error)) return MU_RENDER_FAILED;
    state.start = state.reported = state.checkpointed = now();
    state.interval = watch->checkpoint_seconds;
    const mu_render_end end = run(&state, error);
    if (end != MU_RENDER_FAILED) report(&state, state.worked);
    mu_pass_free(&state.pass);
    return end;
}
