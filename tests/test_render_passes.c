/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/*
 * test_render_passes.c: threads, passes and stopping rules, with a sample function made of a hash instead of
 * rays: a film is right when every pixel holds the sum of its first n samples in order, to the last bit.
 */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "core/render/render.h"
#include "tests/film_fixture.h"

enum { WIDTH = 37, HEIGHT = 29, PIXELS = WIDTH * HEIGHT }; /* no multiple of a tile */

static uint64_t hash(uint64_t x) {
    x = (x ^ x >> 31) * 0x7fb5d329728ea185u;
    x = (x ^ x >> 27) * 0x81dadef4bc2dd44du;
    return x ^ x >> 33;
}

typedef struct world {
    atomic_uint_fast64_t calls, misaligned;
    uint64_t stop_after;       /* calls; 0: never */
    uint64_t slow_nanoseconds; /* per call */
    const char *file;          /* where checkpoints go */
    unsigned checkpoints, reports;
    double last_fraction;
} world;

/* Values over twelve orders of magnitude: any other order of summation gives other bits. */
static void sample_pixel(const void *context, uint64_t seed, uint32_t x, uint32_t y, uint32_t index,
                         void *scratch, mu_radiance *out) {
    world *w = (world *)(uintptr_t)context;
    const uint64_t h = hash(hash(hash(hash(seed) + x) + y) + index);
    memset(scratch, (int)h, 100); /* a thread's own, or the thread sanitizer objects */
    if ((uintptr_t)scratch % 64) atomic_fetch_add(&w->misaligned, 1);
    for (int c = 0; c < 3; ++c) {
        out->rgb[c] = exp2f((float)(h >> 8 * c & 255) / 6.4f - 20);
        out->albedo[c] = (float)(h >> 8 * c & 255) / 255;
        out->normal[c] = (float)(h >> (8 * c + 24) & 255) / 255;
    }
    out->rays = 1 + (h & 3);
    out->hit = h >> 63;
    atomic_fetch_add(&w->calls, 1);
    if (w->slow_nanoseconds) nanosleep(&(struct timespec){.tv_nsec = (long)w->slow_nanoseconds}, NULL);
}

static void sample(const void *context, uint64_t seed, uint32_t x, uint32_t y, uint32_t count, uint32_t index,
                   void *scratch, mu_radiance *out) {
    assert_in_range(count, 1, MU_PACKET);
    for (uint32_t i = 0; i < count; i++) sample_pixel(context, seed, x + i, y, index, scratch, &out[i]);
}

static _Bool stop(void *context) {
    world *w = context;
    return w->stop_after && atomic_load(&w->calls) >= w->stop_after;
}

static void report(void *context, const mu_render_status *status) {
    world *w = context;
    assert_true(status->fraction >= w->last_fraction && status->fraction <= 1);
    w->last_fraction = status->fraction;
    w->reports++;
}

static void checkpoint(void *context, const mu_film *film) {
    world *w = context;
    mu_error error = {.text = ""};
    assert_true(mu_film_save(film, w->file, 1, &error));
    w->checkpoints++;
}

static mu_film black(void) {
    mu_film film;
    mu_error error = {.text = ""};
    assert_true(mu_film_make(&film, WIDTH, HEIGHT, &error));
    return film;
}

static mu_render_end render(mu_film *film, world *w, uint32_t threads, uint32_t samples, double seconds,
                            double noise) {
    mu_error error = {.text = ""};
    const mu_render_plan plan = {.sample = sample,
                                 .context = w,
                                 .scratch = 100,
                                 .seed = 11,
                                 .threads = threads,
                                 .samples = samples,
                                 .seconds = seconds,
                                 .noise = noise};
    const mu_render_watch watch = {.context = w,
                                   .stop = stop,
                                   .report = report,
                                   .checkpoint = w->file ? checkpoint : NULL,
                                   .checkpoint_seconds = 0.1};
    const mu_render_end end = mu_render(film, &plan, &watch, &error);
    assert_true(end != MU_RENDER_FAILED || error.text[0]);
    assert_int_equal(atomic_load(&w->misaligned), 0);
    return end;
}

/* What the definition says, one sample after another. */
static void assert_is_sum(const mu_film *film) {
    world w = {.calls = 0};
    uint64_t rays = 0;
    unsigned char scratch[128] __attribute__((aligned(64)));
    for (uint32_t i = 0; i < PIXELS; ++i) {
        mu_pixel expected = {.samples = 0};
        for (uint32_t s = 0; s < film->pixels[i].samples; ++s) {
            mu_radiance one = {.rays = 0};
            sample_pixel(&w, 11, i % WIDTH, i / WIDTH, s, scratch, &one);
            mu_pixel_add(&expected, &one);
            rays += one.rays;
        }
        assert_memory_equal(&film->pixels[i], &expected, sizeof expected);
    }
    assert_int_equal(film->rays, rays);
}

static void every_thread_count_gives_the_sum(void **state) {
    (void)state;
    const uint32_t threads[] = {1, 2, 3, 8, 33};
    for (size_t t = 0; t < sizeof threads / sizeof *threads; ++t) {
        world w = {.calls = 0};
        mu_film film = black();
        assert_int_equal(render(&film, &w, threads[t], 40, 0, 0), MU_RENDER_DONE);
        for (int i = 0; i < PIXELS; ++i) assert_int_equal(film.pixels[i].samples, 40);
        assert_int_equal(atomic_load(&w.calls), 40 * PIXELS);
        assert_is_sum(&film);
        assert_true(w.last_fraction == 1);
        mu_film_free(&film);
    }
}

