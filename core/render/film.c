/* SPDX-License-Identifier: MIT */
/* SPDX-FileCopyrightText: 2026 The musurf authors */
/* film.c: the sums of a pixel and their statistics. Radiance in the scene's units, linear Rec. 709. */
#include "core/render/film.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "core/render/integrator.h"

_Bool mu_film_make(mu_film *film, uint32_t width, uint32_t height, mu_error *error) {
    *film = (mu_film){.width = width, .height = height};
    if (!width || !height || width > INT32_MAX || height > INT32_MAX)
        return mu_fail(error, "a film of %u x %u pixels: both must be from 1 to %d", width, height,
                       INT32_MAX);
    /* calloc would promise more than there is and the render die hours later, so the machine's memory is
     * asked. */
    const double bytes = (double)width * height * sizeof(mu_pixel);
    const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
    const double memory = pages > 0 && page > 0 ? (double)pages * (double)page : HUGE_VAL;
    if (bytes <= 0.9 * memory && bytes < (double)SIZE_MAX)
        film->pixels = calloc((size_t)width * height, sizeof(mu_pixel));
    if (!film->pixels)
        return mu_fail(error, "a film of %u x %u pixels needs %.1f GB of memory, more than there is", width,
                       height, bytes / 1e9);
    return 1;
}

void mu_film_free(mu_film *film) {
    free(film->pixels);
    *film = (mu_film){0};
}

static double luminance(const double rgb[3]) {
    return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

_Bool mu_pixel_add(mu_pixel *pixel, const mu_radiance *sample) {
    const double rgb[3] = {sample->rgb[0], sample->rgb[1], sample->rgb[2]};
    const double y = luminance(rgb);
    float guides = 0;
    for (int i = 0; i < 3; ++i) guides += fabsf(sample->albedo[i]) + fabsf(sample->normal[i]);
    pixel->samples += 1;
    const float share = 1 / (float)pixel->samples;
    const _Bool finite = isfinite(y) && isfinite(guides);
    if (finite) {
        for (int i = 0; i < 3; ++i) pixel->rgb[i] += rgb[i];
        pixel->luminance2 += y * y;
        pixel->block += y;
        pixel->hits += sample->hit;
    }
    if (pixel->samples % MU_BLOCK == 0) {
        pixel->block2 += pixel->block * pixel->block;
        pixel->block = 0;
    }
    for (int i = 0; i < 3; ++i) {
        pixel->albedo[i] += ((finite ? sample->albedo[i] : 0) - pixel->albedo[i]) * share;
        pixel->normal[i] += ((finite ? sample->normal[i] : 0) - pixel->normal[i]) * share;
    }
    return finite;
}

void mu_pixel_rgb(const mu_pixel *pixel, double rgb[3]) {
    for (int i = 0; i < 3; ++i) rgb[i] = pixel->samples ? pixel->rgb[i] / pixel->samples : 0;
}

double mu_pixel_variance(const mu_pixel *pixel) {
    if (pixel->samples < 2) return 0;
    const double whole = luminance(pixel->rgb);
    double n = pixel->samples, sum = whole, sum2 = pixel->luminance2, each = 1;
    if (pixel->samples >= MU_BLOCK * MU_BLOCKS) {
        n = pixel->samples / MU_BLOCK, sum = whole - pixel->block, sum2 = pixel->block2, each = MU_BLOCK;
    }
    const double mean = sum / n, variance = (sum2 / n - mean * mean) / ((n - 1) * each * each);
    return variance > 0 ? variance : 0; /* rounding may leave a constant pixel below 0 */
}

void mu_film_samples(const mu_film *film, uint32_t *least, uint32_t *most) {
    *least = UINT32_MAX;
    *most = 0;
    for (size_t i = 0; i < (size_t)film->width * film->height; ++i) {
        const uint32_t n = film->pixels[i].samples;
        *least = n < *least ? n : *least;
        *most = n > *most ? n : *most;
    }
}

double mu_film_noise(const mu_film *film) {
    const size_t count = (size_t)film->width * film->height;
    double sum = 0, rgb[3];
    for (size_t i = 0; i < count; ++i) {
        if (film->pixels[i].samples < 2) return HUGE_VAL;
        mu_pixel_rgb(&film->pixels[i], rgb);
        sum += luminance(rgb);
    }
    const double floor = 1e-3 * sum / (double)count; /* keeps dark pixels from ruling the mean */
    double noise = 0;
    for (size_t i = 0; i < count; ++i) {
        mu_pixel_rgb(&film->pixels[i], rgb);
        const double error = sqrt(mu_pixel_variance(&film->pixels[i]));
        if (error > 0) noise += error / (luminance(rgb) + floor);
    }
    return noise / (double)count;
}
