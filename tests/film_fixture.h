/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* film_fixture.h: a folder that goes away, and a film full of random samples. */
#ifndef MU_FILM_FIXTURE_H
#define MU_FILM_FIXTURE_H

#include "core/render/film.h"

/* Group fixtures of cmocka: makes and removes the folder. */
int make_folder(void **state);
int remove_folder(void **state);
/* A path in it; good for the next eight calls. */
const char *in_folder(const char *name);
/* `samples` random ones in each pixel, over e^-10 to e^10; the same on every machine. */
mu_film noise_film(uint32_t width, uint32_t height, uint32_t samples);

#endif