/* Stopped again and again at places that depend on the machine, through a file each time. */
static void interruptions_change_nothing(void **state) {
    (void)state;
    mu_error error = {.text = ""};
    const char *file = in_folder("stopped.resume");
    mu_film film = black();
    mu_render_end end;
    int sittings = 0;
    do {
        world w = {.stop_after = 900, .slow_nanoseconds = 20000};
        end = render(&film, &w, 1 + (uint32_t)sittings % 3, 12, 0, 0);
        assert_is_sum(&film);
        assert_true(mu_film_save(&film, file, 5, &error));
        mu_film_free(&film);
        film = black();
        assert_true(mu_film_load(&film, file, 5, &error));
        ++sittings;
    } while (end == MU_RENDER_STOPPED && sittings < 100);
    assert_int_equal(end, MU_RENDER_DONE);
    assert_true(sittings > 2);
    for (int i = 0; i < PIXELS; ++i) assert_int_equal(film.pixels[i].samples, 12);
    mu_film_free(&film);
}

/* A render rests 50 times as long as a checkpoint took, so on a busy disk there may be only one until its end: then it is
 * made again, longer. */
static void checkpoints_rest_in_the_midst_of_a_pass(void **state) {
    (void)state;
    unsigned checkpoints = 0;
    for (uint64_t slow = 100000; checkpoints < 2 && slow <= 3200000; slow *= 2) {
        mu_error error = {.text = ""};
        world w = {.slow_nanoseconds = slow, .file = in_folder("periodic.resume")};
        mu_film film = black(), saved = black();
        assert_int_equal(render(&film, &w, 2, 8, 0, 0), MU_RENDER_DONE);
        assert_true(w.checkpoints >= 1);
        assert_true(w.reports > 1);
        assert_is_sum(&film);
        assert_true(mu_film_load(&saved, w.file, 1, &error));
        assert_is_sum(&saved);
        checkpoints = w.checkpoints;
        mu_film_free(&film);
        mu_film_free(&saved);
    }
    assert_true(checkpoints > 1);
}

static void time_is_kept_in_whole_passes(void **state) {
    (void)state;
    uint32_t least, most;
    world w = {.slow_nanoseconds = 10000};
    mu_film film = black();
    assert_int_equal(render(&film, &w, 2, MU_MOST_SAMPLES, 0.7, 0), MU_RENDER_DONE);
    mu_film_samples(&film, &least, &most);
    assert_int_equal(least, most);
    assert_true(least > 1);
    assert_true(film.seconds < 1.4); /* 0.7 but for a machine that stalls in the last pass */
    assert_is_sum(&film);
    mu_film_free(&film);
    film = black();
    assert_int_equal(render(&film, &w, 2, MU_MOST_SAMPLES, 1e-9, 0), MU_RENDER_DONE);
    mu_film_samples(&film, &least, &most);
    assert_true(least == 1 && most == 1); /* an image needs one sample */
    mu_film_free(&film);
}

/* The first pass at which the film's noise is small enough ends it, and being interrupted does not move that.
 */
static void noise_stops_at_the_first_pass_that_reaches_it(void **state) {
    (void)state;
    const double limit = 0.12;
    uint32_t expected = 0, least, most;
    mu_film film = black();
    for (uint32_t n = 0; !expected; n = mu_render_next(n)) {
        world w = {.calls = 0};
        assert_int_equal(render(&film, &w, 2, mu_render_next(n), 0, 0), MU_RENDER_DONE);
        if (mu_render_next(n) >= 16 && mu_film_noise(&film) <= limit) expected = mu_render_next(n);
    }
    assert_true(expected > 18); /* not the first that may be asked */
    mu_film_free(&film);
    film = black();
    world w = {.stop_after = 30000};
    mu_render_end end = render(&film, &w, 2, MU_MOST_SAMPLES, 0, limit);
    w = (world){.stop_after = 0};
    if (end == MU_RENDER_STOPPED) end = render(&film, &w, 3, MU_MOST_SAMPLES, 0, limit);
    assert_int_equal(end, MU_RENDER_DONE);
    mu_film_samples(&film, &least, &most);
    assert_int_equal(least, expected);
    assert_int_equal(most, expected);
    mu_film_free(&film);
}

static void passes_grow_and_end(void **state) {
    (void)state;
    uint32_t n = 0;
    for (int i = 0; i < 4; ++i) n = mu_render_next(n);
    assert_int_equal(n, 4); /* 1, 2, 3, 4, 5, 6, 7, 8, 10, ... */
    while (n < MU_MOST_SAMPLES) {
        const uint32_t next = mu_render_next(n);
        assert_true(next > n && next <= n + n / 4 + (n < 4) && next <= n + 256);
        n = next;
    }
}

static void more_than_asked_for_is_refused(void **state) {
    (void)state;
    world w = {.calls = 0};
    mu_film film = black();
    assert_int_equal(render(&film, &w, 1, 5, 0, 0), MU_RENDER_DONE);
    w.last_fraction = 0;
    assert_int_equal(render(&film, &w, 1, 5, 0, 0), MU_RENDER_DONE); /* nothing to do */
    assert_int_equal(atomic_load(&w.calls), 5 * PIXELS);
    assert_int_equal(render(&film, &w, 1, 4, 0, 0), MU_RENDER_FAILED);
    mu_film_free(&film);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_thread_count_gives_the_sum),
        cmocka_unit_test(interruptions_change_nothing),
        cmocka_unit_test(checkpoints_rest_in_the_midst_of_a_pass),
        cmocka_unit_test(time_is_kept_in_whole_passes),
        cmocka_unit_test(noise_stops_at_the_first_pass_that_reaches_it),
        cmocka_unit_test(passes_grow_and_end),
        cmocka_unit_test(more_than_asked_for_is_refused),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
