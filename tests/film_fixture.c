/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* film_fixture.c: what the tests of films share. */
#include "tests/film_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "core/render/integrator.h"

static char folder[] = "/tmp/musurf-film-XXXXXX";

const char *in_folder(const char *name) {
    static char path[8][128];
    static int turn;
    turn = (turn + 1) % 8;
    snprintf(path[turn], sizeof path[0], "%s/%s", folder, name);
    return path[turn];
}

int make_folder(void **state) {
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

int remove_folder(void **state) {
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

/* A small generator of its own (xorshift64*), so that the pictures are the same everywhere. */
static uint64_t random_state = 20220803;
static double uniform(void) {
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (double)((random_state * 0x2545f4914f6cdd1dULL) >> 11) * 0x1p-53;
}

mu_film noise_film(uint32_t width, uint32_t height, uint32_t samples) {
    mu_film film;
    mu_error error = {.text = ""};
    assert_true(mu_film_make(&film, width, height, &error));
    for (size_t i = 0; i < (size_t)width * height; ++i)
        for (uint32_t s = 0; s < samples; ++s) {
            mu_radiance sample = {.rays = 2, .hit = uniform() < 0.5};
            for (int c = 0; c < 3; ++c) {
                sample.rgb[c] = (float)exp(20 * uniform() - 10);
                sample.albedo[c] = (float)uniform();
                sample.normal[c] = (float)(2 * uniform() - 1);
            }
            assert_true(mu_pixel_add(&film.pixels[i], &sample));
        }
    film.rays = 12345678901234ULL;
    film.seconds = 12.5;
    return film;
}
